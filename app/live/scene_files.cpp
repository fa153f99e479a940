// SPDX-License-Identifier: Apache-2.0
#include "app/live/scene_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <exception>
#include <system_error>
#include <utility>

#include "app/base/file_name.h"
#include "app/live/background.h"
#include "app/live/saved_robots.h"
#include "app/live/scene_core.h"
#include "app/live/scene_robots.h"
#include "app/live/scene_text.h"
#include "app/live/scene_time.h"
#include "app/options/robot_output.h"
#include "app/options/scene_file.h"
#include "app/recording/trajectory_layout.h"
#include "app/recording/trajectory_reader.h"
#include "mercury/error.h"
#include "mercury/import.h"
#include "mercury/real_body.h"
#include "mercury/robot_file.h"
#include "mercury/samples.h"

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

// Lists files, those of sample robots, and the robot files of folders sorted by name. Reading them reports other kinds
// of files.
std::vector<fs::path> files_of(const std::vector<fs::path>& paths, Messages& messages) {
  std::vector<fs::path> files;
  for (const fs::path& given : paths) {
    fs::path path;
    try {
      path = sample_or_path(given);
    } catch (const InputError& unknown_sample) {
      messages.add(Severity::error, unknown_sample.what());
      continue;
    }
    std::error_code error;
    if (!fs::is_directory(path, error)) {
      files.push_back(path);
      continue;
    }
    std::vector<fs::path> inside;
    for (fs::directory_iterator entry(path, error), end; !error && entry != end; entry.increment(error)) {
      std::error_code ignored;
      if (entry->is_directory(ignored)) continue;
      if (find_robot_format(entry->path()) || import_format_of(entry->path())) inside.push_back(entry->path());
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

std::vector<const Robot*> pointers_to(const std::vector<OpenedRobot>& robots) {
  std::vector<const Robot*> pointers;
  for (const OpenedRobot& robot : robots) pointers.push_back(&robot.robot);
  return pointers;
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
    if (!alone) throw InputError(file.string(), "is a scene, which takes the place of the current one; open it alone");
    std::vector<OpenedRobot> robots;
    for (const std::string& robot : scene->robots()) {
      const ImportFormat* format = import_format_of(robot);
      if (!format) {
        robots.push_back({robot, load_robot(robot)});
        continue;
      }
      Import import = import_file(robot, *format);
      if (import.motion) throw InputError(robot, "a motion to play; import it first");
      for (Robot& imported : import.robots) robots.push_back({"", std::move(imported)});
    }
    for (OpenedRobot& robot : robots) {
      const Physics physics = physics_of(robot.robot);
      scene->give_body(robot.robot, robot.file.empty() ? robot.robot.name : robot.file);
      if (physics_of(robot.robot) != physics) robot.file.clear();  // it is another robot than that of the file
    }
    std::vector<std::string> notes;
    (void)scene->configuration(pointers_to(robots), notes);  // throws while nothing has changed yet
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

void SceneFiles::open(const std::vector<fs::path>& paths) {
  if (paths.empty()) return;
  const std::string name = paths.size() == 1 ? "opening " + paths.front().filename().string()
                                             : fmt::format("opening {} files", paths.size());
  background_.begin(name, 0, [this, paths](WorkControl& control) -> Background::Finish {
    auto opened = std::make_shared<Opened>(read_robots(files_of(paths, core_.messages()), control, core_.messages()));
    return [this, opened] {
      const auto append_all = [&](SceneDocument& document) {
        for (OpenedRobot& one : opened->robots) robots_.append(document, std::move(one.robot), {.file = one.file});
      };
      if (opened->repro) {
        replay(opened->repro, opened->file);
        time_.pause();  // before the explosion, so that the user sees it come
      }
      if (opened->recording) play_recording(opened->recording, opened->file);
      if (opened->scene) {
        append_all(open_scene(*opened->scene, pointers_to(opened->robots)));
        hold_opened(opened->scene->held());
        core_.apply_document();
        for (const RandomRobots& random : opened->scene->random()) robots_.generate(random);
        return;
      }
      if (opened->robots.empty()) return;
      SceneDocument& document = core_.edit("open " + robot_count_text(opened->robots.size()));
      const auto travels = [](const OpenedRobot& one) { return seeks_target(one.robot); };
      if (document.robots.empty() && core_.view().layout == Layout::cells &&
          std::ranges::any_of(opened->robots, travels)) {  // cells have no place for a target
        ViewSettings view = core_.view();
        set_layout(view, Layout::grid);
        core_.set_view(view);
      }
      append_all(document);
      core_.apply_document();
    };
  });
}

SceneDocument& SceneFiles::open_scene(const SceneFile& scene, std::span<const Robot* const> robots) {
  SceneDocument& document = core_.edit("open " + scene.path().filename().string());
  scene_file_ = scene.path();
  document.robots.clear();
  std::vector<std::string> notes;
  const Device device = document.configuration.device;
  document.configuration = scene.configuration(robots, notes);
  document.configuration.device = device;
  document.start = scene.start();
  core_.set_view(scene.view(usual_layout(document.start)));
  camera_ = core_.view().camera;
  for (std::string& note : notes) core_.report(Severity::note, std::move(note));
  return document;
}

SceneDocument& SceneFiles::replace_scene(const fs::path& file, const Configuration& configuration) {
  SceneDocument& document = core_.edit("open " + file.filename().string());
  document.robots.clear();
  document.surroundings = core_.new_surroundings();
  const Device device = document.configuration.device;
  document.configuration = configuration;
  document.configuration.device = device;
  return document;
}

void SceneFiles::replay(const std::shared_ptr<const Repro>& repro, const fs::path& file) {
  SceneDocument& document = replace_scene(file, repro->configuration);
  const LiveRobot& body = robots_.append(document, repro->robot);
  saved_.note(body, "");
  core_.physics().set_repro(body, document.configuration, document.surroundings, repro);
  core_.report(Severity::note,
               fmt::format("{} explodes at {:.4g} s; it is {:.4g} s now: play to see it. Changes that were made on the "
                           "way are repeated until you change something.",
                           body.name, repro->exploded_at, time_of(repro->clock)));
  if (repro->device_name != core_.physics().device_name())
    core_.report(Severity::warning,
                 fmt::format("the explosion was seen on {}; this device may give another result", repro->device_name));
}

void SceneFiles::play_recording(const std::shared_ptr<TrajectoryReader>& recording, const fs::path& file) {
  SceneDocument& document = replace_scene(file, recording->configuration());
  core_.marks() = {};
  std::vector<LiveRobot> bodies;
  for (const RecordedRobot& recorded : recording->robots()) {
    bodies.push_back(robots_.append(document, recorded.robot));
    saved_.note(bodies.back(), "");
  }
  core_.physics().set_recording(std::move(bodies), document.configuration, document.surroundings, recording);
  core_.report(Severity::note,
               fmt::format("{}: {:.4g} s of {}, recorded on {}; any change goes on simulating from there",
                           file.filename().string(), recording->time(recording->frames() - 1) - recording->time(0),
                           robot_count_text(recording->robots().size()), recording->device_name()));
}

void SceneFiles::hold_opened(HeldParts held) { core_.hold_opened(std::move(held)); }

SaveResult SceneFiles::save(RobotId robot, const fs::path& path, bool overwrite) {
  const DocumentRobot* found = core_.document().find(robot);
  if (!found) return not_saved("the robot is no longer there");
  try {
    const SaveResult result =
        save_files({{path, serialize_robot(whole_robot(*found), robot_format_of(path))}}, overwrite);
    if (result.ok()) saved_.note(found->body, path.string());
    return result;
  } catch (const std::exception& error) {
    return not_saved(error.what());
  }
}

SaveResult SceneFiles::save_all(const std::vector<RobotId>& robots, const fs::path& folder, RobotFormat format,
                                bool overwrite) {
  std::vector<FileToSave> files;
  std::vector<const DocumentRobot*> saved_robots;
  FileNames names;
  try {
    for (const RobotId id : robots) {
      const DocumentRobot* robot = core_.document().find(id);
      if (!robot) continue;
      const fs::path path = folder / (names.of(robot->body.name) + (format == RobotFormat::json ? ".json" : ".cbor"));
      files.push_back({path, serialize_robot(whole_robot(*robot), format)});
      saved_robots.push_back(robot);
    }
  } catch (const std::exception& error) {
    return not_saved(error.what());
  }
  if (files.empty()) return not_saved("there is no robot to save");
  const SaveResult result = save_files(files, overwrite);
  for (std::size_t i = 0; i < saved_robots.size() && result.ok(); ++i)
    saved_.note(saved_robots[i]->body, files[i].path.string());
  return result;
}

SaveResult SceneFiles::save_scene(const fs::path& path, bool overwrite) {
  std::vector<SceneRobot> robots;
  for (const DocumentRobot& robot : core_.document().robots)
    robots.push_back({&robot, saved_.holds(robot.body) ? *saved_.file_of(robot.body.id) : ""});
  if (robots.empty()) return not_saved("there is no robot to save in a scene");
  try {
    const SceneOutput wanted = scene_files(path, robots, core_.document().configuration, core_.view(),
                                           held_in(core_.document()), core_.document().start);
    const SaveResult result = save_files(wanted.files, overwrite);
    for (std::size_t i = 0; i < wanted.beside.size() && result.ok(); ++i) {
      saved_.note(robots[wanted.beside[i]].robot->body, wanted.files[i].path.string());
    }
    if (result.ok()) scene_file_ = path;
    return result;
  } catch (const std::exception& error) {
    return not_saved(error.what());
  }
}

SaveResult SceneFiles::save_repro(RobotId robot, const fs::path& folder, bool overwrite) {
  const DocumentRobot* found = core_.document().find(robot);
  if (!found) return not_saved("the robot is no longer there");
  try {
    const std::optional<Repro> repro = core_.physics().repro(robot);
    if (!repro) return not_saved(found->body.name + " has not exploded since the last reset");
    return save_files({{folder / (file_name_of(found->body.name) + ".repro"), serialize_repro(*repro)}}, overwrite);
  } catch (const std::exception& error) {
    return not_saved(error.what());
  }
}

std::optional<CameraPlan> SceneFiles::take_camera() { return std::exchange(camera_, std::nullopt); }

CommandText SceneFiles::command(const std::string& subcommand) const {
  SceneDocument document = core_.document();
  for (DocumentRobot& robot : document.robots) {
    if (const auto file = saved_.file_of(robot.body.id)) robot.source.file = *file;
    // Materials that are equal to those of the file need no note.
    if (saved_.has_body(robot.body)) robot.body.materials.reset();
  }
  return command_text(document, core_.view(), subcommand);
}

}  // namespace mercury
