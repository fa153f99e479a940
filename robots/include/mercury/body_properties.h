// SPDX-License-Identifier: Apache-2.0
// What a robot is made of, in the words of mechanics: mass, density, modulus, the frequencies at which it vibrates, and
// the time step that these allow. `mercury info` prints them.
#pragma once

#include <optional>

#include "mercury/robot.h"

namespace mercury {

struct BodyProperties {
  double mass = 0;  // of all points [kg]
  // Mass per volume within the skin [kg/m3]. None without a closed skin that shows outward.
  std::optional<double> density;
  // Young's modulus of an isotropic network of these springs [Pa]: E = sum of k L0^2 / (6 V), with the volume V within
  // the skin. It assumes that springs point in all directions alike and follow the body's strain, so it is an estimate:
  // real networks are softer. None where there is no density.
  std::optional<double> modulus;
  // Of the slowest vibration of the free body [Hz]: motions that deform no spring do not count. None if no spring
  // resists, or if the body has more than most_masses_with_modes masses.
  std::optional<double> lowest_frequency;
  // Up to this time step [s] the force solver is stable for small motions. None if no spring resists.
  std::optional<double> largest_dt;
};

// Above it, the slowest vibration would take seconds to compute.
inline constexpr std::size_t most_masses_with_modes = 2000;

// Measures a robot, which must be valid. Every stiffness is multiplied by `stiffness_scale`, as the environment does.
// Vibrations are those around the body at rest, in vacuum, with springs at their rest lengths; fixed points hold still.
BodyProperties body_properties(const Robot& robot, double stiffness_scale = 1);

}  // namespace mercury
