// SPDX-License-Identifier: Apache-2.0
// From the units of a file to those of a robot.
#pragma once

#include <span>

#include "mercury/import.h"
#include "mercury/robot.h"

namespace mercury {

// Lengths grow so that voxels have 0.1 m. Times grow with the square root of lengths, so that gravity stays what it is:
// the robot is the same, seen larger and slower.
struct Scaling {
  explicit Scaling(double edge);  // of a voxel in the file [m]
  double length = 1;              // metres here per metre there
  double time = 1;                // seconds here per second there

  // Of every spring of a voxel, so that a wave of compression takes as long for a voxel as in the file, in scaled time
  // [N/m].
  double stiffness(double elastic_modulus, double density) const;
  double acceleration(double there) const { return there * length / (time * time); }
};

// The largest time step, of the form 1, 2 or 5 times a power of ten, at which the force solver is stable for all
// robots, at most 1e-3 s. Stiffnesses are those of the robots times the scale.
double stable_time_step(std::span<const Robot> robots, double stiffness_scale);

}  // namespace mercury
