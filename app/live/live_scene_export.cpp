// SPDX-License-Identifier: Apache-2.0
// What the window's scene exports for other programs: present poses, and motions from time 0.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <exception>

#include "app/export/export.h"
#include "app/live/live_scene_parts.h"
#include "app/recording/recorder.h"
#include "mercury/error.h"
#include "mercury/simulation.h"

namespace mercury {
namespace {

namespace fs = std::filesystem;

constexpr double frame_rate = 30;  // of motions, per second of simulated time

SaveResult failed(const std::string& message) { return {SaveResult::Outcome::failed, {}, message}; }

// As pictures show it: with its colors, its name and its materials as they are in the window.
struct Exported {
  Robot robot;
  std::vector<Material> materials;
  Exported(const LiveRobot& live)
      : robot(*live.robot), materials(mercury::materials_of(live).begin(), mercury::materials_of(live).end()) {
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

// A recording that lives as long as the export from it.
class TemporaryRecording {
 public:
  explicit TemporaryRecording(const fs::path& beside)
      : path_(beside.parent_path() / fmt::format(".{}.{}.h5", beside.filename().string(), getpid())) {}
  ~TemporaryRecording() {
    std::error_code ignored;
    fs::remove(path_, ignored);
  }
  TemporaryRecording(const TemporaryRecording&) = delete;
  TemporaryRecording& operator=(const TemporaryRecording&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

struct Canceled {};

void require_going(const WorkControl& control) {
  if (control.canceled()) throw Canceled();
}

// Simulates the robot from time 0. Returns the number of frames.
std::int64_t record(const Exported& exported, const Configuration& configuration, const fs::path& path, double seconds,
                    WorkControl& control) {
  Simulation simulation(configuration, std::vector{exported.robot});
  for (std::size_t id = 1; id < exported.materials.size(); ++id)
    simulation.set_material(0, static_cast<MaterialId>(id), exported.materials[id]);
  const std::int64_t last = std::llround(seconds / configuration.dt);
  const std::int64_t every = std::max<std::int64_t>(1, std::llround(1 / (frame_rate * configuration.dt)));
  Recorder recorder(simulation, path, {.every = every, .last_step = last});
  while (simulation.steps() < last) {
    require_going(control);
    simulation.step(std::min(last, recorder.next_step()) - simulation.steps());
    recorder.observe();
    control.progress(recorder.frames());
  }
  recorder.finish();
  return recorder.frames();
}

}  // namespace

SaveResult LiveScene::export_pose(RobotId robot, const fs::path& path, bool overwrite) {
  const DocumentRobot* found = parts_->document.find(robot);
  const auto index = parts_->snapshot->robots->index_of(robot);
  if (!found || !index) return failed("the robot is no longer there");
  const Snapshot& snapshot = *parts_->snapshot;
  try {
    const ExportFormat& format = format_for(path, "");
    const Exported exported(found->body);
    require_pose(format, exported.robot, false);
    const Pose pose{.time = snapshot.time,
                    .positions = snapshot.positions_of(*index),
                    .velocities = snapshot.velocities_of(*index)};
    if (!is_finite(pose.positions)) return failed(found->body.name + " has exploded: its positions are no numbers");
    if (const auto files = existing_outputs(format, path); !overwrite && !files.empty())
      return {SaveResult::Outcome::exists, files, ""};
    make_folder_of(path);
    format.pose(exported.in(snapshot.configuration.environment), pose, path, {});
    return {SaveResult::Outcome::saved, {path}, ""};
  } catch (const std::exception& error) {
    return failed(error.what());
  }
}

SaveResult LiveScene::export_motion(RobotId robot, const fs::path& path, double seconds, bool overwrite) {
  const DocumentRobot* found = parts_->document.find(robot);
  if (!found) return failed("the robot is no longer there");
  const Configuration configuration = parts_->document.configuration;
  if (!(seconds > 0 && seconds / configuration.dt < 1e9)) return failed("give a number of seconds above 0");
  try {
    const ExportFormat& format = format_for(path, "");
    const auto exported = std::make_shared<const Exported>(found->body);
    require_motion(format, exported->robot, false);
    if (const auto files = existing_outputs(format, path); !overwrite && !files.empty())
      return {SaveResult::Outcome::exists, files, ""};
    make_folder_of(path);
    const auto frames = static_cast<std::int64_t>(seconds * frame_rate) + 1;
    parts_->background.begin(
        "exporting " + path.filename().string(), 2 * frames,
        [&messages = parts_->messages, &format, exported, configuration, path, seconds](WorkControl& control) {
          try {
            const TemporaryRecording recording(path);
            const std::int64_t recorded = record(*exported, configuration, recording.path(), seconds, control);
            RecordedMotion motion(std::make_shared<TrajectoryReader>(recording.path()), 0);
            if (!motion.problem().empty()) messages.add(Severity::warning, motion.problem());
            const auto watch = [&](std::size_t done, std::size_t) {
              require_going(control);
              control.progress(recorded + static_cast<std::int64_t>(done));
            };
            format.motion(exported->in(configuration.environment), motion, path, {.watch = watch});
            messages.add(Severity::note, "exported " + path.string());
          } catch (const Canceled&) {
          }
          return Background::Finish([] {});
        });
    return {SaveResult::Outcome::saved, {path}, ""};
  } catch (const std::exception& error) {
    return failed(error.what());
  }
}

}  // namespace mercury
