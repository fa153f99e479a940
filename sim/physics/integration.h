// SPDX-License-Identifier: Apache-2.0
// From forces to the next state (paper, Algorithms 1 and 2), for host and device.
#pragma once

#include "sim/physics/springs.h"

namespace mercury {

inline constexpr float farthest = 1e6f;  // [m]; beyond it a robot has exploded

// False for NaN as well.
template <class Vector>
MERCURY_HOST_DEVICE auto within_reach(Vector x) {
  return all_of(absolute(x.x) <= farthest, absolute(x.y) <= farthest, absolute(x.z) <= farthest);
}

struct StepConstants {
  float dt = 1e-3f;         // [s]
  float inverse_dt = 1e3f;  // [1/s]
  float zeta = 1;           // exp(-damping dt)
};

MERCURY_HOST_DEVICE Vec3 multiply_add(float a, Vec3 b, Vec3 c) {
  return {multiply_add(a, b.x, c.x), multiply_add(a, b.y, c.y), multiply_add(a, b.z, c.z)};
}

// v + dt F for a unit mass: the velocity before damping and contact. Algorithm 2's prediction lacks the inertia dt v
// as printed; it is restored here.
template <class Vector>
MERCURY_HOST_DEVICE Vector accelerated(Vector velocity, Vector force, const StepConstants& step) {
  return multiply_add(step.dt, force, velocity);
}

// Ends a step at position x with undamped velocity v: contact with the floor, then damping. The velocity is summed on
// its own, never differenced from positions, whose last digit is too coarse for that.
template <class Vector, class EnvironmentModel>
MERCURY_HOST_DEVICE void end_step(Vector& x, Vector& v, const EnvironmentModel& model, const StepConstants& step) {
  if constexpr (EnvironmentModel::has_floor) {
    Vector displacement = step.dt * v;
    const auto touched = model.floor(x, displacement);
    v = select(touched, step.inverse_dt * displacement, v);
  }
  v = step.zeta * v;
}

}  // namespace mercury
