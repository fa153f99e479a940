// SPDX-License-Identifier: Apache-2.0
// Learns to swim by random search.
//
// An eel of 12 x 2 x 2 voxels has six muscles along its left side and their antagonists along its right side. All have
// the same frequency. The search varies their six phases, which decide in what order the segments bend. At first all
// phases are equal: the body only curls and uncurls, and hardly moves forward. In each generation, every child gets the
// best phases so far plus a random change (a (1 + lambda) evolution strategy with an adaptive step size). All children
// swim at the same time in one batch, and the one that swims farthest is kept. Soon the segments bend one after the
// other.
//
// All have the same body, so the batch is built once: set_materials() gives each robot the muscles of its child,
// reset() puts all back to the start, step() simulates, and telemetry() reports how far each swam. The exit status is 0
// if the best swims at least five times as far as the first.
#include <algorithm>
#include <array>
#include <cstdio>
#include <vector>

#include <mercury/random.h>
#include <mercury/simulation.h>
#include <mercury/voxel.h>

using namespace mercury;

constexpr int segments = 6, length_in_voxels = 12, children = 16, generations = 20;
constexpr double dt = 2e-3, start = 2, seconds = 6;  // [s]

using Phases = std::array<float, segments>;  // [rad]

// Muscle ids 1 to 6 stand along the left side, 7 to 12 along the right side.
VoxelGrid eel() {
  VoxelGrid grid(length_in_voxels, 2, 2);
  for (int z = 0; z < 2; ++z)
    for (int y = 0; y < 2; ++y)
      for (int x = 0; x < length_in_voxels; ++x)
        grid.cell(x, y, z) = static_cast<MaterialId>(1 + x * segments / length_in_voxels + y * segments);
  return grid;
}

// All materials of an eel with these phases. material_table adds those of the springs between two segments.
std::vector<Material> muscles(const Phases& phases) {
  std::array<Material, base_material_count> bases{};
  for (std::size_t i = 0; i < segments; ++i) {
    bases[i] = {.stiffness = 6000, .amplitude = 0.3f, .frequency = 6, .phase = phases[i]};
    bases[i + segments] = bases[i];
    bases[i + segments].amplitude = -0.3f;  // the antagonist shortens as the muscle lengthens
  }
  return material_table(bases);
}

// How far each robot comes with its phases [m], once it is under way.
std::vector<float> swim(Simulation& simulation, const std::vector<Phases>& candidates) {
  std::vector<Material> tables = simulation.materials();  // max_materials for each robot
  for (std::size_t i = 0; i < candidates.size(); ++i)
    std::ranges::copy(muscles(candidates[i]), tables.begin() + static_cast<std::ptrdiff_t>(i * max_materials));
  simulation.set_materials(tables);
  simulation.reset();
  simulation.step(static_cast<std::int64_t>(start / dt));
  const std::vector<Telemetry> before = simulation.telemetry();
  simulation.step(static_cast<std::int64_t>(seconds / dt));
  std::vector<float> distances;
  for (const Telemetry& after : simulation.telemetry())
    distances.push_back(after.exploded ? 0 : length(after.center_of_mass - before[distances.size()].center_of_mass));
  return distances;
}

int main() {
  const Robot robot = make_voxel_robot(eel(), {.name = "eel", .materials = muscles({})});
  Simulation simulation({.dt = dt, .environment = Ocean{}}, std::vector<Robot>(children, robot));
  std::printf("%d eels of %zu springs at a time on %s\n", children, robot.springs.size(),
              simulation.device_name().c_str());

  Random random(1);
  Phases best{};
  const float first = swim(simulation, {best})[0];
  float farthest = first, spread = 0.8f;  // of the changes [rad]
  std::printf("all in step:   %.3f m in %g s\n", first, seconds);

  for (int generation = 1; generation <= generations; ++generation) {
    std::vector<Phases> candidates(children, best);
    for (Phases& phases : candidates)
      for (float& phase : phases) phase += spread * static_cast<float>(random.normal());
    const std::vector<float> distances = swim(simulation, candidates);
    const auto winner = std::ranges::max_element(distances);
    const bool better = *winner > farthest;
    if (better) {
      farthest = *winner;
      best = candidates[static_cast<std::size_t>(winner - distances.begin())];
    }
    spread *= better ? 1.2f : 0.7f;  // bolder after a success, finer after none
    std::printf("generation %2d: best %.3f m%s\n", generation, farthest, better ? "" : " (as before)");
  }

  std::printf("phases from tail to head [rad]:");
  for (const float phase : best) std::printf(" %.2f", phase);
  std::printf("\nthe best swims %.1f times as far as the first\n", farthest / first);
  return farthest > 5 * first ? 0 : 1;
}
