// SPDX-License-Identifier: Apache-2.0
// Functions that run on host and device, and the arithmetic that differs between them. This is the only file that asks
// whether nvcc is compiling.
//
// An equation written in these names works for one float, and for a vector of floats whose type brings functions of the
// same names (sim/cpu/kernels/lanes.h). Products and sums are fused only where multiply_add() or fnma() say so, and
// only on the device: compiler options turn fusing off (-ffp-contract=off, --fmad=false). So every CPU rounds alike.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#ifdef __CUDACC__
#define MERCURY_HOST_DEVICE __host__ __device__ __forceinline__
#else
#define MERCURY_HOST_DEVICE \
  __attribute__((always_inline)) inline  // so that it is compiled for the instruction set of its caller
#endif

// Before a loop that shall stay one on the device.
#ifdef __CUDA_ARCH__
#define MERCURY_NO_UNROLL _Pragma("unroll 1")
#else
#define MERCURY_NO_UNROLL
#endif

namespace mercury {

// a b + c. One rounding on the device, two on the host.
MERCURY_HOST_DEVICE float multiply_add(float a, float b, float c) {
#ifdef __CUDA_ARCH__
  return __fmaf_rn(a, b, c);
#else
  return a * b + c;
#endif
}

// c - a b, rounded in the same way.
MERCURY_HOST_DEVICE float fnma(float a, float b, float c) {
#ifdef __CUDA_ARCH__
  return __fmaf_rn(-a, b, c);
#else
  return c - a * b;
#endif
}

MERCURY_HOST_DEVICE float absolute(float a) { return std::fabs(a); }
MERCURY_HOST_DEVICE float smaller(float a, float b) { return std::fmin(a, b); }
MERCURY_HOST_DEVICE float larger(float a, float b) { return std::fmax(a, b); }
MERCURY_HOST_DEVICE float square_root(float a) { return std::sqrt(a); }

// Choices that a vector of floats makes lane by lane.
MERCURY_HOST_DEVICE float select(bool condition, float yes, float no) { return condition ? yes : no; }
MERCURY_HOST_DEVICE std::uint32_t select(bool condition, std::uint32_t yes, std::uint32_t no) {
  return condition ? yes : no;
}
MERCURY_HOST_DEVICE float negated_where(bool condition, float a) { return condition ? -a : a; }
MERCURY_HOST_DEVICE bool all_of(bool a, bool b, bool c) { return a && b && c; }

// 1 / sqrt(a) for a > 0. On the device within 2 units in the last place.
MERCURY_HOST_DEVICE float inverse_sqrt(float a) {
#ifdef __CUDA_ARCH__
  float result;
  asm("rsqrt.approx.ftz.f32 %0, %1;" : "=f"(result) : "f"(a));
  return result;
#else
  return 1.0f / std::sqrt(a);
#endif
}

// 1 / a. On the device within 1 unit in the last place.
MERCURY_HOST_DEVICE float inverse(float a) {
#ifdef __CUDA_ARCH__
  float result;
  asm("rcp.approx.ftz.f32 %0, %1;" : "=f"(result) : "f"(a));
  return result;
#else
  return 1.0f / a;
#endif
}

MERCURY_HOST_DEVICE std::int32_t bits_of(float a) {
#ifdef __CUDA_ARCH__
  return __float_as_int(a);
#else
  return std::bit_cast<std::int32_t>(a);
#endif
}

MERCURY_HOST_DEVICE std::uint64_t bits_of(double a) {
#ifdef __CUDA_ARCH__
  return static_cast<std::uint64_t>(__double_as_longlong(a));
#else
  return std::bit_cast<std::uint64_t>(a);
#endif
}
MERCURY_HOST_DEVICE double double_of(std::uint64_t bits) {
#ifdef __CUDA_ARCH__
  return __longlong_as_double(static_cast<long long>(bits));
#else
  return std::bit_cast<double>(bits);
#endif
}

// The bits as a two's complement integer, converted to float.
MERCURY_HOST_DEVICE float float_of_signed(std::uint32_t a) { return static_cast<float>(static_cast<std::int32_t>(a)); }
MERCURY_HOST_DEVICE bool top_bit(std::uint32_t a) { return (a & 0x80000000u) != 0; }

// Rounds to the nearest integer, ties to even; |a| < 2^31.
MERCURY_HOST_DEVICE std::int32_t round_to_int(float a) {
#ifdef __CUDA_ARCH__
  return __float2int_rn(a);
#else
  constexpr double magic = 6755399441055744.0;  // 1.5 x 2^52: the addition rounds, as in sim/physics/fixed_point.h
  return static_cast<std::int32_t>(std::bit_cast<std::int64_t>(static_cast<double>(a) + magic));
#endif
}

}  // namespace mercury
