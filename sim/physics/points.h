// SPDX-License-Identifier: Apache-2.0
// What the masses of a robot are in a step, apart from where they are.
//
//   inertia   m + C_A rho V    accelerated by all forces. V is the volume of water that the mass displaces, and the
//                              share C_A of that water moves along (added mass)
//   weight    m - rho V        pulled by gravity; rho V of water would float in its place (buoyancy)
//
// The volume within the skin is divided among the masses of the skin in proportion to their share of its area, at rest.
// Only resistive water displaces. In all other environments V = 0, and with masses of 1 kg both are 1.
#pragma once

#include <span>
#include <variant>
#include <vector>

#include "mercury/environment.h"
#include "mercury/robot.h"

namespace mercury {

struct PointProperties {
  float inverse_inertia = 1;  // [1/kg]; 0 = fixed
  float weight = 1;           // [kg]
};

// One per mass.
std::vector<PointProperties> point_properties(const Robot& robot, const Environment& environment);

// The largest and the smallest inertia among the masses that are not fixed [kg]; 1 if all are.
struct InertiaRange {
  float lightest = 1, heaviest = 1;
};
InertiaRange inertia_range(std::span<const PointProperties> points);

// Whether the robot says what its masses are, or that some are fixed. The step then needs a model with real_bodies
// (environments.h).
inline bool has_own_points(const Robot& robot) { return !robot.mass.empty() || !robot.fixed.empty(); }
// Whether point_properties() are other than the default.
inline bool has_own_points(const Robot& robot, const Environment& environment) {
  return has_own_points(robot) || std::holds_alternative<ResistiveDrag>(environment.water);
}

// The velocity of each mass at the start [m/s]; fixed masses have none.
std::vector<Vec3> start_velocities(const Robot& robot);

}  // namespace mercury
