// SPDX-License-Identifier: Apache-2.0
// What a step needs to know of a robot as a whole, the same for every backend.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mercury/configuration.h"
#include "mercury/robot.h"
#include "mercury/state.h"
#include "sim/physics/fixed_point.h"

namespace mercury {

struct RobotMeasures {
  float longest = 0;                                       // rest length [m]; 0 without springs
  float shortest = 0;                                      // rest length [m]
  std::array<bool, max_materials> used{};                  // materials that some spring has
  float contact_distance() const { return shortest / 2; }  // [m], on land
  // No spring's |d|^2 may exceed this [m2].
  float squared_stretch_limit() const { return stretch_limit * longest * stretch_limit * longest; }
};

RobotMeasures measure(const Robot& robot);

// Number of springs at each mass: s of the split masses (Tonge et al. 2012).
std::vector<std::uint32_t> valences(const Robot& robot);

// The finest powers of two at which no spring below the stretch limit leaves spring_limit_units.
FixedPointScale fixed_point_scale(const RobotMeasures& measures, std::span<const Material> materials,
                                  const Configuration& configuration);

// The spring to blame for an explosion, or no_spring: the first that `bad_mass` belongs to, if a mass left the finite,
// else the most strained of those that are longer than the stretch limit allows, else the most strained one.
std::uint32_t culprit_spring(const Robot& robot, std::span<const Vec3> positions, std::uint32_t bad_mass);

// `noted`, or a mass at most two faces from it that is more to blame: one that is out of reach or not finite, else the
// fastest. A backend that finds a face's force out of range notes a mass of that face or of one beside it, whichever is
// at hand; one that finds a spring too long may note none, and then a mass out of reach is to blame, if there is one.
std::uint32_t culprit_mass(const Robot& robot, const State& state, std::uint32_t noted);

}  // namespace mercury
