// SPDX-License-Identifier: Apache-2.0
// The search for near pairs by comparing all pairs, a tile at a time (layout/near_pairs.h). For robots of few masses
// this is faster than a grid.
#pragma once

#include <bit>

#include "sim/cpu/kernels/body_arrays.h"

HWY_BEFORE_NAMESPACE();
namespace mercury::cpu::HWY_NAMESPACE {

// Searches from the positions in body.x.
inline void search_near_pairs(Body& body) {
  NearPairs& list = body.near_pairs;
  const float distance = body.contact_distance;
  if (!list.few()) return list.search_grid(body.x.x, body.x.y, body.x.z, distance);
  list.start(body.x.x, body.x.y, body.x.z);
  const BodyArrays arrays(body);
  const float radius = list_radius * distance;
  const Lanes squared_radius = radius * radius;
  constexpr std::size_t bytes = NearPairs::bytes_per_tile(lane_count);
  const std::size_t tiles = arrays.slots / lane_count;
  const std::uint8_t* const candidates = list.candidates().data();
  for (std::uint32_t i = 0; i < arrays.slots; ++i) {
    const Lanes3 own{arrays.x.x[i], arrays.x.y[i], arrays.x.z[i]};
    for (std::size_t tile = i / lane_count; tile < tiles; ++tile) {
      const std::size_t first = tile * lane_count;
      const Mask candidate{hn::LoadMaskBits(floats, candidates + (i * tiles + tile) * bytes)};
      const Mask near = (squared_length(load_aligned(arrays.x, first) - own) < squared_radius) & candidate;
      if (HWY_LIKELY(hn::AllFalse(floats, near.m))) continue;
      for (std::uint32_t lanes = bits_of(near); lanes != 0; lanes &= lanes - 1)
        list.add({i, static_cast<std::uint32_t>(first) + static_cast<std::uint32_t>(std::countr_zero(lanes))});
    }
  }
}

}  // namespace mercury::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
