// SPDX-License-Identifier: Apache-2.0
// From the beams of VoxCAD and voxcraft-sim to Mercury's springs; docs/formats.md derives the numbers.
//
//   there: a voxel is a mass density edge^3 in its middle;      here: masses of 1 kg at the corners of voxels, joined
//          beams of stiffness E edge join the middles                 by springs along edges and both kinds of
//          diagonals
//
// Two things of a straight bar stay what they were: its first longitudinal frequency, and its stretch by its own weight
// as a share of its length. Both follow from the speed of waves along the bar, so one stiffness gives both. Bending,
// shear and torsion of beams do not stay: equal springs have the ratios of their lattice (Poisson's ratio 0.35), beams
// other ones. Bodies with springs of their own (voxel_body.h) keep more of them.
#pragma once

#include <optional>
#include <span>

#include "mercury/robot.h"

namespace mercury {

inline constexpr double calibrated_edge = 0.1;  // of a voxel here [m]

// What beams and their world are, in the units of the file.
struct BeamModel {
  double elastic_modulus = 1e6;  // E of the stiffest material [Pa]; decides about the time step
  double density = 1e3;          // mean over the voxels [kg/m3]; here all masses are the same
  double edge = 0.01;            // of a voxel [m]
  double gravity = 9.81;         // downward [m/s2]
  double slow_damping = 0;       // zeta of the damping against the ground, 2 zeta sqrt(m E edge) v [1]
  double aggregate_drag = 0;     // c of evosoro's water, -c A (v.n)^2 n on each face that meets the water [kg/m3]
  // Voxels across the bar for which frequency and stretch are exact; 0 = a bar without a surface. Thinner bars are
  // slower and stretch more, thicker ones the reverse: with 4, the frequency is 14 % too low for a bar of 1 voxel, 9 %
  // too high for one without a surface.
  int thickness = 4;
};

struct Calibration {
  double length_scale = 1;           // meters here per meter there
  double time_scale = 1;             // seconds here per second there; frequencies [rad/s] are divided by it
  double stiffness_per_modulus = 0;  // of a spring, per elastic modulus [N/m per Pa]
  double gravity = 0;                // downward [m/s2]
  double damping = 0;                // Configuration::damping [1/s]
  double contact_stiffness = 0;      // Land::contact_stiffness times the stiffness scale [N/m]
  double drag_coefficient = 0;       // C_N of one-sided resistive water of 1000 kg/m3 [1]
  double largest_time_step = 0;      // below which the force solver is stable [s]
  double time_step = 0;              // at most a third of it, and at most 1e-3: 1, 2 or 5 times a power of ten [s]
};

// `time_scale` = seconds here per second there; none = 1, or as many as bring the time step to 1e-4 s where it would be
// shorter. Gravity, frequencies and vibrations scale together, so the motion is the same, only slower. Throws
// InputError("elastic modulus", ...) unless modulus, density, edge and time scale are above 0, all else is at least 0,
// and all results are finite and fit a float.
Calibration calibrate(const BeamModel& model, std::optional<double> time_scale = {});

// Seconds here per second there with which gravity is the same number there and here: the square root of the scale of
// lengths, as a film of a small thing is slowed down to look large.
double gravity_time_scale(double edge);

// The stiffness of a slice of a bar of springs, per stiffness of a spring and per mass of a layer [1]: 27/10 without a
// surface, 22/13 for one voxel. `thickness` = voxels across, 0 = without a surface.
double slice_stiffness(int thickness);

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
