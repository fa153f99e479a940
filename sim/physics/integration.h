// SPDX-License-Identifier: Apache-2.0
// From forces to the next state (paper, Algorithms 1 and 2), for host and device. All masses are 1 kg, so force and
// acceleration are the same number.
//
//   Force solver                                    XPBD solver
//   F    = springs(x) + environment(x, v)           F    = environment(x, v)
//   w    = v + dt F                                 w    = v + dt F                       accelerated()
//                                                   p    = x + dt w                       predicted positions
//                                                   c    = springs' corrections at p
//                                                   w   += c / dt
//   x'   = x + dt w                                 x'   = p + c
//   v'   = zeta w                                   v'   = zeta w                         end_step()
//
// zeta = exp(-damping dt). Where the ground resolves a contact, x' and w change together.
//
// The velocity w is a sum of its own. Algorithms 1 and 2 compute it as (x' - x) / dt, but the difference of two float
// positions loses most digits: 1 m from the origin floats are 6e-8 m apart, so at dt = 1 ms each step would add noise
// of 3e-5 m/s. For the same reason the ground reports the displacement it leaves.
#pragma once

#include "sim/physics/springs.h"

namespace mercury {

inline constexpr float farthest = 1e6f;  // [m]; a robot with a mass beyond this has exploded

// False for NaN.
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

// w = v + dt F: the velocity before damping and contact. Algorithm 2 as printed predicts p = x + dt^2 F; it lacks the
// inertia dt v, which is restored here.
template <class Vector>
MERCURY_HOST_DEVICE Vector accelerated(Vector velocity, Vector force, const StepConstants& step) {
  return multiply_add(step.dt, force, velocity);
}

// Contact with the ground, then damping. On entry x is the position at the end of the step, and v the velocity w that
// led there.
template <class Vector, class EnvironmentModel>
MERCURY_HOST_DEVICE void end_step(Vector& x, Vector& v, const EnvironmentModel& model, const StepConstants& step) {
  if constexpr (EnvironmentModel::has_ground)
    if (model.acts_on_ground()) {
      Vector displacement = step.dt * v;
      const auto touched = model.touch_ground(x, displacement);
      v = select(touched, step.inverse_dt * displacement, v);
    }
  v = step.zeta * v;
}

}  // namespace mercury
