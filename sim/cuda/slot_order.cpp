// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/slot_order.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "sim/cuda/launch_configuration.h"

namespace mercury::cuda {
namespace {

// Numbers of eight banks, added as a vector (GCC and Clang).
using EightBanks [[gnu::vector_size(16)]] = std::uint16_t;
constexpr std::uint32_t parts = lanes / 8;

// A number per bank. Whole vectors are added also where a single bank changes: a vector load right after a narrow store
// would stall.
struct PerBank {
  std::array<EightBanks, parts> part{};

  std::uint32_t operator[](std::uint32_t bank) const { return part[bank / 8][bank % 8]; }
  void add(const PerBank& other) {
    for (std::uint32_t i = 0; i < parts; ++i) part[i] += other.part[i];
  }
  void add(const PerBank& other, std::uint16_t times) {
    for (std::uint32_t i = 0; i < parts; ++i) part[i] += other.part[i] * times;
  }
};

std::array<PerBank, lanes> unit_vectors() {
  std::array<PerBank, lanes> units;
  for (std::uint32_t bank = 0; bank < lanes; ++bank) units[bank].part[bank / 8][bank % 8] = 1;
  return units;
}

class SlotSearch {
 public:
  SlotSearch(const Robot& robot, std::span<const FacePair> pairs, std::uint32_t ghosts)
      : masses_(static_cast<std::uint32_t>(robot.masses.size())), own_(masses_ - ghosts), own_tiles_(tiles_for(own_)),
        tiles_(own_tiles_ + tiles_for(ghosts)) {
    count_springs(robot);
    sort_by_valence();
    list_neighbors(robot);
    count_corners(pairs);
    place_tiles();
    choose_lanes();
  }

  SlotOrder take() { return {std::move(slots_)}; }

 private:
  std::uint32_t valence(std::uint32_t mass) const { return first_neighbor_[mass + 1] - first_neighbor_[mass]; }

  void count_springs(const Robot& robot) {
    first_neighbor_.assign(masses_ + 1, 0);
    for (const Spring& s : robot.springs) ++first_neighbor_[s.a], ++first_neighbor_[s.b];
    std::uint32_t count = 0;
    for (std::uint32_t& first : first_neighbor_) first = std::exchange(count, count + first);
  }

  // By counting. Until then tiles are numbered by descending valence. Ghosts keep their order.
  void sort_by_valence() {
    std::uint32_t most = 0;
    for (std::uint32_t mass = 0; mass < own_; ++mass) most = std::max(most, valence(mass));
    std::vector<std::uint32_t> next(most + 1);
    for (std::uint32_t mass = 0; mass < own_; ++mass) ++next[most - valence(mass)];
    std::uint32_t count = 0;
    for (std::uint32_t& n : next) n = std::exchange(count, count + n);
    sorted_.resize(std::size_t{tiles_} * lanes);
    tile_.resize(masses_);
    for (std::uint32_t mass = 0; mass < masses_; ++mass) {
      const std::uint32_t rank = mass < own_ ? next[most - valence(mass)]++ : own_tiles_ * lanes + mass - own_;
      sorted_[rank] = static_cast<std::uint16_t>(mass);
      tile_[mass] = static_cast<std::uint16_t>(rank / lanes);
    }
  }

  void list_neighbors(const Robot& robot) {
    neighbor_tiles_.resize(first_neighbor_.back());
    std::vector<std::uint32_t> next(first_neighbor_.begin(), first_neighbor_.end() - 1);
    for (const Spring& s : robot.springs) {
      neighbor_tiles_[next[s.a]++] = tile_[s.b];
      neighbor_tiles_[next[s.b]++] = tile_[s.a];
    }
  }

  void count_corners(std::span<const FacePair> pairs) {
    corners_.resize(masses_);
    for (const FacePair& p : pairs) {
      ++corners_[p.a].shared, ++corners_[p.c].shared;
      ++corners_[p.b].outer, ++corners_[p.d].outer;
    }
  }

  void place_tiles() {
    std::vector<std::uint32_t> work(own_tiles_);
    for (std::uint32_t rank = 0; rank < own_; ++rank) work[rank / lanes] += valence(sorted_[rank]);
    position_ = deal_tiles(work, even_warps(own_tiles_, resident_warps / 2));
    while (position_.size() < tiles_) position_.push_back(static_cast<std::uint32_t>(position_.size()));
  }

  std::uint32_t masses_of(std::uint32_t tile) const {
    return std::min(lanes, tile < own_tiles_ ? own_ - tile * lanes : masses_ - own_ - (tile - own_tiles_) * lanes);
  }

