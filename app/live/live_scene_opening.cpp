// SPDX-License-Identifier: Apache-2.0
// What comes into the window's scene in the background: files that are opened, random robots and children of others.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <system_error>

#include "app/live/live_scene_parts.h"
#include "app/options/robot_output.h"
#include "app/recording/trajectory_layout.h"
#include "app/recording/trajectory_reader.h"
#include "mercury/error.h"
#include "mercury/import.h"
#include "mercury/lively.h"
#include "mercury/random.h"
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

struct RandomRobot {
  std::uint64_t index;  // in the seed's sequence
  Robot robot;
};

// A robot that cannot be made is reported and left out.
std::vector<RandomRobot> make_random_robots(const RandomRobots& request, WorkControl& control, Messages& messages) {
  const Generator& generator = generator_named(request.kind);
  generator.validate(request.values);
  const MakeRobot make = [&](std::uint64_t seed, std::uint64_t index) {
    return generator.make(request.values, request.environment, seed, index);
  };
  constexpr std::size_t portion = 8;  // robots between two reports of progress
  std::vector<RandomRobot> robots;
  for (std::size_t done = 0; done < request.count && !control.canceled();) {
    const std::size_t count = std::min(portion, request.count - done);
    std::vector<MadeRobot> made = make_robots(make, request.seed, request.first + done, count);
    for (std::size_t i = 0; i < count; ++i) {
      if (made[i].robot)
        robots.push_back({request.first + done + i, std::move(*made[i].robot)});
      else
        messages.add(Severity::warning, "a robot was left out: " + made[i].failure);
    }
    done += count;
    control.progress(static_cast<std::int64_t>(done));
  }
  return robots;
}

std::vector<RandomRobot> make_lively_robots(const RandomRobots& request, const Configuration& configuration,
                                            WorkControl& control, Messages& messages) {
  const auto watch = [&](std::size_t done, std::size_t) {
    control.progress(static_cast<std::int64_t>(done / tried_per_lively));
    return !control.canceled();
  };
  std::vector<RandomRobot> robots;
  for (const RandomRobots& one : lively_requests(request, configuration, watch))
    std::ranges::move(make_random_robots(one, control, messages), std::back_inserter(robots));
  return robots;
}

struct Child {
  LiveRobot parent;
  Robot robot;
};

// One child per parent, each with its own seed. A parent that cannot be mutated is reported and left out.
std::vector<Child> make_children(const std::vector<DocumentRobot>& parents, const MutationRequest& mutation,
                                 WorkControl& control, Messages& messages) {
  std::vector<Child> children;
  for (std::size_t i = 0; i < parents.size() && !control.canceled(); ++i) {
    try {
      const Robot parent = whole_robot(parents[i]);
      MutationRequest own = mutation;
      own.seed = seed_of(mutation.seed, i);
      children.push_back({parents[i].body, mutate_robot(parent, own, parent.name + "-child")});
    } catch (const InputError& error) {
      messages.add(Severity::warning, error.what());
    }
    control.progress(static_cast<std::int64_t>(i + 1));
  }
  return children;
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
      if (opened->repro) {
        parts.replay(opened->repro, opened->file);
        pause();  // before the explosion, so that the user sees it come
      }
      if (opened->recording) parts.play_recording(opened->recording, opened->file);
      if (opened->scene) {
        parts.open_scene(*opened->scene, pointers_to(opened->robots));
        for (OpenedRobot& robot : opened->robots) parts.append(std::move(robot.robot), {.file = robot.file});
        hold_opened(opened->scene->held());
        parts.apply_document();
        for (const RandomRobots& random : opened->scene->random()) generate(random);
        return;
      }
      if (opened->robots.empty()) return;
      parts.edit("open " + robot_count_text(opened->robots.size()));
      if (parts.document.robots.empty() &&
          std::ranges::any_of(opened->robots, [](const OpenedRobot& robot) { return seeks_target(robot.robot); }))
        parts.let_travel();
      for (OpenedRobot& robot : opened->robots) parts.append(std::move(robot.robot), {.file = robot.file});
      parts.apply_document();
    };
  });
}

// Cells have no place for a target.
void LiveScene::Parts::let_travel() {
  if (view.layout != Layout::cells) return;
  set_layout(view, Layout::grid);
  physics.set_view(view);
}

void LiveScene::Parts::open_scene(const SceneFile& scene, std::span<const Robot* const> robots) {
  edit("open " + scene.path().filename().string());
  scene_file = scene.path();
  document.robots.clear();
  std::vector<std::string> notes;
  const Device device = document.configuration.device;
  document.configuration = scene.configuration(robots, notes);
  document.configuration.device = device;
  document.start = scene.start();
  view = scene.view(usual_layout(document.start));
  camera = view.camera;
  physics.set_view(view);
  physics.set_second(view.compare);
  for (std::string& note : notes) report(Severity::note, std::move(note));
}

