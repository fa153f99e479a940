// SPDX-License-Identifier: Apache-2.0
// Near pairs of masses, found by looking at all pairs: for robots of few masses quicker than sorting them into a grid.
#pragma once

#include <bit>

#include "sim/cpu/arrays.h"

HWY_BEFORE_NAMESPACE();
namespace mercury::cpu::HWY_NAMESPACE {

// Lists the near pairs of a body whose masses are at body.x.
inline void list_near_pairs(Body& body) {
  NearPairs& list = body.near_pairs;
  const float distance = body.measures.contact_distance();
  if (!list.few()) return list.list(body.x.x, body.x.y, body.x.z, distance);
  list.start(body.x.x, body.x.y, body.x.z);
  const Arrays arrays(body);
  const float radius = list_radius * distance;
  const Lanes squared_radius = radius * radius;
  constexpr std::size_t bytes = NearPairs::bytes_of(lane_count);
  const std::size_t blocks = arrays.places / lane_count;
  const std::uint8_t* const candidates = list.candidates().data();
  for (std::uint32_t i = 0; i < arrays.places; ++i) {
    const Lanes3 own{arrays.x.x[i], arrays.x.y[i], arrays.x.z[i]};
    for (std::size_t block = i / lane_count; block < blocks; ++block) {
      const Mask candidate{hn::LoadMaskBits(floats, candidates + (i * blocks + block) * bytes)};
      const Mask near = (squared_length(load_aligned(arrays.x, block * lane_count) - own) < squared_radius) & candidate;
      if (HWY_LIKELY(hn::AllFalse(floats, near.m))) continue;
      for (std::uint32_t lanes = bits_of(near); lanes != 0; lanes &= lanes - 1)
        list.add(
            {i, static_cast<std::uint32_t>(block * lane_count) + static_cast<std::uint32_t>(std::countr_zero(lanes))});
    }
  }
}

}  // namespace mercury::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
