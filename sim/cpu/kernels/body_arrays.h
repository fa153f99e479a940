// SPDX-License-Identifier: Apache-2.0
// A body's arrays as vector code addresses them.
//
// Loops keep a copy of these pointers. For all the compiler knows, a vector store may change anything, including the
// body's own pointers, and it would read those again after each store.
#pragma once

#include "sim/cpu/kernels/gather.h"
#include "sim/cpu/kernels/lanes.h"
#include "sim/cpu/layout/body.h"

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

HWY_INLINE Lanes3 load_aligned(Pointers3<float> from, std::size_t slot) {
  return {load_aligned(from.x + slot), load_aligned(from.y + slot), load_aligned(from.z + slot)};
}
HWY_INLINE Integers3 load_aligned(Pointers3<std::int32_t> from, std::size_t slot) {
  return {load_aligned(from.x + slot), load_aligned(from.y + slot), load_aligned(from.z + slot)};
}
HWY_INLINE Lanes3 load(Pointers3<float> from, std::size_t slot) {
  return {load(from.x + slot), load(from.y + slot), load(from.z + slot)};
}
template <class Value, class T>
HWY_INLINE void store_aligned(Value a, Pointers3<T> to, std::size_t slot) {
  store_aligned(a.x, to.x + slot);
  store_aligned(a.y, to.y + slot);
  store_aligned(a.z, to.z + slot);
}
HWY_INLINE void add(Integers3 a, Pointers3<std::int32_t> to, std::size_t slot) {
  store(load(to.x + slot) + a.x, to.x + slot);
  store(load(to.y + slot) + a.y, to.y + slot);
  store(load(to.z + slot) + a.z, to.z + slot);
}

struct BodyArrays {
  Pointers3<float> x, v;
  float *x_aos, *v_aos;
  Pointers3<std::int32_t> own, reaction, taken;
  std::int32_t* scattered;
  const std::uint32_t* bias;
  const float *inverse_inertia, *weight;
  std::size_t slots;            // without the spare tile
  std::size_t reaction_stride;  // from one reaction array to the next

  explicit BodyArrays(Body& body)
      : x(pointers(body.x)), v(pointers(body.v)), x_aos(body.x_aos.data()), v_aos(body.v_aos.data()),
        own(pointers(body.sums.own)), reaction(pointers(body.sums.reaction)), taken(pointers(body.sums.taken)),
        scattered(body.sums.scattered.data()), bias(body.springs.bias.data()),
        inverse_inertia(body.inverse_inertia.data()), weight(body.weight.data()), slots(body.slots.mass_at.size()),
        reaction_stride(body.slots.size_with_spare()) {}

  HWY_INLINE void store_x_aos(Lanes3 value, std::size_t slot) const {
    store_aos({value.x, value.y, value.z, value.z}, x_aos + 4 * slot);
  }
  HWY_INLINE void store_v_aos(Lanes3 value, std::size_t slot) const {
    store_aos({value.x, value.y, value.z, value.z}, v_aos + 4 * slot);
  }

  // What was added to the sums of the tile at this slot since the last call (see layout/body.h). `springs`: including
  // the springs' contributions; `with_scattered`: including Sums::scattered.
  template <bool springs, bool with_scattered>
  HWY_INLINE Integers3 take(std::size_t slot) const {
    Integers3 now = load_aligned(reaction, slot);
    for (std::size_t i = 1; i < reaction_arrays; ++i) now = now + load_aligned(reaction, slot + i * reaction_stride);
    if constexpr (with_scattered) now = now + load_scattered(scattered + 4 * slot);
    const Integers3 added = now - load_aligned(taken, slot);
    store_aligned(now, taken, slot);
    if constexpr (!springs) return added;
    const Integers magic = integers_of(load_aligned(bias + slot));
    return added + load_aligned(own, slot) + Integers3{magic, magic, magic};
  }
};

}  // namespace mercury::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
