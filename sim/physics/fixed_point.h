// SPDX-License-Identifier: Apache-2.0
// Forces and corrections are summed as integers: a sum then does not depend on its order, so that runs are
// reproducible, action and reaction cancel exactly, and a GPU can add without a compare-and-swap loop.
#pragma once

#include <cstdint>

#include "mercury/host_device.h"
#include "mercury/vec3.h"

namespace mercury {

// A spring's contribution stays within this many units, so that hundreds of them fit into 32 bits.
inline constexpr float spring_limit_units = 4194304.f;  // 2^22
// A face's or a contact's contribution may be larger: there are few at a mass.
inline constexpr float face_limit_units = 134217728.f;  // 2^27
// No spring is longer than this many times the longest rest length of its robot, or the robot has exploded.
inline constexpr float stretch_limit = 16;

// Rounds a value of up to 2^22 units to an integer by one addition: 1.5 x 2^23 pushes the fraction out of the float,
// and what is left in its lower bits is the integer. (Conversions run on a GPU's slow unit.)
inline constexpr float rounding_magic = 12582912.f;              // 1.5 x 2^23
inline constexpr std::int32_t rounding_magic_bits = 0x4b400000;  // its bits

// round(value_per_distance * distance), both in units, plus rounding_magic_bits. Halves go to the even integer, so the
// opposite distance gives exactly the opposite integer.
template <class Real>
MERCURY_HOST_DEVICE auto to_fixed_plus_magic(Real value_per_distance, Real distance) {
  return bits_of(multiply_add(value_per_distance, distance, rounding_magic));
}
MERCURY_HOST_DEVICE std::int32_t to_fixed_small(float value_per_distance, float distance) {
  // Unsigned, since a value out of range wraps around; its robot has exploded and the sum is thrown away.
  const auto bits = static_cast<std::uint32_t>(to_fixed_plus_magic(value_per_distance, distance));
  return static_cast<std::int32_t>(bits - static_cast<std::uint32_t>(rounding_magic_bits));
}

// Whether face and contact forces, in units, fit; false for NaN as well.
template <class Vector>
MERCURY_HOST_DEVICE auto fits(Vector units) {
  return all_of(absolute(units.x) < face_limit_units, absolute(units.y) < face_limit_units,
                absolute(units.z) < face_limit_units);
}

// Units in one newton (force) or one metre (correction) for one robot: powers of two.
struct FixedPointScale {
  float force = 1;       // [1/N]
  float correction = 1;  // [1/m]
};

}  // namespace mercury
