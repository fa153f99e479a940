// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/schedule.h"

#include <array>

#include "sim/cuda/edge_colouring.h"
#include "sim/cuda/spring_owners.h"

namespace mercury::cuda {
namespace {

// The slots that springs join to each slot: those of slot i at [start[i], start[i + 1]).
struct Neighbours {
  std::vector<std::uint32_t> start;
  std::vector<std::uint16_t> slot;
};

Neighbours find_neighbours(std::size_t masses, std::span<const Spring> springs) {
  Neighbours neighbours;
  neighbours.start.assign(masses + 1, 0);
  for (const Spring& spring : springs) {
    ++neighbours.start[spring.a + 1u];
    ++neighbours.start[spring.b + 1u];
  }
  for (std::size_t i = 0; i < masses; ++i) neighbours.start[i + 1] += neighbours.start[i];
  neighbours.slot.resize(neighbours.start.back());
  std::vector<std::uint32_t> next(neighbours.start.begin(), neighbours.start.end() - 1);
  for (const Spring& spring : springs) {
    neighbours.slot[next[spring.a]++] = spring.b;
    neighbours.slot[next[spring.b]++] = spring.a;
  }
  return neighbours;
}

// Partners for the padding of one row, in the banks that the row leaves free. There are as many of these banks as there
// are padding entries.
class PaddingPartners {
 public:
  PaddingPartners(const Neighbours& neighbours, std::uint32_t tile, std::uint32_t used_banks)
      : neighbours_(neighbours), masses_(static_cast<std::uint32_t>(neighbours.start.size() - 1)), tile_(tile),
        used_banks_(used_banks) {}

  // A neighbour of the owner. Slots after the last mass exist in memory but hold no mass; their lanes read one another.
  // Returns the owner itself if no candidate has a free bank.
  std::uint16_t neighbour_of(std::uint16_t owner) {
    if (owner < masses_) {
      for (std::uint32_t k = neighbours_.start[owner]; k < neighbours_.start[owner + 1u]; ++k)
        if (take_bank_of(neighbours_.slot[k])) return neighbours_.slot[k];
    } else {
      for (std::uint32_t slot = masses_; slot % lanes != 0; ++slot)
        if (take_bank_of(slot)) return static_cast<std::uint16_t>(slot);
    }
    return owner;
  }

  // Any mass of the owner's tile or the previous one. Returns the owner itself if no candidate has a free bank.
  std::uint16_t any(std::uint16_t owner) {
    if (owner >= masses_ || take_bank_of(owner)) return owner;
    for (std::uint32_t slot = tile_ * lanes; slot < masses_ && slot < (tile_ + 1) * lanes; ++slot)
      if (take_bank_of(slot)) return static_cast<std::uint16_t>(slot);
    for (std::uint32_t slot = (tile_ > 0 ? tile_ - 1 : 0) * lanes; slot < tile_ * lanes; ++slot)
      if (take_bank_of(slot)) return static_cast<std::uint16_t>(slot);
    return owner;
  }

 private:
  bool take_bank_of(std::uint32_t slot) {
    if (used_banks_ >> slot % lanes & 1) return false;
    used_banks_ |= 1u << slot % lanes;
    return true;
  }

  const Neighbours& neighbours_;
  const std::uint32_t masses_, tile_;
  std::uint32_t used_banks_;
};

void append_row(Schedule& schedule, std::span<const OwnedSpring> springs, const EdgeColouring& colouring,
                std::uint32_t colour, const Neighbours& neighbours) {
  const std::uint32_t tile = schedule.tiles();
  std::array<ScheduledSpring, lanes> row;
  std::uint32_t used_banks = 0;
  for (std::uint32_t lane = 0; lane < lanes; ++lane) {
    const std::uint32_t e = colouring.edge_at(lane, colour);
    if (e == EdgeColouring::none) continue;
    row[lane] = {springs[e].spring, springs[e].partner};
    used_banks |= 1u << springs[e].partner % lanes;
  }
  PaddingPartners partners(neighbours, tile, used_banks);
  const auto for_each_padding = [&](auto visit) {
    for (std::uint32_t lane = 0; lane < lanes; ++lane)
      if (row[lane].spring == padding) visit(row[lane].partner, static_cast<std::uint16_t>(tile * lanes + lane));
  };
  for_each_padding([&](std::uint16_t& partner, std::uint16_t owner) { partner = partners.neighbour_of(owner); });
  for_each_padding([&](std::uint16_t& partner, std::uint16_t owner) {
    if (partner == owner) partner = partners.any(owner);
  });
  schedule.entries.insert(schedule.entries.end(), row.begin(), row.end());
}

void append_tile(Schedule& schedule, std::span<const OwnedSpring> springs, const Neighbours& neighbours) {
  const EdgeColouring colouring(springs);
  for (std::uint32_t colour = 0; colour < colouring.colours(); ++colour)
    append_row(schedule, springs, colouring, colour, neighbours);
  schedule.row_start.push_back(schedule.row_start.back() + colouring.colours());
}

}  // namespace

Schedule schedule_springs(std::size_t masses, std::span<const Spring> springs) {
  const OwnedSprings owned = choose_owners(masses, springs);
  Schedule schedule;
  schedule.row_start.push_back(0);
  schedule.entries.reserve(springs.size() * 5 / 4);
  const Neighbours neighbours = find_neighbours(masses, springs);
  for (std::uint32_t tile = 0; tile < tiles_for(masses); ++tile) append_tile(schedule, owned.of_tile(tile), neighbours);
  return schedule;
}

}  // namespace mercury::cuda
