// SPDX-License-Identifier: Apache-2.0
// Scenes for the tests of app/live, on one thread of the CPU.
#pragma once

#include "app/live/live_scene.h"
#include "app/live/scene_files.h"
#include "app/live/scene_robots.h"
#include "app/live/scene_time.h"

namespace mercury::test {

inline LiveSceneOptions on_cpu(Environment environment = Ocean{}) {
  return {.configuration = {.environment = environment, .device = {.kind = DeviceKind::cpu, .threads = 1}}};
}

// Each waits until the snapshot shows what it did.
inline void step_and_wait(LiveScene& scene, std::int64_t steps = 1) {
  scene.time().step(steps);
  scene.wait_until_done();
}
inline void seek_and_wait(LiveScene& scene, double time) {
  scene.time().seek(time);
  scene.wait_until_done();
}
inline void undo_and_wait(LiveScene& scene) {
  scene.undo();
  scene.wait_until_done();
}
inline void reset_and_wait(LiveScene& scene) {
  scene.time().reset();
  scene.wait_until_done();
}
inline void open_and_wait(LiveScene& scene, const std::vector<std::filesystem::path>& files) {
  scene.files().open(files);
  scene.wait_until_done();
}

// Adds random voxel robots and waits until they are in the scene.
inline void make_robots(LiveScene& scene, std::size_t count, std::uint64_t seed = 5) {
  scene.robots().generate({.count = count, .seed = seed});
  scene.wait_until_done();
}

// A scene that begins with random voxel robots.
struct RobotScene : LiveScene {
  explicit RobotScene(std::size_t robots, const LiveSceneOptions& options = on_cpu()) : LiveScene(options) {
    make_robots(*this, robots);
  }
};

inline std::vector<RobotId> ids_of(const LiveScene& scene) {
  std::vector<RobotId> ids;
  for (const RobotEntry& entry : scene.robots().entries()) ids.push_back(entry.id);
  return ids;
}

inline std::vector<std::string> names_of(const LiveScene& scene) {
  std::vector<std::string> names;
  for (const RobotEntry& entry : scene.robots().entries()) names.push_back(entry.name);
  return names;
}

}  // namespace mercury::test
