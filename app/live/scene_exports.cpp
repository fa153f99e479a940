// SPDX-License-Identifier: Apache-2.0
#include "app/live/scene_exports.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <iterator>
#include <thread>
#include <utility>

#include "app/base/child_process.h"
#include "app/base/output_files.h"
#include "app/export/export.h"
#include "app/export/simulated_motion.h"
#include "app/live/background.h"
#include "app/live/group_video.h"
#include "app/live/scene_core.h"
#include "app/live/scene_selection.h"
#include "mercury/simulation.h"

namespace mercury {
namespace {

namespace fs = std::filesystem;

// As frames show it: with its colors, its name and its materials as they are in the window.
struct Exported {
  LiveRobot live;
  Robot robot;
  std::vector<Material> materials;
  Exported(const LiveRobot& given)
      : live(given), robot(*given.robot), materials(materials_of(given).begin(), materials_of(given).end()) {
    robot.name = live.name;
  }
  ExportedRobot in(const Environment& environment) const {
    return {.robot = robot, .materials = materials, .environment = environment};
  }
};

std::vector<fs::path> existing_outputs(const ExportFormat& format, const fs::path& path) {
  std::vector<fs::path> outputs{path}, found;
  if (format.files_beside) std::ranges::copy(format.files_beside(path), std::back_inserter(outputs));
  if (format.folder_beside) outputs.push_back(format.folder_beside(path));
  std::ranges::copy_if(outputs, std::back_inserter(found),
                       [](const fs::path& output) { return fs::exists(fs::symlink_status(output)); });
  return found;
}

void make_folder_of(const fs::path& path) {
  if (path.has_parent_path()) fs::create_directories(path.parent_path());
}

struct Canceled {};

void require_going(const WorkControl& control) {
  if (control.canceled()) throw Canceled();
}

// Simulates the robots from time 0. Returns the number of frames.
std::int64_t record(const std::vector<Exported>& exported, const Configuration& configuration, const TrialStart& start,
                    const fs::path& path, double seconds, WorkControl& control) {
  std::vector<LiveRobot> robots;
  for (const Exported& one : exported) robots.push_back(one.live);
  Simulation simulation = simulation_of(robots, configuration, start);
  return record_motion(simulation, seconds, path, std::nullopt,
                       [&](std::int64_t frames) {
                         require_going(control);
                         control.progress(frames);
                       })
      .frames;
}

void write_motions(const ExportFormat& format, const std::vector<Exported>& exported,
                   const Configuration& configuration, const fs::path& recorded, const fs::path& path,
                   Messages& messages, const FrameWatch& watch) {
  const auto recording = std::make_shared<TrajectoryReader>(recorded);
  std::vector<RecordedMotion> motions;
  for (std::size_t robot = 0; robot < exported.size(); ++robot) {
    motions.emplace_back(recording, robot);
    if (!motions.back().problem().empty()) messages.add(Severity::warning, motions.back().problem());
  }
  if (format.motions)
    format.motions(motions, path, {.watch = watch});
  else
    format.motion(exported.front().in(configuration.environment), motions.front(), path, {.watch = watch});
}

// Runs a program to its end, or until the work is canceled. Returns why it failed, in one line; empty = it did not.
std::string run_to_end(const fs::path& program, const std::vector<std::string>& words, const WorkControl& control) {
  ChildProcess process(program.string(), words);
  while (process.running()) {
    if (control.canceled()) throw Canceled();
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  if (process.finish() == 0) return {};
  std::string line = process.messages();
  while (line.ends_with('\n')) line.pop_back();
  line.erase(0, line.rfind('\n') + 1);
  return line.starts_with("mercury: ") ? line.substr(9) : "mercury export failed: " + line;
}

}  // namespace

std::unique_ptr<GroupVideo> SceneExports::video(const GroupVideoOptions& options) const {
  std::vector<LiveRobot> robots;
  for (const DocumentRobot& robot : core_.document().robots)
    if (!selection_.is_hidden(robot.body.id)) robots.push_back(robot.body);
  GroupVideoOptions wanted = options;
  wanted.start = core_.document().start;
  return std::make_unique<GroupVideo>(std::move(robots), core_.document().configuration, core_.view(), wanted);
}

SaveResult SceneExports::pose(RobotId robot, const fs::path& path, bool overwrite) {
  const DocumentRobot* found = core_.document().find(robot);
  const auto index = core_.snapshot().robots->index_of(robot);
  if (!found || !index) return not_saved("the robot is no longer there");
  const Snapshot& snapshot = core_.snapshot();
  try {
    const ExportFormat& format = format_for(path, "");
    Exported exported(found->body);
    exported.materials = snapshot.details.driven.of(*index, exported.materials);
    require_pose(format, exported.robot, false);
    const Pose pose{.time = snapshot.time,
                    .positions = snapshot.positions_of(*index),
                    .velocities = snapshot.velocities_of(*index)};
    if (!is_finite(pose.positions)) return not_saved(found->body.name + " has exploded: its positions are no numbers");
    if (const auto files = existing_outputs(format, path); !overwrite && !files.empty())
      return {SaveResult::Outcome::exists, files, ""};
    make_folder_of(path);
    format.pose(exported.in(snapshot.configuration.environment), pose, path, {});
    return {SaveResult::Outcome::saved, {path}, ""};
  } catch (const std::exception& error) {
    return not_saved(error.what());
  }
}

SaveResult SceneExports::motion(const std::vector<RobotId>& robots, const fs::path& path, double seconds,
                                bool overwrite) {
  const Configuration configuration = core_.document().configuration;
  if (!(seconds > 0 && seconds / configuration.dt < 1e9)) return not_saved("give a number of seconds above 0");
  try {
    const ExportFormat& format = format_for(path, "");
    std::vector<Exported> exported;
    for (const RobotId robot : robots)
      if (const DocumentRobot* found = core_.document().find(robot)) exported.emplace_back(found->body);
    if (exported.empty()) return not_saved("the robot is no longer there");
    for (const Exported& one : exported) require_motion(format, one.robot, false);
    if (exported.size() > 1 && !format.motions)
      return not_saved(fmt::format("a {} file holds one robot; select one, or give {}", format.name,
                                   format_names([](const ExportFormat& other) { return other.motions != nullptr; })));
    if (const auto files = existing_outputs(format, path); !overwrite && !files.empty())
      return {SaveResult::Outcome::exists, files, ""};
    make_folder_of(path);
    const auto frames = motion_frames(seconds);
    const auto all = static_cast<std::int64_t>(exported.size()) * frames;
    background_.begin("exporting " + path.filename().string(), frames + all,
                      [&messages = core_.messages(), &format, exported = std::move(exported), configuration,
                       start = core_.document().start, path, seconds](WorkControl& control) {
                        try {
                          const TemporaryRecording recording(path);
                          const std::int64_t recorded =
                              record(exported, configuration, start, recording.path(), seconds, control);
                          write_motions(format, exported, configuration, recording.path(), path, messages,
                                        [&](std::size_t done, std::size_t) {
                                          require_going(control);
                                          control.progress(recorded + static_cast<std::int64_t>(done));
                                        });
                          messages.add(Severity::note, "exported " + path.string());
                        } catch (const Canceled&) {
                        }
                        return Background::Finish([] {});
                      });
    return {SaveResult::Outcome::saved, {path}, ""};
  } catch (const std::exception& error) {
    return not_saved(error.what());
  }
}

SaveResult SceneExports::run(const fs::path& run, const std::vector<std::string>& words, const fs::path& path,
                             bool overwrite, const fs::path& program) {
  try {
    if (!overwrite && fs::exists(fs::symlink_status(path))) return {SaveResult::Outcome::exists, {path}, ""};
    std::vector<std::string> all{"export", run.string(), "--output=" + path.string(), "--force", "--quiet"};
    all.insert(all.end(), words.begin(), words.end());
    background_.begin("exporting " + path.filename().string(), 0,
                      [&messages = core_.messages(), program, all, path](const WorkControl& control) {
                        try {
                          const std::string failure = run_to_end(program, all, control);
                          if (failure.empty())
                            messages.add(Severity::note, "exported " + path.string());
                          else
                            messages.add(Severity::error, failure);
                        } catch (const Canceled&) {
                        }
                        return Background::Finish([] {});
                      });
    return {SaveResult::Outcome::saved, {path}, ""};
  } catch (const std::exception& error) {
    return not_saved(error.what());
  }
}

}  // namespace mercury
