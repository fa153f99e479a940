// SPDX-License-Identifier: Apache-2.0
// A summary of one robot's state. The device computes it, so that nobody has to read all masses.
#pragma once

#include <cstdint>
#include <limits>

#include "mercury/robot.h"
#include "mercury/vec3.h"

namespace mercury {

// Sums and maxima over one robot at the end of the last step. They agree with the formulas of mercury/observables.h
// within rounding.
struct Telemetry {
  Vec3 center_of_mass;        // [m]
  Vec3 velocity;              // of the center of mass [m/s]
  double kinetic_energy = 0;  // sum of m |v|^2 / 2, without added mass [J]
  double elastic_energy = 0;  // sum of k (|d| - L)^2 / 2, L the current rest lengths [J]
  double muscle_power = 0;    // that the muscles deliver now: sum of -k (|d| - L) dL/dt [W]
  float largest_strain = 0;   // max | |d| - L0 | / L0 over the springs [1]
  float strained_share = 0;   // of the springs: those of a strain above strained_limit [1]
  // How the body is folded (folding.h) [1]; NaN unless Simulation::measure_folding(), and for an exploded robot.
  float inverted = std::numeric_limits<float>::quiet_NaN(), overlap = std::numeric_limits<float>::quiet_NaN();
  // The cosine of the angle between the body's up axis, by its frame (brain.h), and the vertical [1]: 1 = as in its
  // file, 0 = on its side, -1 = upside down; NaN unless Simulation::measure_upright(), and for an exploded robot.
  float upright = std::numeric_limits<float>::quiet_NaN();
  bool exploded = false;                     // the robot is frozen, see State
  double exploded_at = 0;                    // when the step began that failed [s], if exploded
  std::uint32_t culprit_spring = no_spring;  // index in Robot::springs, if exploded and a spring is known as the cause
};

}  // namespace mercury
