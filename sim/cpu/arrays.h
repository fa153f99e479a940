// SPDX-License-Identifier: Apache-2.0
// A body's arrays as vector code addresses them. Loops keep a copy of this: a store of a vector may change anything as
// far as the compiler knows, so that it would read the body's own pointers again after each.
#pragma once

#include "sim/cpu/body.h"
#include "sim/cpu/lanes.h"
#include "sim/cpu/rows.h"

HWY_BEFORE_NAMESPACE();
namespace mercury::cpu::HWY_NAMESPACE {

template <class T>
struct Pointers3 {
  T *x, *y, *z;
};
template <class T>
HWY_INLINE Pointers3<T> pointers(Triples<T>& triples) {
  return {triples.x.data(), triples.y.data(), triples.z.data()};
}

HWY_INLINE Lanes3 load_aligned(Pointers3<float> from, std::size_t place) {
  return {load_aligned(from.x + place), load_aligned(from.y + place), load_aligned(from.z + place)};
}
HWY_INLINE Integers3 load_aligned(Pointers3<std::int32_t> from, std::size_t place) {
  return {load_aligned(from.x + place), load_aligned(from.y + place), load_aligned(from.z + place)};
}
HWY_INLINE Lanes3 load(Pointers3<float> from, std::size_t place) {
  return {load(from.x + place), load(from.y + place), load(from.z + place)};
}
template <class Value, class T>
HWY_INLINE void store_aligned(Value a, Pointers3<T> to, std::size_t place) {
  store_aligned(a.x, to.x + place);
  store_aligned(a.y, to.y + place);
  store_aligned(a.z, to.z + place);
}
HWY_INLINE void add(Integers3 a, Pointers3<std::int32_t> to, std::size_t place) {
  store(load(to.x + place) + a.x, to.x + place);
  store(load(to.y + place) + a.y, to.y + place);
  store(load(to.z + place) + a.z, to.z + place);
}

struct Arrays {
  Pointers3<float> x, v;
  float *x_rows, *v_rows;
  Pointers3<std::int32_t> own, reaction, taken;
  std::int32_t* row_sums;
  const std::uint32_t* bias;
  std::size_t places, stride;  // the latter of reaction arrays

  explicit Arrays(Body& body)
      : x(pointers(body.x)), v(pointers(body.v)), x_rows(body.x_rows.data()), v_rows(body.v_rows.data()),
        own(pointers(body.sums.own)), reaction(pointers(body.sums.reaction)), taken(pointers(body.sums.taken)),
        row_sums(body.sums.rows.data()), bias(body.springs.bias.data()), places(body.places.mass_at.size()),
        stride(body.places.padded()) {}

  HWY_INLINE void store_x_rows(Lanes3 value, std::size_t place) const {
    store_rows({value.x, value.y, value.z, value.z}, x_rows + 4 * place);
  }
  HWY_INLINE void store_v_rows(Lanes3 value, std::size_t place) const {
    store_rows({value.x, value.y, value.z, value.z}, v_rows + 4 * place);
  }

  // What was added to a block's sums since this was last called; springs' contributions, too, or none.
  template <bool springs, bool rows>
  HWY_INLINE Integers3 take(std::size_t place) const {
    Integers3 now = load_aligned(reaction, place);
    for (std::size_t i = 1; i < reaction_arrays; ++i) now = now + load_aligned(reaction, place + i * stride);
    if constexpr (rows) now = now + sum_rows(row_sums + 4 * place);
    const Integers3 since = now - load_aligned(taken, place);
    store_aligned(now, taken, place);
    if constexpr (!springs) return since;
    const Integers magic = integers_of(load_aligned(bias + place));
    return since + load_aligned(own, place) + Integers3{magic, magic, magic};
  }
};

}  // namespace mercury::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
