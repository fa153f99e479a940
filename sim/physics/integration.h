// SPDX-License-Identifier: Apache-2.0
// From forces to the next state (paper, Algorithms 1 and 2), for host and device. The paper's masses are 1 kg, so that
// force and acceleration are the same number; other masses multiply forces and corrections by 1 / m first.
//
//   Force solver                                    XPBD solver
//   F    = springs(x) + environment(x, v)           F    = environment(x, v)
//   w    = v + dt F / m                             w    = v + dt F / m                   accelerated()
//                                                   p    = x + dt w                       predicted positions
//                                                   c    = springs' corrections at p
//                                                   w   += c / dt
//   x'   = x + dt w                                 x'   = p + c
//   v'   = flow + zeta (w - flow)                   v'   = flow + zeta (w - flow)         end_step()
//
// Resistive water accelerates masses by the forces of the environment first, w = v + dt F / m, and then by those of the
// springs; both were summed at x^n, in units of their own (fixed_point.h). Springs with a relaxation time see w: with v
// instead, slow bodies tilt, since the rounding of their springs repeats from step to step.
//
// zeta = exp(-damping dt); the flow is that of the water, 0 without water. Where the ground resolves a contact, x' and
// w change together.
//
// The velocity w is a sum of its own. Algorithms 1 and 2 compute it as (x' - x) / dt, but the difference of two float
// positions loses most digits: 1 m from the origin floats are 6e-8 m apart, so at dt = 1 ms each step would add noise
// of 3e-5 m/s. For the same reason the ground reports the displacement it leaves.
#pragma once

#include <cmath>

#include "mercury/configuration.h"
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
  Vec3 drift;               // (1 - zeta) flow [m/s]; -0 where the flow is 0, so that adding it changes no bit
};

inline StepConstants step_constants(const Configuration& configuration) {
  const double zeta = std::exp(-configuration.damping * configuration.dt);
  const Vec3 flow = flow_of(configuration.environment);
  const auto drift = [&](float along) {
    return along == 0 ? -0.0f : static_cast<float>((1 - zeta) * static_cast<double>(along));
  };
  return {static_cast<float>(configuration.dt),
          static_cast<float>(1 / configuration.dt),
          static_cast<float>(zeta),
          {drift(flow.x), drift(flow.y), drift(flow.z)}};
}

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
  if constexpr (EnvironmentModel::has_flow)
    v = {multiply_add(step.zeta, v.x, step.drift.x), multiply_add(step.zeta, v.y, step.drift.y),
         multiply_add(step.zeta, v.z, step.drift.z)};
  else
    v = step.zeta * v;
}

// The same for a mass that may be fixed, which then stays at rest.
template <class Vector, class Real, class EnvironmentModel>
MERCURY_HOST_DEVICE void end_step(Vector& x, Vector& v, Real inverse_inertia, const EnvironmentModel& model,
                                  const StepConstants& step) {
  Vector moved = x, velocity = v;
  end_step(moved, velocity, model, step);
  const auto is_free = inverse_inertia > 0.0f;
  x = select(is_free, moved, x);
  v = select(is_free, velocity, v);
}

}  // namespace mercury
