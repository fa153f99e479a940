// SPDX-License-Identifier: Apache-2.0
// Steers eels to targets, in a closed loop.
//
// Five equal eels start in the same direction, each with a target of its own, up to 60 degrees to either side. Muscles
// along the left and right side of an eel contract in turn, in a wave that runs from head to tail and pushes the eel
// forward. If the muscles of one side are weaker, the eel turns away from that side. So once per period of the wave,
// the controller of each eel
//   - reads the center of mass (telemetry(): one call for the whole batch). Its displacement in the last period is the
//     course, because the undulation averages out;
//   - compares the course with the direction to the target;
//   - lowers the amplitudes on the side away from the target in proportion to the error (set_materials(): one call for
//     the whole batch).
// It neither reads nor writes masses. The exit status is 0 if every eel comes within 0.4 m of its target, 4 m away, and
// none would have reached it without control.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <vector>

#include <mercury/simulation.h>
#include <mercury/voxel.h>

using namespace mercury;

constexpr int segments = 10, length_in_voxels = 20;
constexpr float frequency = 6, waves = 1.2f;  // [rad/s], wavelengths along the body
constexpr double dt = 2e-3, period = 2 * std::numbers::pi / frequency, seconds = 50;  // [s]
constexpr float pi = std::numbers::pi_v<float>, reach = 0.4f;                         // [m]

// Muscle ids 1 to 10 stand along the right side from tail to head, 11 to 20 along the left side.
VoxelGrid eel() {
  VoxelGrid grid(length_in_voxels, 2, 3);
  for (int z = 0; z < 3; ++z)
    for (int y = 0; y < 2; ++y)
      for (int x = 0; x < length_in_voxels; ++x)
        grid.cell(x, y, z) = static_cast<MaterialId>(1 + x * segments / length_in_voxels + y * segments);
  return grid;
}

// An eel's materials; each side's amplitudes are scaled by its strength, 0 to 1.
std::vector<Material> muscles(float left, float right) {
  std::array<Material, base_material_count> bases{};
  for (std::size_t i = 0; i < segments; ++i) {
    const float from_head = (segments - 0.5f - static_cast<float>(i)) / segments;
    bases[i] = {
        .stiffness = 6000, .amplitude = 0.3f * right, .frequency = frequency, .phase = -2 * pi * waves * from_head};
    bases[i + segments] = bases[i];
    bases[i + segments].amplitude = -0.3f * left;
  }
  return material_table(bases);
}

// The angle in (-pi, pi] by which `to` lies to the left of `from`, both in the plane.
float angle(Vec3 from, Vec3 to) { return std::atan2(from.x * to.y - from.y * to.x, from.x * to.x + from.y * to.y); }

// How near each eel comes to its target [m], with or without control.
std::vector<float> swim(const std::vector<Vec3>& targets, bool controlled) {
  const Robot robot = make_voxel_robot(eel(), {.name = "eel", .materials = muscles(1, 1)});
  Simulation simulation({.dt = dt, .environment = Ocean{}}, std::vector<Robot>(targets.size(), robot));
  std::vector<float> nearest(targets.size(), std::numeric_limits<float>::infinity());
  std::vector<Vec3> last(targets.size(), {-1, 0, 0});  // each looks ahead, along x, at first
  std::vector<Material> tables = simulation.materials();

  while (simulation.time() < seconds) {
    const std::vector<Telemetry> now = simulation.telemetry();
    for (std::size_t i = 0; i < targets.size(); ++i) {
      const Vec3 here = now[i].center_of_mass;
      nearest[i] = std::min(nearest[i], length(targets[i] - here));
      const float error = angle(here - last[i], targets[i] - here);  // positive: the target is to the left
      const float turn = std::clamp(error, -0.5f, 0.5f);
      last[i] = here;
      std::ranges::copy(muscles(1 - std::max(0.f, -turn), 1 - std::max(0.f, turn)),
                        tables.begin() + static_cast<std::ptrdiff_t>(i * max_materials));
    }
    if (controlled) simulation.set_materials(tables);
    simulation.step(std::lround(period / dt));
  }
  return nearest;
}

int main() {
  const std::vector<float> bearings = {-60, -30, 0, 30, 60};  // [degrees]; positive is to the left
  std::vector<Vec3> targets;
  for (const float bearing : bearings)
    targets.push_back({4 * std::cos(bearing * pi / 180), 4 * std::sin(bearing * pi / 180), 0});
  const std::vector<float> steered = swim(targets, true), adrift = swim(targets, false);

  bool all_well = true;
  std::printf("target      nearest with control   without\n");
  for (std::size_t i = 0; i < targets.size(); ++i) {
    std::printf("%+4.0f deg           %6.3f m       %6.3f m\n", bearings[i], steered[i], adrift[i]);
    all_well = all_well && steered[i] < reach && adrift[i] > reach;
  }
  return all_well ? 0 : 1;
}