  void choose_lanes() {
    slots_.resize(masses_);
    used_.resize(tiles_);
    for (std::uint32_t tile = 0; tile < tiles_; ++tile) {
      const std::uint32_t size = masses_of(tile);
      std::uint32_t free = size == lanes ? ~0u : (1u << size) - 1;
      for (std::uint32_t rank = tile * lanes; rank < tile * lanes + size; ++rank) {
        const std::uint32_t mass = sorted_[rank], lane = best_lane(mass, free);
        free &= ~(1u << lane);
        take_bank(mass, lane);
        slots_[mass] = static_cast<std::uint16_t>(position_[tile] * lanes + lane);
      }
    }
  }

  std::uint32_t best_lane(std::uint32_t mass, std::uint32_t free) const {
    PerBank uses;
    for (std::uint32_t k = first_neighbor_[mass]; k < first_neighbor_[mass + 1]; ++k)
      uses.add(used_[neighbor_tiles_[k]]);
    uses.add(used_by_shared_, corners_[mass].shared);
    uses.add(used_by_outer_, corners_[mass].outer);
    std::uint32_t best = ~0u;
    for (std::uint32_t lane = 0; lane < lanes; ++lane)
      best = std::min(best, std::uint32_t{uses[lane]} << 5 | lane | (free >> lane & 1 ? 0u : 1u << 31));
    return best % lanes;
  }

  void take_bank(std::uint32_t mass, std::uint32_t bank) {
    const PerBank unit = units_[bank];
    for (std::uint32_t k = first_neighbor_[mass]; k < first_neighbor_[mass + 1]; ++k)
      used_[neighbor_tiles_[k]].add(unit);
    used_by_shared_.add(unit, corners_[mass].shared);
    used_by_outer_.add(unit, corners_[mass].outer);
  }

  struct Corners {
    std::uint16_t shared = 0, outer = 0;  // as a or c, as b or d
  };

  std::uint32_t masses_, own_, own_tiles_, tiles_;  // own: without ghosts
  std::vector<std::uint32_t> first_neighbor_;       // [mass]
  std::vector<std::uint16_t> sorted_;               // masses by descending valence, [slot before tiles are placed]
  std::vector<std::uint16_t> tile_;                 // [mass]
  std::vector<std::uint16_t> neighbor_tiles_;       // those of mass m at [first_neighbor_[m], first_neighbor_[m + 1])
  std::vector<Corners> corners_;                    // [mass]
  std::vector<std::uint32_t> position_;             // [tile]
  const std::array<PerBank, lanes> units_ = unit_vectors();
  std::vector<PerBank> used_;                   // [tile] by its springs, those within it twice
  PerBank used_by_shared_{}, used_by_outer_{};  // by corners
  std::vector<std::uint16_t> slots_;            // [mass]
};

}  // namespace

std::vector<FacePair> SlotOrder::placed(std::span<const FacePair> pairs) const {
  std::vector<FacePair> moved;
  moved.reserve(pairs.size());
  for (const FacePair& p : pairs) {
    FacePair& m = moved.emplace_back(FacePair{slots[p.a], slots[p.b], slots[p.c], slots[p.d]});
    if (m.d == m.a) continue;  // a single face
    if (m.c < m.a) std::swap(m.a, m.c);
    if (m.d < m.b) std::swap(m.b, m.d);
  }
  return moved;
}

SlotOrder choose_slots(const Robot& robot, std::span<const FacePair> pairs, std::uint32_t ghosts) {
  return SlotSearch(robot, pairs, ghosts).take();
}

std::vector<std::uint32_t> deal_tiles(std::span<const std::uint32_t> work, std::uint32_t warp_count) {
  const auto tiles = static_cast<std::uint32_t>(work.size());
  struct Warp {
    std::uint32_t work = 0, first, end;  // positions that are free
  };
  std::vector<Warp> warps;
  for (std::uint32_t warp = 0; warp < warp_count; ++warp)
    warps.push_back({0, first_tile_of(warp, tiles, warp_count), first_tile_of(warp + 1, tiles, warp_count)});
  std::vector<std::uint32_t> position(tiles);
  position.back() = --warps.back().end;
  warps.back().work += work.back();
  for (std::uint32_t tile = 0; tile + 1 < tiles; ++tile) {
    const auto lightest =
        std::ranges::min_element(warps, {}, [](const Warp& w) { return std::pair(w.first == w.end, w.work); });
    position[tile] = lightest->first++;
    lightest->work += work[tile];
  }
  return position;
}

}  // namespace mercury::cuda
