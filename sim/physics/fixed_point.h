// SPDX-License-Identifier: Apache-2.0
// Forces and corrections are summed as integers.
//
// Many springs, faces and contacts add to one mass, from different threads, in an order that depends on timing. A sum
// of floats depends on its order. So each contribution is rounded once, to a whole number of units, and the sum is a
// 32-bit integer:
//
//   force on a mass = (round(f1 units/N) + round(f2 units/N) + ...) / (units/N)
//
//                    31            27            22                            0
//   sum              |s|...........|.............|.............................|
//   spring                                       |<---- at most 2^22 units --->|   hundreds of them fit
//   face, contact                  |<----------- at most 2^27 units ---------->|   a mass has few
//
// 1. Reproducible: integer sums do not depend on their order, so a robot's trajectory is the same bit for bit with any
//    number of threads, alone or in any batch.
// 2. Momentum: action and reaction are the same integer with opposite signs and cancel exactly.
// 3. Fast: GPUs add integers to shared memory in one instruction; floats would need a loop of compare-and-swap. The
//    rounding itself costs nothing, see rounding_magic.
// 4. Accurate: a unit is a power of two, chosen per robot as the finest one at which no spring can exceed its 22 bits
//    (fixed_point_scale() in measures.h).
//
// 5. Unbiased, where a model asks for it: slow water pushes a face with less than half a unit, which rounds to zero.
//    dithered() adds an offset to each force on a face that runs through [-1/2, 1/2) evenly from step to step, so that
//    the sum over many steps is right to a unit or two.
//
// Sums may wrap around on the way: unsigned addition is modular, so the result is right whenever the total fits.
#pragma once

#include <cstdint>

#include "mercury/host_device.h"
#include "mercury/vec3.h"

namespace mercury {

// The largest contribution of a spring, and of a face or contact, to one component of a sum.
inline constexpr float spring_limit_units = 4194304.f;  // 2^22
inline constexpr float face_limit_units = 134217728.f;  // 2^27
// A robot has exploded if a spring is longer than this many times the robot's longest rest length.
inline constexpr float stretch_limit = 16;

// Adding 1.5 x 2^23 rounds a value of at most 2^22 to an integer: floats of this size are whole numbers, so the
// addition itself rounds. The lower bits of the sum are the integer:
//
//   1.5 x 2^23 + 5     =  0x4b400005
//   1.5 x 2^23 - 5     =  0x4b3ffffb  =  0x4b400000 - 5
//
// The addition is part of a multiply-add that is needed anyway. Conversion instructions run on a slow unit of GPUs.
inline constexpr float rounding_magic = 12582912.f;              // 1.5 x 2^23
inline constexpr std::int32_t rounding_magic_bits = 0x4b400000;  // its bits

// round(value_per_distance * distance) + rounding_magic_bits. Halves round to the even integer, so the opposite
// distance gives exactly the opposite integer. A sum of many such terms subtracts all its rounding_magic_bits at once.
template <class Real>
MERCURY_HOST_DEVICE auto to_fixed_plus_magic(Real value_per_distance, Real distance) {
  return bits_of(multiply_add(value_per_distance, distance, rounding_magic));
}
MERCURY_HOST_DEVICE std::int32_t to_fixed_small(float value_per_distance, float distance) {
  // Unsigned, because a value out of range wraps around. Its robot has exploded, and the sum is not used.
  const auto bits = static_cast<std::uint32_t>(to_fixed_plus_magic(value_per_distance, distance));
  return static_cast<std::int32_t>(bits - static_cast<std::uint32_t>(rounding_magic_bits));
}

// The offset of a pair of faces in a step [units], times 2^32: multiples of irrational numbers fill the interval evenly
// (Weyl's theorem), here the golden ratio over steps and the inverse plastic number over pairs.
MERCURY_HOST_DEVICE std::uint32_t dither_of_step(std::int64_t step) {
  return static_cast<std::uint32_t>(static_cast<std::uint64_t>(step)) * 0x9e3779b9u;
}
MERCURY_HOST_DEVICE std::uint32_t dither_of_pair(std::uint32_t pair) { return pair * 0xc13fa9a9u; }
// Adds the offset to a force, before it is rounded. `factor` is 1, or 0 to leave the force as it is. The second face of
// a pair gets the offset half a unit further on. Word is a 32-bit number or a vector of them.
inline constexpr std::uint32_t second_face_dither = 0x80000000u;
template <class Vector, class Word, class Real>
MERCURY_HOST_DEVICE Vector dithered(Vector units, Word offset, Real factor) {
  const auto by = factor * (float_of_signed(offset) * 2.3283064365386963e-10f);  // 2^-32
  return {units.x + by, units.y + by, units.z + by};
}

// Whether the force of a face or contact, in units, is within its limit. False for NaN.
template <class Vector>
MERCURY_HOST_DEVICE auto fits(Vector units) {
  return all_of(absolute(units.x) < face_limit_units, absolute(units.y) < face_limit_units,
                absolute(units.z) < face_limit_units);
}

// Units of one robot, powers of two. The force solver sums forces, XPBD corrections of positions. Resistive water sums
// the forces of the environment apart, in units that do not depend on how stiff the springs are; elsewhere they are
// summed together, in one unit.
struct FixedPointScale {
  float force = 1;        // of springs [1/N]
  float correction = 1;   // [1/m]
  float environment = 1;  // of all other forces [1/N]
};

}  // namespace mercury
