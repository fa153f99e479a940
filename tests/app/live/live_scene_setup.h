// SPDX-License-Identifier: Apache-2.0
// Scenes for the tests of app/live, on one thread of the CPU.
#pragma once

#include "app/live/live_scene.h"

namespace mercury::test {

inline LiveSceneOptions on_cpu(Environment environment = Ocean{}) {
  return {.configuration = {.environment = environment, .device = {.kind = DeviceKind::cpu, .threads = 1}}};
}

// Adds random voxel robots and waits until they are in the scene.
inline void make_robots(LiveScene& scene, std::size_t count, std::uint64_t seed = 5) {
  scene.generate({.count = count, .seed = seed});
  scene.wait_until_done();
}

inline std::vector<RobotId> ids_of(const LiveScene& scene) {
  std::vector<RobotId> ids;
  for (const RobotEntry& entry : scene.entries()) ids.push_back(entry.id);
  return ids;
}

inline std::vector<std::string> names_of(const LiveScene& scene) {
  std::vector<std::string> names;
  for (const RobotEntry& entry : scene.entries()) names.push_back(entry.name);
  return names;
}

}  // namespace mercury::test
