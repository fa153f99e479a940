// SPDX-License-Identifier: Apache-2.0
// Which slot each mass of a robot stands in.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/cuda/tile.h"

namespace mercury::cuda {

// A permutation: `masses` masses stand in the slots 0 .. masses - 1.
struct SlotOrder {
  std::vector<std::uint16_t> slots;  // [mass]

  std::uint32_t slot_of(std::uint32_t mass) const { return slots[mass]; }
  std::vector<std::uint16_t> masses() const {  // [slot]
    std::vector<std::uint16_t> inverse(slots.size());
    for (std::size_t mass = 0; mass < slots.size(); ++mass) inverse[slots[mass]] = static_cast<std::uint16_t>(mass);
    return inverse;
  }
};

// An order in which masses fill the tiles in their order; within tile t they are rotated by t * shift
// lanes:
//
//   shift 5     tile 0:   0  1  2 ... 31     tile 1:  59 60 61 62 63 32 33 ... 58     tile 2:  86 87 ...
//
// Generators number the masses of a lattice row by row. Without the rotation, neighbours in other rows would often
// share a bank, and all corners of one kind would stand in even banks.
struct TileRotation {
  std::uint32_t masses, shift;

  std::uint32_t slot_of(std::uint32_t mass) const {
    const std::uint32_t tile = mass / lanes;
    return tile * lanes + (mass % lanes + tile * shift) % masses_in(tile);
  }
  // Calls visit(mass, slot, count) for runs of masses in consecutive slots: one or two per tile, since it is rotated.
  template <class Visit>
  void for_each_run(Visit visit) const {
    for (std::uint32_t first = 0; first < masses; first += lanes) {
      const std::uint32_t size = masses_in(first / lanes), rotation = slot_of(first) - first;
      visit(first, first + rotation, size - rotation);
      if (rotation > 0) visit(first + size - rotation, first, rotation);
    }
  }

  SlotOrder order() const {
    SlotOrder order;
    for (std::uint32_t mass = 0; mass < masses; ++mass)
      order.slots.push_back(static_cast<std::uint16_t>(slot_of(mass)));
    return order;
  }

 private:
  std::uint32_t masses_in(std::uint32_t tile) const {
    const std::uint32_t rest = masses - tile * lanes;
    return rest < lanes ? rest : lanes;
  }
};

}  // namespace mercury::cuda
