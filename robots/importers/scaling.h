// SPDX-License-Identifier: Apache-2.0
// From the units of a file to those of a robot.
#pragma once

#include <span>

#include "mercury/robot.h"
#include "robots/importers/calibration.h"

namespace mercury {

// Stiffness of springs for beams of this elastic modulus and density, and the rest of the calibration: voxels of 0.1 m,
// and times that scale so that gravity stays what it is. Throws InputError for numbers that are too large or too small.
struct Scaling {
  Scaling(double edge, double stiffest_modulus, double density, double gravity);
  Calibration calibration;
  // [N/m]
  double stiffness(double elastic_modulus) const { return calibration.stiffness_per_modulus * elastic_modulus; }
  // Damping here [1/s], for voxels whose mean square root of the elastic modulus is this share of that of the stiffest.
  double damping(double slow_damping, double share) const;

  BeamModel model;
};

// The largest time step, of the form 1, 2 or 5 times a power of ten, at which the force solver is stable for all
// robots, at most 1e-3 s. Stiffnesses are those of the robots times the scale.
double stable_time_step(std::span<const Robot> robots, double stiffness_scale);

}  // namespace mercury
