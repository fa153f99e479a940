// SPDX-License-Identifier: Apache-2.0
#include "evolution/trial_robot.h"

#include <algorithm>
#include <cmath>

#include "mercury/cppn.h"
#include "mercury/error.h"
#include "mercury/material.h"
#include "mercury/random.h"
#include "mercury/real_body.h"
#include "mercury/voxel.h"
#include "robots/carried_points.h"

namespace mercury {
namespace {

constexpr double two_pi = 6.283185307179586;

VoxelGrid grid_of(const Robot& robot) {
  if (std::optional<VoxelGrid> grid = voxel_grid_of(robot)) return *std::move(grid);
  if (const std::optional<CppnGenome> genome = cppn_genome_of(robot)) return paint(*genome);
  throw InputError("damage", "only robots of voxels can lose some");
}

Robot without_some_voxels(const Robot& robot, double share, Random& random) {
  const VoxelGrid whole = grid_of(robot);
  VoxelGrid damaged = whole;
  for (MaterialId& cell : damaged.cells)
    if (random.chance(share)) cell = air;
  if (std::ranges::all_of(damaged.cells, [](MaterialId cell) { return cell == air; })) damaged = whole;
  Robot changed = make_voxel_robot(damaged, {.name = robot.name, .materials = without_real_body(robot).materials});
  if (const std::optional<RealMaterial> material = real_material_of(robot))
    changed = with_real_body(changed, *material);
  carry_points(robot, changed);
  return changed;
}

void delay_muscles(Robot& robot, double delay) {
  for (Material& material : robot.materials) {
    const double phase = material.phase + static_cast<double>(material.frequency) * delay;
    material.phase = static_cast<float>(phase - two_pi * std::floor(phase / two_pi));
  }
}

void disturb_materials(Robot& robot, double noise, Random& random) {
  constexpr float largest_amplitude = 0.9f;
  for (Material& material : robot.materials) {
    const auto factor = [&] { return static_cast<float>(std::max(0.1, 1 + noise * random.normal())); };
    material.stiffness *= factor();
    material.amplitude = std::clamp(material.amplitude * factor(), -largest_amplitude, largest_amplitude);
  }
}

}  // namespace

Robot trial_robot(const Robot& robot, const TrialSettings& settings, std::uint64_t seed, int trial) {
  Random random(seed_of(seed, static_cast<std::uint64_t>(trial)));
  const double delay = trial == 0 ? 0 : random.uniform(0, settings.delay);
  Robot changed = settings.damage > 0 ? without_some_voxels(robot, settings.damage, random) : robot;
  const std::span<const Material> materials = materials_of(robot);
  changed.materials.assign(materials.begin(), materials.end());
  changed.material_names = robot.material_names;
  if (robot.materials.empty() && robot.brain)  // whose sensors may name muscles of the default table
    for (std::size_t id = 0; id < materials.size(); ++id)
      changed.material_names.push_back(default_material_name(static_cast<MaterialId>(id)));
  changed.actuators = robot.actuators;
  carry_brain(robot, changed);
  if (delay > 0) delay_muscles(changed, delay);
  if (settings.noise > 0) disturb_materials(changed, settings.noise, random);
  return changed;
}

}  // namespace mercury
