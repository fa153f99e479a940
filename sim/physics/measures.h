// SPDX-License-Identifier: Apache-2.0
// Properties of a whole robot that a step needs, the same for every backend.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "mercury/configuration.h"
#include "mercury/robot.h"
#include "mercury/state.h"
#include "sim/physics/fixed_point.h"
#include "sim/physics/points.h"

namespace mercury {

struct RobotMeasures {
  float largest_face = 0;                  // area at rest [m2]
  float longest = 0;                       // longest rest length [m]; 0 without springs
  float shortest = 0;                      // shortest rest length [m]
  std::array<bool, max_materials> used{};  // by material: whether a spring has it
  // No spring's |d|^2 may exceed this [m2].
  float squared_stretch_limit() const { return stretch_limit * longest * stretch_limit * longest; }
};

RobotMeasures measure(const Robot& robot);

// k of the stiffest spring [N/m], without the stiffness scale.
float stiffest_spring(const RobotMeasures& measures, std::span<const Material> materials);

// Whether a spring has a relaxation time.
bool has_viscous_springs(const RobotMeasures& measures, std::span<const Material> materials);
// The relaxation time of all springs [s]; none if they differ.
std::optional<float> common_relaxation_time(const RobotMeasures& measures, std::span<const Material> materials);

// The distance within which two masses that no spring joins repel [m]; 0 without springs. Beyond half the shortest rest
// length it is at most 0.95 of the smallest distance of two such masses at rest.
float contact_distance(const Robot& robot, const RobotMeasures& measures, const Environment& environment);

// Number of springs at each mass: s of the mass splitting (springs.h).
std::vector<std::uint32_t> valences(const Robot& robot);

// The finest powers of two at which no spring within the stretch limit exceeds spring_limit_units:
//
//   force       2^22 units >= 18 L_max k_max             |d| <= 16 L_max, and L lies in [0, 2 L_max]
//   correction  2^22 units >= 18 L_max / (2 / m_max + 1 / (k_max dt^2))
//
// Viscous springs add at most viscous_limit rest lengths. Contacts and a minimum of 16 N, or of 16 N per kg of the
// lightest mass, extend the range of forces. In resistive water the environment has units of its own:
//
//   environment 2^27 units >= k_c distance, the drag on a face of twice the size at 20 m/s, and 1000 N (per kg of the
//                             lightest mass if that is below 1 kg)
FixedPointScale fixed_point_scale(const RobotMeasures& measures, std::span<const Material> materials,
                                  const Configuration& configuration, float contact_distance,
                                  const InertiaRange& inertia);

// tau d|d|/dt is at most this many of the robot's longest rest lengths.
inline constexpr float viscous_limit = 2;
// So this is the highest rate of length that counts [m/s]; 0 if no spring has a relaxation time.
float highest_length_rate(const RobotMeasures& measures, std::span<const Material> materials);

// The largest softening of a spring by XPBD, (w_a s_a + w_b s_b) k dt^2: springs behave as if their stiffness were k /
// (1 + softening), another one at each dt (docs/physics.md).
double xpbd_softening(const Robot& robot, const Configuration& configuration);

// The time step up to which the force solver is stable for small motions around the body at rest, if it is below the
// configuration's; infinite otherwise, and with XPBD. A vibration with w^2 = u.Au and damping u.Bu, A and B being the
// stiffnesses and tau times the stiffnesses over the masses, is stable while dt^2 u.Au + 2 dt u.Bu < 4
// (robots/body_properties.cpp). This looks at one vibration near the stiffest one, so it never names a dt that is too
// small.
double exceeded_dt(const Robot& robot, const Configuration& configuration);

// The spring that caused an explosion, as far as can be known: the first spring of `bad_mass`, if there is one; else,
// of the springs beyond the stretch limit, the one with the largest strain; else the one with the largest strain of
// all. no_spring if the robot has no springs.
std::uint32_t culprit_spring(const Robot& robot, std::span<const Vec3> positions, std::uint32_t bad_mass);

// The mass that caused an explosion, given the mass that the backend noted (RobotStatus::bad_mass). A backend that
// finds a face's force out of range notes some mass of that face or of a neighboring one. So this searches up to two
// faces around it, for a mass that is out of reach or not finite, otherwise for the fastest. A backend that finds a
// spring too long may note no mass. Then this returns a mass that is out of reach, or `noted` if there is none.
std::uint32_t culprit_mass(const Robot& robot, const State& state, std::uint32_t noted);

}  // namespace mercury
