// SPDX-License-Identifier: Apache-2.0
// The state of all robots of a simulation at one time, and what follows from it for one of them.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "mercury/observables.h"
#include "mercury/simulation.h"

namespace mercury {

struct GroupState {
  double time = 0;              // [s]
  std::vector<Vec3> positions;  // as Simulation::read_positions [m]
  std::vector<Vec3> velocities;
  DrivenMaterials driven;
};
GroupState read_state(const Simulation& simulation);

// A robot's part of a list with one element per mass of all robots.
std::span<const Vec3> masses_of(const Simulation& simulation, std::size_t robot, std::span<const Vec3> all);

// A robot's material table as the simulation has it now without what drives it, by id.
std::vector<Material> materials_of(const Simulation& simulation, std::size_t robot);
// The same with what drives it, at the time of the state.
std::vector<MaterialNow> materials_at(const Simulation& simulation, std::size_t robot, const GroupState& state);

// floor_forces() of mercury/observables.h for one robot.
std::vector<FloorForce> floor_forces(const Simulation& simulation, std::size_t robot, const GroupState& state);

// The sum of all forces on each mass of one robot, of springs, water, gravity and the floor [N]. 0 for fixed masses.
std::vector<Vec3> net_forces(const Simulation& simulation, std::size_t robot, const GroupState& state);

}  // namespace mercury
