// SPDX-License-Identifier: Apache-2.0
// One spring's force (Algorithm 1) or correction (Algorithm 2), for host and device. Real is a float or a vector of
// floats.
//
// Both are a scalar times the vector d = x_b - x_a from the first mass to the second, and the second mass gets the
// opposite. No square root is needed: with r = 1 / |d|,
//
//   constraint ratio   (|d| - L) / |d|  =  1 - L r
//
// Force (equation 2, Hooke's law):
//   F_a = k (|d| - L) d / |d|
//       = k (1 - L r) d                                                            hooke()
//
// XPBD (equations 3 and 4) moves both ends along d to reduce C = |d| - L, with the compliance 1 / (k dt^2):
//   lambda = C / (|grad C|^2 + 1 / (k dt^2))
//   dx_a   = lambda d / |d|
//
// All springs are projected from the same predicted positions (Jacobi), so corrections at a mass add up, and would
// overshoot. Mass splitting (Tonge et al. 2012) divides a mass among its s springs: each sees 1/s of it, and inverse
// masses enter |grad C|^2, which becomes s_a + s_b. A sweep is then stable at any dt.
//   dx_a   = (|d| - L) / (s_a + s_b + 1 / (k dt^2)) d / |d|
//          = (1 - L r) / (s_a + s_b + 1 / (k dt^2)) d                              xpbd()
//
// Equation 3 of the paper lacks `- L`; it is restored. The paper does not split the masses.
//
// Masses other than 1 kg have inverse masses w. Then lambda moves the first mass by w_a lambda, and the denominator is
// w_a s_a + w_b s_b + 1 / (k dt^2).
//
// A relaxation time tau makes a spring resist its rate of length (Kelvin-Voigt). It acts as if L were shorter by
// tau d|d|/dt:
//   F_a    = k (|d| - L + tau d|d|/dt) d / |d|,   d|d|/dt = d . (v_b - v_a) / |d|      length_rate()
//   lambda = (C + tau d|d|/dt) / ((1 + tau / dt) (w_a s_a + w_b s_b) + 1 / (k dt^2))
// The second line is XPBD's damping (Macklin et al. 2016, equation 26) with beta = k tau, where v is the velocity that
// leads to the predicted positions.
#pragma once

#include "mercury/host_device.h"
#include "mercury/vec3.h"

namespace mercury {

// |d|^2 [m2], and 1e-20 more, so that two masses in one place give no force instead of a division by zero.
template <class Vector>
MERCURY_HOST_DEVICE auto squared_length(Vector d) {
  return multiply_add(d.z, d.z, multiply_add(d.y, d.y, multiply_add(d.x, d.x, 1e-20f)));
}

// (|d| - L) / |d| times `one`. `one` is 1, or a power of two that `length` was multiplied by as well: results then
// differ in the exponent alone, so that units of fixed point cost nothing.
template <class Real>
MERCURY_HOST_DEVICE Real constraint_ratio(Real squared, Real length, Real one = 1.0f) {
  return fnma(length, inverse_sqrt(squared), one);
}

// The force on the first mass is this times d.
template <class Real>
MERCURY_HOST_DEVICE Real hooke(Real squared, Real length, Real stiffness, Real one = 1.0f) {
  return stiffness * constraint_ratio(squared, length, one);
}

// d|d|/dt [m/s], at most `most`, so that a spring's force keeps within the range of its sums (fixed_point.h).
// `approach` is d . (v_b - v_a).
template <class Real>
MERCURY_HOST_DEVICE Real length_rate(Real squared, Real approach, Real most) {
  return larger(smaller(approach * inverse_sqrt(squared), most), -most);
}

// The rest length that a spring with a relaxation time seems to have. As in constraint_ratio(), `length` and
// `relaxation_time` may be multiplied by a power of two.
template <class Real>
MERCURY_HOST_DEVICE Real viscous_length(Real length, Real relaxation_time, Real rate) {
  return fnma(relaxation_time, rate, length);
}

// 1 + tau / dt [1].
MERCURY_HOST_DEVICE float viscous_factor(float relaxation_time, float inverse_dt) {
  return multiply_add(relaxation_time, inverse_dt, 1.0f);
}

// The first mass moves by this times d. `valence_sum` is s_a + s_b, the numbers of springs at the two ends, each times
// the inverse mass there, and viscous_factor().
template <class Real>
MERCURY_HOST_DEVICE Real xpbd(Real squared, Real length, Real valence_sum, Real compliance, Real one = 1.0f) {
  return constraint_ratio(squared, length, one) * inverse(valence_sum + compliance);
}
// The factor of xpbd() that stays the same from step to step. With it as the stiffness, hooke() gives xpbd() bit for
// bit.
template <class Real>
MERCURY_HOST_DEVICE Real xpbd_stiffness(Real valence_sum, Real compliance) {
  return inverse(valence_sum + compliance);
}

}  // namespace mercury
