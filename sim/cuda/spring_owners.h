// SPDX-License-Identifier: Apache-2.0
// Which of its two masses owns each spring. The owner's lane computes the spring.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mercury/robot.h"
#include "sim/cuda/tile.h"

namespace mercury::cuda {

struct OwnedSpring {
  std::uint16_t owner, partner;  // slots
  std::uint32_t spring;          // its number
};

// Springs sorted by their owner's tile: those of tile t at [start[t], start[t + 1]).
struct OwnedSprings {
  std::vector<std::uint32_t> start;
  std::vector<OwnedSpring> springs;

  std::span<const OwnedSpring> of_tile(std::size_t tile) const {
    return std::span(springs).subspan(start[tile], start[tile + 1] - start[tile]);
  }
};

// A tile needs as many rows as its busiest lane or bank has springs (edge_colouring.h), so owners are chosen to keep
// these loads even. The ends of `springs` are slots.
OwnedSprings choose_owners(std::size_t masses, std::span<const Spring> springs);

}  // namespace mercury::cuda
