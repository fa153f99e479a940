// SPDX-License-Identifier: Apache-2.0
// Gathers and scatters masses that stand in any slots.
//
// An array of structures (aos) has four numbers per slot: x, y, z and one that is not used. A mass is then one access
// of 16 bytes, and vectors of x, y and z come from transposing 4 by 4 numbers in registers:
//
//   slots 7, 2, 9, 4:   x7 y7 z7 -       x7 x2 x9 x4
//                       x2 y2 z2 -   ->  y7 y2 y9 y4
//                       x9 y9 z9 -       z7 z2 z9 z4
//                       x4 y4 z4 -       -  -  -  -
//
// Wider vectors do the same in each group of four lanes.
#pragma once

#include "sim/cpu/kernels/lanes.h"

HWY_BEFORE_NAMESPACE();
namespace mercury::cpu::HWY_NAMESPACE {

inline constexpr hn::FixedTag<float, 4> four_floats;
inline constexpr hn::FixedTag<std::int32_t, 4> four_integers;
static_assert(lane_count % 4 == 0, "a vector holds the numbers of whole slots");

struct Lanes4 {
  Lanes x, y, z, w;
};

// four(i), four(i + 4) and so on, in this order in one vector.
template <class D, class Four>
HWY_INLINE hn::Vec<D> concatenated(D d, const Four& four, std::size_t i) {
  if constexpr (hn::MaxLanes(D()) == 4) {
    return four(i);
  } else {
    constexpr hn::Half<D> half;
    return hn::Combine(d, concatenated(half, four, i + hn::MaxLanes(half)), concatenated(half, four, i));
  }
}
// The reverse: calls visit(i, four numbers), visit(i + 4, the next four) and so on.
template <class D, class Visit>
HWY_INLINE void for_each_four(D, hn::Vec<D> v, const Visit& visit, std::size_t i) {
  if constexpr (hn::MaxLanes(D()) == 4) {
    visit(i, v);
  } else {
    constexpr hn::Half<D> half;
    for_each_four(half, hn::LowerHalf(half, v), visit, i);
    for_each_four(half, hn::UpperHalf(half, v), visit, i + hn::MaxLanes(half));
  }
}

// Exchange pairs of numbers within each group of four lanes.
inline constexpr hn::RepartitionToWide<decltype(floats)> pairs;
HWY_INLINE Lanes lower_pairs(Lanes a, Lanes b) {
  return hn::BitCast(floats, hn::InterleaveLower(pairs, hn::BitCast(pairs, a.v), hn::BitCast(pairs, b.v)));
}
HWY_INLINE Lanes upper_pairs(Lanes a, Lanes b) {
  return hn::BitCast(floats, hn::InterleaveUpper(pairs, hn::BitCast(pairs, a.v), hn::BitCast(pairs, b.v)));
}

// Transposes the 4 by 4 numbers in each group of four lanes.
HWY_INLINE Lanes4 transposed(Lanes4 r) {
  const Lanes a = hn::InterleaveLower(floats, r.x.v, r.y.v), b = hn::InterleaveUpper(floats, r.x.v, r.y.v);
  const Lanes c = hn::InterleaveLower(floats, r.z.v, r.w.v), d = hn::InterleaveUpper(floats, r.z.v, r.w.v);
  return {lower_pairs(a, c), upper_pairs(a, c), lower_pairs(b, d), upper_pairs(b, d)};
}

// A tile of gathered masses, not transposed yet. Where several of these go into one sum, adding comes first: it costs
// less than transposing each.
struct Aos {
  Lanes r0, r1, r2, r3;
};
HWY_INLINE Aos operator+(Aos a, Aos b) { return {a.r0 + b.r0, a.r1 + b.r1, a.r2 + b.r2, a.r3 + b.r3}; }
HWY_INLINE Aos operator-(Aos a, Aos b) { return {a.r0 - b.r0, a.r1 - b.r1, a.r2 - b.r2, a.r3 - b.r3}; }

// `offsets`: four times the slot, by lane.
HWY_INLINE Aos gather(const float* aos, const std::uint32_t* offsets) {
  const auto four = [&](std::size_t i) HWY_ATTR { return hn::Load(four_floats, aos + offsets[i]); };
  return {concatenated(floats, four, 0), concatenated(floats, four, 1), concatenated(floats, four, 2),
          concatenated(floats, four, 3)};
}
// The same value in every lane.
HWY_INLINE Aos broadcast_aos(Vec3 value) {
  alignas(64) float values[lane_count];
  for (std::size_t i = 0; i < lane_count; ++i)
    values[i] = i % 4 == 0 ? value.x : i % 4 == 1 ? value.y : i % 4 == 2 ? value.z : 0;
  const Lanes all = load_aligned(values);
  return {all, all, all, all};
}
HWY_INLINE Lanes3 components(Aos a) {
  const Lanes4 t = transposed(Lanes4{a.r0, a.r1, a.r2, a.r3});
  return {t.x, t.y, t.z};
}

// Stores a tile whose slots start at `to`.
HWY_INLINE void store_aos(Lanes4 a, float* to) {
  const Lanes4 r = transposed(a);
  const auto store_four = [&](std::size_t i, auto four) HWY_ATTR { hn::Store(four, four_floats, to + 4 * i); };
  for_each_four(floats, r.x.v, store_four, 0);
  for_each_four(floats, r.y.v, store_four, 1);
  for_each_four(floats, r.z.v, store_four, 2);
  for_each_four(floats, r.w.v, store_four, 3);
}

// Adds to sums in any slots. `offsets` as in gather(); they may repeat.
HWY_INLINE void scatter_add(Integers3 a, std::int32_t* aos, const std::uint32_t* offsets) {
  const auto as_floats = [](Integers v) HWY_ATTR { return Lanes(hn::BitCast(floats, v.v)); };
  const Lanes4 r = transposed(Lanes4{as_floats(a.x), as_floats(a.y), as_floats(a.z), as_floats(a.z)});
  const auto add_four = [&](std::size_t i, auto four) HWY_ATTR {
    std::int32_t* const to = aos + offsets[i];
    hn::Store(hn::Add(hn::Load(four_integers, to), four), four_integers, to);
  };
  for_each_four(integers, bits_of(r.x).v, add_four, 0);
  for_each_four(integers, bits_of(r.y).v, add_four, 1);
  for_each_four(integers, bits_of(r.z).v, add_four, 2);
  for_each_four(integers, bits_of(r.w).v, add_four, 3);
}

// Loads a tile of sums whose slots start at `from`.
HWY_INLINE Integers3 load_scattered(const std::int32_t* from) {
  const auto four = [&](std::size_t i)
                        HWY_ATTR { return hn::BitCast(four_floats, hn::Load(four_integers, from + 4 * i)); };
  const Lanes3 a = components({concatenated(floats, four, 0), concatenated(floats, four, 1),
                               concatenated(floats, four, 2), concatenated(floats, four, 3)});
  return {bits_of(a.x), bits_of(a.y), bits_of(a.z)};
}

}  // namespace mercury::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
