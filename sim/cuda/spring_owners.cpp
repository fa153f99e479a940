// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/spring_owners.h"

#include <random>

namespace mercury::cuda {
namespace {

// Local search for owners. Two loads count: the springs that a lane owns (lane_load_), and the springs of a tile whose
// partners lie in one bank (bank_load_). The search lowers the sum of their squares, which evens them out.
class Ownership {
 public:
  Ownership(std::size_t masses, std::span<const Spring> springs)
      : springs_(springs), lane_load_(masses), bank_load_(tiles_for(masses) * std::size_t{lanes}),
        owned_by_b_(springs.size()) {
    for (std::size_t s = 0; s < springs_.size(); ++s) {
      owned_by_b_[s] = load(springs_[s].b, springs_[s].a) < load(springs_[s].a, springs_[s].b);
      change_loads(s, 1);
    }
    constexpr int even_sweeps = 12, peak_sweeps = 12;
    for (int sweep = 0; sweep < even_sweeps; ++sweep) even_out(sweep);
    for (int sweep = 0; sweep < peak_sweeps; ++sweep) lower_peaks();
  }

  std::uint16_t owner(std::size_t s) const { return owned_by_b_[s] ? springs_[s].b : springs_[s].a; }
  std::uint16_t partner(std::size_t s) const { return owned_by_b_[s] ? springs_[s].a : springs_[s].b; }

 private:
  // By the owner's tile and the partner's bank.
  std::uint32_t& bank_load(std::uint16_t owner, std::uint16_t partner) {
    return bank_load_[owner / lanes * lanes + partner % lanes];
  }
  std::uint32_t load(std::uint16_t owner, std::uint16_t partner) {
    return lane_load_[owner] + bank_load(owner, partner);
  }
  void change_loads(std::size_t s, std::uint32_t by) {
    lane_load_[owner(s)] += by;
    bank_load(owner(s), partner(s)) += by;
  }
  void swap_ends(std::size_t s) {
    change_loads(s, static_cast<std::uint32_t>(-1));
    owned_by_b_[s] = !owned_by_b_[s];
    change_loads(s, 1);
  }

  // Gives springs to their other end where that lowers the sum of squares. Odd sweeps also do so where the sum stays
  // the same, which lets loads wander to where there is room.
  void even_out(int sweep) {
    for (std::size_t s = 0; s < springs_.size(); ++s) {
      const std::uint32_t here = load(owner(s), partner(s)), there = load(partner(s), owner(s)) + 2;
      if (there < here || (there == here && sweep % 2 != 0)) swap_ends(s);
    }
  }

  // Only loads above the average lengthen a tile. Gives springs to their other end where that lowers the sum of the
  // squares above the average, and at random where that sum stays the same.
  void lower_peaks() {
    const auto average = static_cast<std::uint32_t>((springs_.size() + lane_load_.size() - 1) / lane_load_.size());
    const auto above = [&](std::uint32_t load) { return load > average ? (load - average) * (load - average) : 0; };
    const auto cost_of_one_more = [&](std::uint32_t load) { return above(load + 1) - above(load); };
    for (std::size_t s = 0; s < springs_.size(); ++s) {
      const std::uint16_t from = owner(s), to = partner(s);
      const std::uint32_t gain = cost_of_one_more(lane_load_[from] - 1) + cost_of_one_more(bank_load(from, to) - 1);
      const std::uint32_t cost = cost_of_one_more(lane_load_[to]) + cost_of_one_more(bank_load(to, from));
      const auto chance = static_cast<std::uint32_t>(random_());
      const bool at_random = cost == gain && chance % (gain > 0 ? 2 : 32) == 0;
      if (cost < gain || at_random) swap_ends(s);
    }
  }

  const std::span<const Spring> springs_;
  std::minstd_rand random_;
  std::vector<std::uint32_t> lane_load_, bank_load_;
  std::vector<std::uint8_t> owned_by_b_;
};

}  // namespace

OwnedSprings choose_owners(std::size_t masses, std::span<const Spring> springs) {
  const Ownership ownership(masses, springs);
  const std::uint32_t tiles = tiles_for(masses);
  OwnedSprings owned;
  owned.start.assign(tiles + 1, 0);
  for (std::size_t s = 0; s < springs.size(); ++s) ++owned.start[ownership.owner(s) / lanes + 1];
  for (std::uint32_t t = 0; t < tiles; ++t) owned.start[t + 1] += owned.start[t];
  owned.springs.resize(springs.size());
  std::vector<std::uint32_t> next(owned.start.begin(), owned.start.end() - 1);
  for (std::size_t s = 0; s < springs.size(); ++s)
    owned.springs[next[ownership.owner(s) / lanes]++] = {ownership.owner(s), ownership.partner(s),
                                                         static_cast<std::uint32_t>(s)};
  return owned;
}

}  // namespace mercury::cuda
