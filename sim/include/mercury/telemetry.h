// SPDX-License-Identifier: Apache-2.0
// What a batch tells about each robot without reading its masses.
#pragma once

#include <cstdint>

#include "mercury/vec3.h"

namespace mercury {

inline constexpr std::uint32_t no_spring = 0xffffffffu;

struct Telemetry {
  Vec3 center_of_mass;                       // [m]
  Vec3 velocity;                             // of the centre of mass [m/s]
  double kinetic_energy = 0;                 // [J]
  double elastic_energy = 0;                 // of all springs at their present rest lengths [J]
  float largest_strain = 0;                  // max | |d| - L0 | / L0 over the springs [1]
  bool exploded = false;                     // left the finite, and was frozen
  double exploded_at = 0;                    // [s], if exploded
  std::uint32_t culprit_spring = no_spring;  // index in Robot::springs, if exploded and a spring is to blame
};

}  // namespace mercury
