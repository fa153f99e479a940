// One spring's force (Algorithm 1) or correction (Algorithm 2), for host and device.
#pragma once

#include "sim/host_device.h"
#include "sim/vec3.h"

namespace mercury {

// |d|^2, kept off zero so that two masses in one place push nothing instead of dividing by zero.
MERCURY_HOST_DEVICE float squared_length(Vec3 d) {
  return multiply_add(d.z, d.z, multiply_add(d.y, d.y, multiply_add(d.x, d.x, 1e-20f)));
}

// (|d| - L) / |d|, the part of d that a spring wants to lose.
MERCURY_HOST_DEVICE float excess(float squared, float length) {
  return multiply_add(-length, inverse_sqrt(squared), 1.0f);
}

// Eq. 2 (Hooke's law): the force on the first mass is this times d = x_second - x_first.
MERCURY_HOST_DEVICE float hooke(float squared, float length, float stiffness) {
  return stiffness * excess(squared, length);
}

// Eq. 3 and 4, with the missing -L restored and the gradient's square replaced by the split masses (Tonge et al. 2012):
// lambda / |d| with lambda = (|d| - L) / (s_a + s_b + 1/(k dt^2)). The first mass moves by this times d. Splits and
// compliance come divided by the fixed-point scale, so that the result is in units.
MERCURY_HOST_DEVICE float xpbd(float squared, float length, float splits, float compliance) {
  return excess(squared, length) * inverse(splits + compliance);
}

}  // namespace mercury
