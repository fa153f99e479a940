// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/schedule.h"

#include <bit>
#include <utility>

namespace mercury::cuda {
namespace {

// Calls visit(index) for each bit that is set.
template <class Visit>
void for_each_bit(std::uint32_t bits, Visit visit) {
  for (; bits != 0; bits &= bits - 1) visit(static_cast<std::uint32_t>(std::countr_zero(bits)));
}

// Finds partners for the padding of a row, in the banks that the row leaves free. There are as many of these banks as
// there are padding entries. The owner itself comes first, then its neighbors, then masses near it in the file.
class PaddingPartners {
 public:
  PaddingPartners(const OwnedSprings& owned, std::size_t masses, std::uint32_t tile)
      : owned_(owned), first_(tile * lanes),
        lanes_with_mass_(masses - first_ >= lanes ? ~0u : (1u << masses % lanes) - 1) {}

  void fill(ScheduledSpring* row) {
    std::uint32_t unused_lanes = 0, used_banks = 0;
    for (std::uint32_t lane = 0; lane < lanes; ++lane) {
      const bool unused = row[lane].spring == padding;
      unused_lanes |= std::uint32_t{unused} << lane;
      used_banks |= std::uint32_t{!unused} << row[lane].partner % lanes;
    }
    free_banks_ = ~used_banks;
    const std::uint32_t own = unused_lanes & free_banks_ & lanes_with_mass_;
    free_banks_ &= ~own;
    for_each_bit(own, [&](std::uint32_t lane) { row[lane].partner = static_cast<std::uint16_t>(first_ + lane); });
    std::uint32_t left = 0;
    for_each_bit(unused_lanes & ~own & lanes_with_mass_, [&](std::uint32_t lane) {
      row[lane].partner = neighbor_of(lane);
      if (row[lane].partner == first_ + lane) left |= 1u << lane;
    });
    for_each_bit(left, [&](std::uint32_t lane) { row[lane].partner = any(lane); });
    for_each_bit(unused_lanes & ~lanes_with_mass_, [&](std::uint32_t lane) {
      row[lane].partner = take_slot(first_, free_banks_ & ~lanes_with_mass_, lane);
    });
  }

 private:
  // Returns the owner itself if no neighbor has a free bank.
  std::uint16_t neighbor_of(std::uint32_t lane) {
    const std::uint32_t owner = first_ + lane;
    for (const std::uint32_t i : owned_.springs_at(owner)) {
      const OwnedSpring s = owned_.springs[i];
      const std::uint32_t neighbor = s.owner ^ s.partner ^ owner;  // the end that is not the owner
      if (free_banks_ >> neighbor % lanes & 1)
        return take_slot(neighbor - neighbor % lanes, 1u << neighbor % lanes, lane);
    }
    return static_cast<std::uint16_t>(owner);
  }

  // Any mass of the lane's tile or the previous one.
  std::uint16_t any(std::uint32_t lane) {
    if (const std::uint32_t banks = free_banks_ & lanes_with_mass_; banks != 0 || first_ == 0)
      return take_slot(first_, banks, lane);
    return take_slot(first_ - lanes, free_banks_, lane);
  }

  // The slot of the tile that begins at `first` in the first of these free banks; the lane's own slot if there are
  // none.
  std::uint16_t take_slot(std::uint32_t first, std::uint32_t banks, std::uint32_t lane) {
    if (banks == 0) return static_cast<std::uint16_t>(first_ + lane);
    free_banks_ &= ~(banks & -banks);
    return static_cast<std::uint16_t>(first + static_cast<std::uint32_t>(std::countr_zero(banks)));
  }

  const OwnedSprings& owned_;
  std::uint32_t first_;  // slot of the tile
  std::uint32_t lanes_with_mass_;
  std::uint32_t free_banks_ = 0;
};

}  // namespace

Schedule schedule_springs(std::size_t masses, std::vector<OwnedSpring> springs) {
  const OwnedSprings owned = choose_owners(masses, std::move(springs));
  Schedule schedule;
  schedule.row_start.push_back(0);
  for (const std::uint32_t rows : owned.rows) schedule.row_start.push_back(schedule.row_start.back() + rows);
  schedule.entries = color_springs(owned.springs, schedule.row_start);
  for (std::uint32_t tile = 0; tile < schedule.tiles(); ++tile) {
    PaddingPartners partners(owned, masses, tile);
    for (std::uint32_t row = schedule.row_start[tile]; row < schedule.row_start[tile + 1]; ++row)
      partners.fill(&schedule.entries[std::size_t{row} * lanes]);
  }
  const std::uint32_t slots = schedule.tiles() * lanes;
  schedule.valences.resize(slots);
  for (std::uint32_t slot = 0; slot < slots; ++slot)
    schedule.valences[slot] = static_cast<std::uint32_t>(owned.springs_at(slot).size());
  schedule.incoming_counts.resize(slots);
  for (const ScheduledSpring& entry : schedule.entries) ++schedule.incoming_counts[entry.partner];
  return schedule;
}

}  // namespace mercury::cuda
