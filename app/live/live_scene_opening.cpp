// SPDX-License-Identifier: Apache-2.0
// Opens files in the window's scene: robots, recordings and repros, read in the background.
#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "app/live/live_scene_parts.h"
#include "app/recording/trajectory_layout.h"
#include "app/recording/trajectory_reader.h"
#include "mercury/error.h"
#include "mercury/import.h"
#include "mercury/origin.h"
#include "mercury/robot_file.h"

namespace mercury {
namespace {

namespace fs = std::filesystem;

struct OpenedRobot {
  std::string file;  // empty: from a recording
  Robot robot;
};

// What a task has read.
struct Opened {
  std::vector<OpenedRobot> robots;
  std::shared_ptr<const Repro> repro;           // replaces the whole scene
  std::shared_ptr<const SceneFile> scene;       // the same
  std::shared_ptr<TrajectoryReader> recording;  // the same
  fs::path file;                                // of the repro or recording
};

// Lists files, and the robot files of folders sorted by name. Reading them reports other kinds of files.
std::vector<fs::path> files_of(const std::vector<fs::path>& paths, Messages& messages) {
  std::vector<fs::path> files;
  for (const fs::path& path : paths) {
    std::error_code error;
    if (!fs::is_directory(path, error)) {
      files.push_back(path);
      continue;
    }
    std::vector<fs::path> inside;
    for (fs::directory_iterator entry(path, error), end; !error && entry != end; entry.increment(error)) {
      const fs::path extension = entry->path().extension();
      std::error_code ignored;
      if (entry->is_directory(ignored)) continue;
      if (extension == ".json" || extension == ".cbor" || import_format_of(entry->path()))
        inside.push_back(entry->path());
    }
    if (error)
      messages.add(Severity::error, path.string() + ": " + error.message());
    else if (inside.empty())
      messages.add(Severity::warning, path.string() + ": the folder holds no robot, neither *.json nor *.cbor");
    std::ranges::sort(inside);
    files.insert(files.end(), inside.begin(), inside.end());
  }
  return files;
}

// Alone, a recording is played. Otherwise its robots are opened, at rest.
void read_recording(const fs::path& file, bool alone, Opened& opened, Messages& messages) {
  auto recording = std::make_shared<TrajectoryReader>(file);
  opened.file = file;
  if (alone && recording->frames() > 0) {
    opened.recording = std::move(recording);
    return;
  }
  for (const RecordedRobot& recorded : recording->robots()) opened.robots.push_back({"", recorded.robot});
  messages.add(Severity::note, fmt::format("{}: the recording's {}, at rest; open it alone to play it", file.string(),
                                           robot_count_text(recording->robots().size())));
}

// Opens the robots of another simulator. Their worlds are not applied: the scene may have others.
void read_import(const fs::path& file, const ImportFormat& format, Opened& opened, Messages& messages) {
  Import import = import_file(file, format);
  for (Robot& robot : import.robots) opened.robots.push_back({"", std::move(robot)});
  const auto count = [&](ImportOutcome outcome) {
    return std::ranges::count(import.report.elements, outcome, &ImportedElement::outcome);
  };
  messages.add(
      import.robots.empty() ? Severity::warning : Severity::note,
      fmt::format("{}: {} imported; {} elements mapped, {} approximated, {} ignored. Its world: {}, dt {:.3g} s; "
                  "mercury import writes it, and the report",
                  file.string(), robot_count_text(import.robots.size()), count(ImportOutcome::mapped),
                  count(ImportOutcome::approximated), count(ImportOutcome::ignored), import.settings.environment,
                  import.settings.dt));
}

// That the robots of a scene are made for.
std::vector<std::string> environments_of(const SceneFile& scene, const std::vector<OpenedRobot>& robots) {
  std::vector<std::string> environments;
  for (const OpenedRobot& robot : robots) environments.push_back(environment_of(robot.robot));
  for (const RandomRobots& random : scene.random()) environments.push_back(generator_named(random.kind).environment);
  return environments;
}

void read_file(const fs::path& file, bool alone, Opened& opened, Messages& messages) {
  if (is_repro_name(file)) {
    if (!alone) throw InputError(file.string(), "is a repro, which has its own time; open it alone");
    opened.repro = std::make_shared<const Repro>(load_repro(file));
    opened.file = file;
    return;
  }
  if (is_readable_trajectory_name(file.string())) {
    read_recording(file, alone, opened, messages);
    return;
  }
  if (is_scene_name(file)) {
    auto scene = std::make_shared<const SceneFile>(file);
    if (!alone) throw InputError(file.string(), "is a scene, which takes the place of the present one; open it alone");
    std::vector<OpenedRobot> robots;
    for (const std::string& robot : scene->robots()) {
      const ImportFormat* format = import_format_of(robot);
      if (!format) {
        robots.push_back({robot, load_robot(robot)});
        continue;
      }
      for (Robot& imported : import_file(robot, *format).robots) robots.push_back({"", std::move(imported)});
    }
    std::vector<std::string> notes;
    (void)scene->configuration(environments_of(*scene, robots), notes);  // throws while nothing has changed yet
    opened.robots = std::move(robots);
    opened.scene = std::move(scene);
    return;
  }
  if (const ImportFormat* format = import_format_of(file)) return read_import(file, *format, opened, messages);
  opened.robots.push_back({file.string(), load_robot(file)});
}

// Reports each file that cannot be used in one line; of many files, only the first ones.
void report_failures(const std::vector<std::string>& failures, Messages& messages) {
  constexpr std::size_t most = 4;
  const std::size_t listed = failures.size() > most ? most - 1 : failures.size();
  for (std::size_t i = 0; i < listed; ++i) messages.add(Severity::error, failures[i]);
  if (listed < failures.size())
    messages.add(Severity::error, fmt::format("and {} more files cannot be used", failures.size() - listed));
}

Opened read_robots(const std::vector<fs::path>& files, WorkControl& control, Messages& messages) {
  Opened opened;
  std::vector<std::string> failures;
  std::int64_t done = 0;
  for (const fs::path& file : files) {
    if (control.canceled()) break;
    try {
      read_file(file, files.size() == 1, opened, messages);
    } catch (const InputError& error) {
      failures.emplace_back(error.what());
    }
    control.progress(++done);
  }
  report_failures(failures, messages);
  return opened;
}

}  // namespace

void LiveScene::open(const std::vector<fs::path>& paths) {
  if (paths.empty()) return;
  Parts& parts = *parts_;
  const std::string name = paths.size() == 1 ? "opening " + paths.front().filename().string()
                                             : fmt::format("opening {} files", paths.size());
  parts.background.begin(name, 0, [this, &parts, paths](WorkControl& control) -> Background::Finish {
    auto opened = std::make_shared<Opened>(read_robots(files_of(paths, parts.messages), control, parts.messages));
    return [this, &parts, opened] {
      if (opened->repro) parts.replay(opened->repro, opened->file);
      if (opened->recording) parts.play_recording(opened->recording, opened->file);
      if (opened->scene) {
        parts.open_scene(*opened->scene, environments_of(*opened->scene, opened->robots));
        for (OpenedRobot& robot : opened->robots) parts.append(std::move(robot.robot), {.file = robot.file});
        parts.to_attach = opened->scene->attached();
        parts.apply_document();
        for (const RandomRobots& random : opened->scene->random()) generate(random);
        return;
      }
      if (opened->robots.empty()) return;
      parts.edit("open " + robot_count_text(opened->robots.size()));
      for (OpenedRobot& robot : opened->robots) parts.append(std::move(robot.robot), {.file = robot.file});
      parts.apply_document();
    };
  });
}

void LiveScene::Parts::open_scene(const SceneFile& scene, const std::vector<std::string>& environments) {
  edit("open " + scene.path().filename().string());
  document.robots.clear();
  std::vector<std::string> notes;
  const Device device = document.configuration.device;
  document.configuration = scene.configuration(environments, notes);
  document.configuration.device = device;
  view = scene.view(Layout::cells);
  camera = view.camera;
  physics.set_view(view);
  physics.set_second(view.compare);
  for (std::string& note : notes) report(Severity::note, std::move(note));
}

void LiveScene::Parts::replay(const std::shared_ptr<const Repro>& repro, const fs::path& file) {
  edit("open " + file.filename().string());
  document.robots.clear();
  const Device device = document.configuration.device;
  document.configuration = repro->configuration;
  document.configuration.device = device;
  const RobotId id = append(repro->robot, {});
  saved[id] = {"", document.robots.back().body};
  physics.set_repro(document.robots.back().body, document.configuration, repro);
  report(Severity::note,
         fmt::format("{} explodes at {:.4g} s; it is {:.4g} s now. Changes that were made on the way are "
                     "repeated until you change something.",
                     document.robots.back().body.name, repro->exploded_at, time_of(repro->clock)));
  if (repro->device_name != physics.device_name())
    report(Severity::warning,
           fmt::format("the explosion was seen on {}; this device may give another result", repro->device_name));
}

}  // namespace mercury
