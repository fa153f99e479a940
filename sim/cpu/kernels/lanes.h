// SPDX-License-Identifier: Apache-2.0
// Vectors of floats for the instruction set that the including file is compiled for. They have the functions of
// mercury/host_device.h, so that the equations of sim/physics apply to several masses or springs at once.
//
// Each lane holds the bits that a float would: products and sums are never fused, square roots and divisions are
// IEEE's.
#pragma once

#include <hwy/highway.h>

#include <cstdint>

#include "mercury/host_device.h"
#include "mercury/vec3.h"

HWY_BEFORE_NAMESPACE();
namespace mercury::cpu::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

inline constexpr hn::CappedTag<float, 16> floats;
inline constexpr hn::RebindToSigned<decltype(floats)> integers;
inline constexpr hn::RebindToUnsigned<decltype(floats)> words;
inline constexpr hn::RepartitionToWide<decltype(words)> long_words;
inline constexpr std::size_t lane_count = hn::MaxLanes(floats);

struct Mask {
  hn::Mask<decltype(floats)> m;
};

struct Lanes {
  hn::Vec<decltype(floats)> v;
  Lanes() = default;
  HWY_INLINE Lanes(hn::Vec<decltype(floats)> vector) : v(vector) {}
  HWY_INLINE Lanes(float all) : v(hn::Set(floats, all)) {}
};

struct Integers {
  hn::Vec<decltype(integers)> v;
};

struct Words {
  hn::Vec<decltype(words)> v;
  Words() = default;
  HWY_INLINE Words(hn::Vec<decltype(words)> vector) : v(vector) {}
  HWY_INLINE explicit Words(std::uint32_t all) : v(hn::Set(words, all)) {}
};

HWY_INLINE Lanes operator+(Lanes a, Lanes b) { return hn::Add(a.v, b.v); }
HWY_INLINE Lanes operator-(Lanes a, Lanes b) { return hn::Sub(a.v, b.v); }
HWY_INLINE Lanes operator*(Lanes a, Lanes b) { return hn::Mul(a.v, b.v); }
HWY_INLINE Lanes operator/(Lanes a, Lanes b) { return hn::Div(a.v, b.v); }
HWY_INLINE Lanes operator-(Lanes a) { return hn::Neg(a.v); }
HWY_INLINE Mask operator<(Lanes a, Lanes b) { return {hn::Lt(a.v, b.v)}; }
HWY_INLINE Mask operator<=(Lanes a, Lanes b) { return {hn::Le(a.v, b.v)}; }
HWY_INLINE Mask operator>(Lanes a, Lanes b) { return {hn::Lt(b.v, a.v)}; }

HWY_INLINE Lanes multiply_add(Lanes a, Lanes b, Lanes c) { return a * b + c; }
HWY_INLINE Lanes fnma(Lanes a, Lanes b, Lanes c) { return c - a * b; }
HWY_INLINE Lanes absolute(Lanes a) { return hn::Abs(a.v); }
HWY_INLINE Lanes square_root(Lanes a) { return hn::Sqrt(a.v); }
HWY_INLINE Lanes inverse(Lanes a) { return Lanes(1.0f) / a; }
HWY_INLINE Lanes inverse_sqrt(Lanes a) { return inverse(square_root(a)); }
HWY_INLINE Lanes select(Mask condition, Lanes yes, Lanes no) { return hn::IfThenElse(condition.m, yes.v, no.v); }
HWY_INLINE Lanes negated_where(Mask condition, Lanes a) {
  const auto sign = hn::Set(floats, -0.0f);
#if HWY_TARGET == HWY_AVX3
  return hn::Vec<decltype(floats)>{_mm512_mask_xor_ps(a.v.raw, condition.m.raw, a.v.raw, sign.raw)};
#else
  return hn::Xor(a.v, hn::IfThenElseZero(condition.m, sign));
#endif
}
// Where one of the two is NaN, the result is either of them.
HWY_INLINE Lanes smaller(Lanes a, Lanes b) { return hn::Min(a.v, b.v); }
HWY_INLINE Lanes larger(Lanes a, Lanes b) { return hn::Max(a.v, b.v); }
HWY_INLINE Mask all_of(Mask a, Mask b, Mask c) { return {hn::And(hn::And(a.m, b.m), c.m)}; }
HWY_INLINE Mask operator&(Mask a, Mask b) { return {hn::And(a.m, b.m)}; }
HWY_INLINE bool every(Mask a) { return hn::AllTrue(floats, a.m); }
// One bit per lane, that of lane 0 lowest.
HWY_INLINE std::uint32_t bits_of(Mask a) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(floats, a.m, bytes);
  return bytes[0] | static_cast<std::uint32_t>(bytes[1]) << 8;
}
HWY_INLINE float smallest(Lanes a) { return hn::GetLane(hn::MinOfLanes(floats, a.v)); }
HWY_INLINE float largest(Lanes a) { return hn::GetLane(hn::MaxOfLanes(floats, a.v)); }

