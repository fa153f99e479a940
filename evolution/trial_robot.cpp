// SPDX-License-Identifier: Apache-2.0
#include "evolution/trial_robot.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

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
  if (const std::optional<CppnGenome> genome = cppn_genome_of(robot)) return largest_body(paint(*genome));
  throw InputError("damage", "only robots of voxels can lose some");
}

// "muscle 3" of "muscle 3, 2 x edge", as real bodies name the materials that they make of one.
std::string made_of(const std::string& name) { return name.substr(0, name.rfind(", ")); }

// The actuators of a real body for another one of the same materials, whose table has other numbers.
std::vector<Actuator> actuators_for(const Robot& other, const Robot& robot) {
  std::vector<Actuator> actuators = robot.actuators;
  if (!actuators.empty() && robot.material_names.empty())
    throw InputError("damage", "actuators of a real body need the names of its materials");
  for (Actuator& actuator : actuators) {
    std::set<std::string> driven;
    for (const MaterialId id : actuator.materials) driven.insert(made_of(robot.material_names[id]));
    actuator.materials.clear();
    for (std::size_t id = 1; id < other.materials.size(); ++id)
      if (driven.contains(made_of(other.material_names[id]))) actuator.materials.push_back(static_cast<MaterialId>(id));
  }
  return actuators;
}

Robot without_some_voxels(const Robot& robot, double share, Random& random) {
  const VoxelGrid whole = grid_of(robot);
  VoxelGrid damaged = whole;
  for (MaterialId& cell : damaged.cells)
    if (random.chance(share)) cell = air;
  if (std::ranges::all_of(damaged.cells, [](MaterialId cell) { return cell == air; })) damaged = whole;
  const Robot paper = without_real_body(robot);
  const std::optional<CppnGenome> genome = cppn_genome_of(paper);
  Robot changed = genome ? grow_part(*genome, damaged, robot.name) : make_voxel_robot(damaged, {.name = robot.name});
  changed.materials = paper.materials;
  changed.material_names = paper.material_names;
  if (const std::optional<RealMaterial> material = real_material_of(robot)) {
    changed = with_real_body(changed, *material);
    changed.actuators = actuators_for(changed, robot);
  } else {
    changed.actuators = robot.actuators;
  }
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
  if (changed.materials.empty()) changed.materials.assign(default_materials().begin(), default_materials().end());
  if (robot.materials.empty() && robot.brain)  // whose sensors may name muscles of the default table
    for (std::size_t id = 0; id < changed.materials.size(); ++id)
      changed.material_names.push_back(default_material_name(static_cast<MaterialId>(id)));
  carry_brain(robot, changed);
  if (delay > 0) delay_muscles(changed, delay);
  if (settings.noise > 0) disturb_materials(changed, settings.noise, random);
  return changed;
}

}  // namespace mercury