void LiveScene::Parts::replay(const std::shared_ptr<const Repro>& repro, const fs::path& file) {
  edit("open " + file.filename().string());
  document.robots.clear();
  document.surroundings = ++last_surroundings;  // undo brings back the clock and the states of now
  const Device device = document.configuration.device;
  document.configuration = repro->configuration;
  document.configuration.device = device;
  append(repro->robot, {});
  saved.note(document.robots.back().body, "");
  physics.set_repro(document.robots.back().body, document.configuration, document.surroundings, repro);
  report(Severity::note, fmt::format("{} explodes at {:.4g} s; it is {:.4g} s now: play to see it. Changes that were "
                                     "made on the way are repeated until you change something.",
                                     document.robots.back().body.name, repro->exploded_at, time_of(repro->clock)));
  if (repro->device_name != physics.device_name())
    report(Severity::warning,
           fmt::format("the explosion was seen on {}; this device may give another result", repro->device_name));
}

void LiveScene::generate(const RandomRobots& generation, bool replace, bool lively) {
  if (generation.count == 0) return;
  Parts& parts = *parts_;
  const auto request = std::make_shared<const RandomRobots>(generation);
  const std::string environment(name_of(parts.document.configuration.environment));
  const auto task = [&parts, request, replace, lively, environment](WorkControl& control) -> Background::Finish {
    auto made = std::make_shared<std::vector<RandomRobot>>(
        lively ? make_lively_robots(*request, lively_configuration(*request, environment), control, parts.messages)
               : make_random_robots(*request, control, parts.messages));
    return [&parts, request, replace, made] {
      if (made->empty()) return;
      parts.edit("make " + robot_count_text(made->size()));
      if (replace) parts.document.robots.clear();
      for (RandomRobot& robot : *made)
        parts.append(std::move(robot.robot), {.generation = request, .index = robot.index});
      parts.apply_document();
    };
  };
  parts.background.begin("making " + robot_count_text(generation.count), static_cast<std::int64_t>(generation.count),
                         task);
}

void LiveScene::mutate(const std::vector<RobotId>& robots, const MutationRequest& mutation, bool replace) {
  Parts& parts = *parts_;
  auto parents = std::make_shared<std::vector<DocumentRobot>>();
  for (const RobotId id : robots)
    if (const DocumentRobot* robot = parts.document.find(id)) parents->push_back(*robot);
  if (parents->empty()) return;
  const auto task = [&parts, parents, mutation, replace](WorkControl& control) -> Background::Finish {
    auto children = std::make_shared<std::vector<Child>>(make_children(*parents, mutation, control, parts.messages));
    return [&parts, children, replace] {
      if (children->empty()) return;
      parts.edit("mutate " + robot_count_text(children->size()));
      for (Child& child : *children) parts.place_child(child.parent, std::move(child.robot), replace);
      parts.apply_document();
    };
  };
  parts.background.begin("mutating " + robot_count_text(parents->size()), static_cast<std::int64_t>(parents->size()),
                         task);
}

void LiveScene::breed(RobotId a, RobotId b, std::uint64_t seed) {
  Parts& parts = *parts_;
  const DocumentRobot *first = parts.document.find(a), *second = parts.document.find(b);
  if (!first || !second) return;
  const auto parents =
      std::make_shared<const std::array<Robot, 2>>(std::array<Robot, 2>{whole_robot(*first), whole_robot(*second)});
  const LiveRobot body = first->body;
  const auto task = [&parts, parents, body, seed](WorkControl&) -> Background::Finish {
    std::shared_ptr<Robot> child;
    try {
      const auto& [mother, father] = *parents;
      child = std::make_shared<Robot>(cross_robots(mother, father, seed, mother.name + "-x"));
    } catch (const InputError& error) {
      parts.messages.add(Severity::warning, error.what());
    }
    return [&parts, body, child] {
      if (!child) return;
      parts.edit("breed a robot");
      parts.place_child(body, std::move(*child), false);
      parts.apply_document();
    };
  };
  parts.background.begin("breeding a robot", 1, task);
}

// Adds a child at the end of the list, or in its parent's place.
void LiveScene::Parts::place_child(const LiveRobot& parent, Robot child, bool replace) {
  child.name = free_name(child.name);
  append(std::move(child), {});
  document.robots.back().parent = std::make_shared<const LiveRobot>(parent);
  if (!replace) return;
  const auto place =
      std::ranges::find_if(document.robots, [&](const DocumentRobot& robot) { return robot.body.id == parent.id; });
  if (place == document.robots.end()) return;
  *place = std::move(document.robots.back());
  document.robots.pop_back();
}

}  // namespace mercury