HWY_INLINE Integers operator+(Integers a, Integers b) { return {hn::Add(a.v, b.v)}; }
HWY_INLINE Integers operator-(Integers a, Integers b) { return {hn::Sub(a.v, b.v)}; }
HWY_INLINE Integers bits_of(Lanes a) { return {hn::BitCast(integers, a.v)}; }
// The bits of |a|. As integers they have the order of |a|, with NaN above all numbers.
HWY_INLINE Integers magnitude(Lanes a) { return {hn::BitCast(integers, hn::Abs(a.v))}; }
HWY_INLINE Integers larger(Integers a, Integers b) { return {hn::Max(a.v, b.v)}; }
HWY_INLINE std::int32_t largest(Integers a) { return hn::GetLane(hn::MaxOfLanes(integers, a.v)); }
// Halves go to the even integer. Undefined for values that no integer can hold: NearestInt saturates them, for five
// more instructions on x86.
HWY_INLINE Integers round_to_int(Lanes a) {
#if HWY_TARGET == HWY_AVX3
  return {hn::Vec<decltype(integers)>{_mm512_cvtps_epi32(a.v.raw)}};
#elif HWY_TARGET == HWY_AVX2
  return {hn::Vec<decltype(integers)>{_mm256_cvtps_epi32(a.v.raw)}};
#elif HWY_TARGET == HWY_SSSE3
  return {hn::Vec<decltype(integers)>{_mm_cvtps_epi32(a.v.raw)}};
#else
  return {hn::NearestInt(a.v)};
#endif
}
HWY_INLINE Lanes float_of(Integers a) { return hn::ConvertTo(floats, a.v); }
HWY_INLINE Integers integers_of(Words a) { return {hn::BitCast(integers, a.v)}; }
HWY_INLINE Integers broadcast(std::int32_t value) { return {hn::Set(integers, value)}; }
HWY_INLINE Integers zeros() { return {hn::Zero(integers)}; }

HWY_INLINE Words operator+(Words a, Words b) { return hn::Add(a.v, b.v); }
HWY_INLINE Words operator-(Words a, Words b) { return hn::Sub(a.v, b.v); }
HWY_INLINE Words operator^(Words a, Words b) { return hn::Xor(a.v, b.v); }
HWY_INLINE Mask top_bit(Words a) {
  return {hn::MaskFromVec(hn::BitCast(floats, hn::BroadcastSignBit(hn::BitCast(integers, a.v))))};
}
HWY_INLINE Words select(Mask condition, Words yes, Words no) {
  return hn::BitCast(words, hn::IfThenElse(condition.m, hn::BitCast(floats, yes.v), hn::BitCast(floats, no.v)));
}
HWY_INLINE Lanes float_of_signed(Words a) { return hn::ConvertTo(floats, hn::BitCast(integers, a.v)); }

