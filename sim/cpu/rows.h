// SPDX-License-Identifier: Apache-2.0
// Collecting masses one by one: each has a row of four numbers, so that a mass is one load or store of 16 bytes, and
// four masses are turned into vectors of x, y, z by exchanging elements in registers.
#pragma once

#include "sim/cpu/lanes.h"

HWY_BEFORE_NAMESPACE();
namespace mercury::cpu::HWY_NAMESPACE {

inline constexpr hn::FixedTag<float, 4> float_row;
inline constexpr hn::FixedTag<std::int32_t, 4> integer_row;
static_assert(lane_count % 4 == 0, "a vector holds a number of rows");

struct Lanes4 {
  Lanes x, y, z, w;
};

// row(i), row(i + 4) and so on, side by side in one vector.
template <class D, class Row>
HWY_INLINE hn::Vec<D> side_by_side(D d, const Row& row, std::size_t i) {
  if constexpr (hn::MaxLanes(D()) == 4) {
    return row(i);
  } else {
    constexpr hn::Half<D> half;
    return hn::Combine(d, side_by_side(half, row, i + hn::MaxLanes(half)), side_by_side(half, row, i));
  }
}
// The reverse: visit(i, row) for each.
template <class D, class Visit>
HWY_INLINE void part(D, hn::Vec<D> v, const Visit& visit, std::size_t i) {
  if constexpr (hn::MaxLanes(D()) == 4) {
    visit(i, v);
  } else {
    constexpr hn::Half<D> half;
    part(half, hn::LowerHalf(half, v), visit, i);
    part(half, hn::UpperHalf(half, v), visit, i + hn::MaxLanes(half));
  }
}

// Two by two elements exchanged within each group of four.
inline constexpr hn::RepartitionToWide<decltype(floats)> pairs;
HWY_INLINE Lanes lower_pairs(Lanes a, Lanes b) {
  return hn::BitCast(floats, hn::InterleaveLower(pairs, hn::BitCast(pairs, a.v), hn::BitCast(pairs, b.v)));
}
HWY_INLINE Lanes upper_pairs(Lanes a, Lanes b) {
  return hn::BitCast(floats, hn::InterleaveUpper(pairs, hn::BitCast(pairs, a.v), hn::BitCast(pairs, b.v)));
}

// Turns groups of four by four elements: rows to columns, or columns to rows.
HWY_INLINE Lanes4 turned(Lanes4 r) {
#if HWY_TARGET == HWY_EMU128
  // Element by element is quicker than exchanges that are emulated one by one.
  Lanes4 t;
  for (std::size_t i = 0; i < 4; ++i) {
    Lanes& column = i == 0 ? t.x : i == 1 ? t.y : i == 2 ? t.z : t.w;
    column.v.raw[0] = r.x.v.raw[i];
    column.v.raw[1] = r.y.v.raw[i];
    column.v.raw[2] = r.z.v.raw[i];
    column.v.raw[3] = r.w.v.raw[i];
  }
  return t;
#else
  const Lanes a = hn::InterleaveLower(floats, r.x.v, r.y.v), b = hn::InterleaveUpper(floats, r.x.v, r.y.v);
  const Lanes c = hn::InterleaveLower(floats, r.z.v, r.w.v), d = hn::InterleaveUpper(floats, r.z.v, r.w.v);
  return {lower_pairs(a, c), upper_pairs(a, c), lower_pairs(b, d), upper_pairs(b, d)};
#endif
}

// The rows of as many masses as there are lanes, still as rows; sums of rows cost less than sums of turned rows where
// several rows go into one sum.
struct Rows {
  Lanes r0, r1, r2, r3;
};
HWY_INLINE Rows operator+(Rows a, Rows b) { return {a.r0 + b.r0, a.r1 + b.r1, a.r2 + b.r2, a.r3 + b.r3}; }
HWY_INLINE Rows operator-(Rows a, Rows b) { return {a.r0 - b.r0, a.r1 - b.r1, a.r2 - b.r2, a.r3 - b.r3}; }

// Of the masses whose rows start at `offsets`.
HWY_INLINE Rows collect(const float* rows, const std::uint32_t* offsets) {
  const auto row = [&](std::size_t i) HWY_ATTR { return hn::Load(float_row, rows + offsets[i]); };
  return {side_by_side(floats, row, 0), side_by_side(floats, row, 1), side_by_side(floats, row, 2),
          side_by_side(floats, row, 3)};
}
// One row over and over.
HWY_INLINE Rows row_in_every(Vec3 row) {
  alignas(64) float values[lane_count];
  for (std::size_t i = 0; i < lane_count; ++i)
    values[i] = i % 4 == 0 ? row.x : i % 4 == 1 ? row.y : i % 4 == 2 ? row.z : 0;
  const Lanes all = load_aligned(values);
  return {all, all, all, all};
}
HWY_INLINE Lanes4 turned(Rows a) { return turned(Lanes4{a.r0, a.r1, a.r2, a.r3}); }
// Without the fourth numbers.
HWY_INLINE Lanes3 vectors(Rows a) {
  const Lanes4 t = turned(a);
  return {t.x, t.y, t.z};
}

// Writes the rows of consecutive masses.
HWY_INLINE void store_rows(Lanes4 a, float* to) {
  const Lanes4 r = turned(a);
  const auto store_row = [&](std::size_t i, auto row) HWY_ATTR { hn::Store(row, float_row, to + 4 * i); };
  part(floats, r.x.v, store_row, 0);
  part(floats, r.y.v, store_row, 1);
  part(floats, r.z.v, store_row, 2);
  part(floats, r.w.v, store_row, 3);
}

// Adds to the rows that start at `offsets`, which may repeat.
HWY_INLINE void add_to_rows(Integers3 a, std::int32_t* rows, const std::uint32_t* offsets) {
  const auto as_floats = [](Integers v) HWY_ATTR { return Lanes(hn::BitCast(floats, v.v)); };
  const Lanes4 r = turned(Lanes4{as_floats(a.x), as_floats(a.y), as_floats(a.z), as_floats(a.z)});
  const auto add_to_row = [&](std::size_t i, auto row) HWY_ATTR {
    std::int32_t* const at = rows + offsets[i];
    hn::Store(hn::Add(hn::Load(integer_row, at), row), integer_row, at);
  };
  part(integers, bits_of(r.x).v, add_to_row, 0);
  part(integers, bits_of(r.y).v, add_to_row, 1);
  part(integers, bits_of(r.z).v, add_to_row, 2);
  part(integers, bits_of(r.w).v, add_to_row, 3);
}

// The rows of consecutive masses.
HWY_INLINE Integers3 sum_rows(const std::int32_t* rows) {
  const auto row = [&](std::size_t i) HWY_ATTR { return hn::BitCast(float_row, hn::Load(integer_row, rows + 4 * i)); };
  const Lanes3 a = vectors({side_by_side(floats, row, 0), side_by_side(floats, row, 1), side_by_side(floats, row, 2),
                            side_by_side(floats, row, 3)});
  return {bits_of(a.x), bits_of(a.y), bits_of(a.z)};
}

}  // namespace mercury::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
