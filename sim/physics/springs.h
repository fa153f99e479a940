// SPDX-License-Identifier: Apache-2.0
// One spring's force (Algorithm 1) or correction (Algorithm 2), for host and device; Real is a float or a vector of
// them.
#pragma once

#include "mercury/host_device.h"
#include "mercury/vec3.h"

namespace mercury {

// |d|^2, kept off zero so that two masses in one place push nothing instead of dividing by zero.
template <class Vector>
MERCURY_HOST_DEVICE auto squared_length(Vector d) {
  return multiply_add(d.z, d.z, multiply_add(d.y, d.y, multiply_add(d.x, d.x, 1e-20f)));
}

// (|d| - L) / |d|, the part of d that a spring wants to lose. With a power of two for `one`, and L times it, the result
// is times it, too, bit for bit.
template <class Real>
MERCURY_HOST_DEVICE Real excess(Real squared, Real length, Real one = 1.0f) {
  return fnma(length, inverse_sqrt(squared), one);
}

// Eq. 2 (Hooke's law): the force on the first mass is this times d = x_second - x_first.
template <class Real>
MERCURY_HOST_DEVICE Real hooke(Real squared, Real length, Real stiffness, Real one = 1.0f) {
  return stiffness * excess(squared, length, one);
}

// Eq. 3 and 4, with the missing -L restored and the gradient's square replaced by the split masses (Tonge et al. 2012):
// lambda / |d| with lambda = (|d| - L) / (s_a + s_b + 1/(k dt^2)). The first mass moves by this times d.
template <class Real>
MERCURY_HOST_DEVICE Real xpbd(Real squared, Real length, Real splits, Real compliance, Real one = 1.0f) {
  return excess(squared, length, one) * inverse(splits + compliance);
}
// The last factor, which a spring keeps from step to step: with it for stiffness, hooke() gives xpbd() bit for bit.
template <class Real>
MERCURY_HOST_DEVICE Real xpbd_stiffness(Real splits, Real compliance) {
  return inverse(splits + compliance);
}

}  // namespace mercury