// Loads and stores of consecutive elements. Aligned ones start at a multiple of lane_count.
HWY_INLINE Lanes load_aligned(const float* from) { return hn::Load(floats, from); }
HWY_INLINE Integers load_aligned(const std::int32_t* from) { return {hn::Load(integers, from)}; }
HWY_INLINE Words load_aligned(const std::uint32_t* from) { return hn::Load(words, from); }
// The lower half of the lanes from one vector in memory, the upper half from another.
inline constexpr hn::Half<decltype(floats)> half_of_floats;
inline constexpr hn::Half<decltype(integers)> half_of_integers;
HWY_INLINE Lanes load_halves(const float* lower, const float* upper) {
  return hn::Combine(floats, hn::Load(half_of_floats, upper + lane_count / 2), hn::Load(half_of_floats, lower));
}
HWY_INLINE void add_halves(Integers a, std::int32_t* lower, std::int32_t* upper) {
  constexpr auto half = half_of_integers;
  hn::Store(hn::Add(hn::Load(half, lower), hn::LowerHalf(half, a.v)), half, lower);
  upper += lane_count / 2;
  hn::Store(hn::Add(hn::Load(half, upper), hn::UpperHalf(half, a.v)), half, upper);
}
HWY_INLINE Lanes load(const float* from) { return hn::LoadU(floats, from); }
// One element per lane, from anywhere. `indices` are aligned.
HWY_INLINE Lanes load_each(const float* from, const std::uint32_t* indices) {
  return hn::GatherIndex(floats, from, hn::BitCast(integers, hn::Load(words, indices)));
}
HWY_INLINE Integers load(const std::int32_t* from) { return {hn::LoadU(integers, from)}; }
HWY_INLINE void store_aligned(Lanes a, float* to) { hn::Store(a.v, floats, to); }
HWY_INLINE void store_aligned(Integers a, std::int32_t* to) { hn::Store(a.v, integers, to); }
HWY_INLINE void store_aligned(Words a, std::uint32_t* to) { hn::Store(a.v, words, to); }
HWY_INLINE void store(Integers a, std::int32_t* to) { hn::StoreU(a.v, integers, to); }
// One 64-bit integer per lane.
struct Phases {
  hn::Vec<decltype(long_words)> lower, upper;  // halves of the lanes
};
HWY_INLINE Phases operator+(Phases a, Phases b) { return {hn::Add(a.lower, b.lower), hn::Add(a.upper, b.upper)}; }
HWY_INLINE Phases load_aligned(const std::uint64_t* from) {
  return {hn::Load(long_words, from), hn::Load(long_words, from + lane_count / 2)};
}
HWY_INLINE void store_aligned(Phases a, std::uint64_t* to) {
  hn::Store(a.lower, long_words, to);
  hn::Store(a.upper, long_words, to + lane_count / 2);
}
HWY_INLINE Words upper_words(Phases a) {
  return hn::ConcatOdd(words, hn::BitCast(words, a.upper), hn::BitCast(words, a.lower));
}

// As Vec3 is three floats.
struct Lanes3 {
  Lanes x, y, z;
};
HWY_INLINE Lanes3 operator+(Lanes3 a, Lanes3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
HWY_INLINE Lanes3 operator-(Lanes3 a, Lanes3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
HWY_INLINE Lanes3 operator-(Vec3 a, Lanes3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
HWY_INLINE Lanes3 operator*(Lanes s, Lanes3 a) { return {s * a.x, s * a.y, s * a.z}; }
HWY_INLINE Lanes3 multiply_add(Lanes a, Lanes3 b, Lanes3 c) {
  return {multiply_add(a, b.x, c.x), multiply_add(a, b.y, c.y), multiply_add(a, b.z, c.z)};
}
HWY_INLINE Lanes3 cross(Lanes3 a, Lanes3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
HWY_INLINE Lanes3 select(Mask condition, Lanes3 yes, Lanes3 no) {
  return {select(condition, yes.x, no.x), select(condition, yes.y, no.y), select(condition, yes.z, no.z)};
}

struct Integers3 {
  Integers x, y, z;
};
HWY_INLINE Integers3 operator+(Integers3 a, Integers3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
HWY_INLINE Integers3 operator-(Integers3 a, Integers3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
HWY_INLINE Integers3 round_to_int(Lanes3 a) { return {round_to_int(a.x), round_to_int(a.y), round_to_int(a.z)}; }
HWY_INLINE Lanes3 float_of(Integers3 a) { return {float_of(a.x), float_of(a.y), float_of(a.z)}; }

}  // namespace mercury::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
