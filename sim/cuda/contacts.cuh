// SPDX-License-Identifier: Apache-2.0
// Which masses of a robot are near each other without a spring between them.
//
// The cell grid is filled anew only when some mass may have moved so far that the list of near pairs could miss one;
// between, a step costs a look at the list, which is short or empty unless the robot folds up. Both ways find exactly
// the pairs that touch, and their forces are summed as integers, so when the list was made changes no bit.
#pragma once

#include "sim/cuda/block.cuh"
#include "sim/cuda/mass_memory.cuh"
#include "sim/physics/contact.h"

namespace mercury::cuda {

// Pairs within this many contact distances are listed.
inline constexpr float list_radius = 1.5f;
// Half the margin, less a percent for rounding: how far a mass may go before the list is made anew.
inline constexpr float list_reach = 0.99f * (list_radius - 1) / 2;

struct ContactMemory {
  std::uint32_t* count;  // pairs found, of which contact_list_size fit
  std::uint32_t* pairs;  // i << 16 | j
  std::uint32_t* heads;  // of the buckets
  std::uint16_t* links;  // from a mass to the next of its bucket

  __device__ ContactMemory(char* memory, std::uint32_t buckets)
      : count(reinterpret_cast<std::uint32_t*>(memory)), pairs(count + 1), heads(pairs + contact_list_size),
        links(reinterpret_cast<std::uint16_t*>(heads + buckets)) {}
  __device__ bool overflows() const { return *static_cast<volatile std::uint32_t*>(count) > contact_list_size; }
};

// Calls visit(j) for every mass j within list_radius that comes after mass i, so that each pair is met once.
template <class Position, class Visit>
__device__ void for_each_near(const ContactMemory& memory, std::uint32_t buckets, float distance, std::uint32_t i,
                              Vec3 x, const Position& position, const Visit& visit) {
  const float radius = list_radius * distance, inverse_size = 1 / radius;
  const Cell cell = cell_of(x, inverse_size);
  for (int n = 0; n < half_neighbourhood; ++n) {
    const Cell other = neighbour_cell(cell, n);
    for (std::uint32_t j = memory.heads[bucket_of(other, buckets - 1)]; j != end_of_list; j = memory.links[j]) {
      if (n == 0 && j <= i) continue;
      const Vec3 xj = position(j);
      if (squared_length(xj - x) < radius * radius && cell_of(xj, inverse_size) == other) visit(j);
    }
  }
}

}  // namespace mercury::cuda
