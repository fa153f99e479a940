// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/spring_owners.h"

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>
#include <utility>

namespace mercury::cuda {
namespace {

std::uint32_t lane_counter(OwnedSpring s) { return cuda::lane_counter(s.owner); }

OwnedSpring exchanged(OwnedSpring s) { return {s.partner, s.owner}; }
// Without a branch, which would often be mispredicted.
OwnedSpring exchanged_if(bool condition, OwnedSpring s) {
  const auto both = static_cast<std::uint16_t>((s.owner ^ s.partner) & -static_cast<int>(condition));
  return {static_cast<std::uint16_t>(s.owner ^ both), static_cast<std::uint16_t>(s.partner ^ both)};
}

class OwnerSearch {
 public:
  OwnerSearch(std::size_t masses, std::vector<OwnedSpring> springs, std::size_t ghosts)
      : springs_(std::move(springs)), tiles_(tiles_for(masses)), partly_empty_(masses % lanes != 0 && tiles_ > 1),
        load_((tiles_ + tiles_for(ghosts)) * tile_counters) {
    if (ghosts == 0) banks_ = MassBanks(masses, springs_);
    std::fill(load_.begin() + tiles_ * tile_counters, load_.end(), too_busy);
    if (partly_empty_) add_to_last_lanes(head_start);
    choose_first();
    even_out(3);
    even_out(2);
    if (partly_empty_) add_to_last_lanes(-head_start);
    list_candidates();
    lower_peaks();
    group_rows();
  }

  OwnedSprings take() {
    return {std::move(springs_), banks_, std::move(limit_), std::move(first_candidate_), std::move(candidates_)};
  }

 private:
  static constexpr std::uint32_t max_visited = 12;
  // Springs that the lanes of a partly empty tile seem to have from the start. So other tiles own its springs.
  static constexpr int head_start = 16;
  // The load of ghosts, to which no spring is given.
  static constexpr int too_busy = 1 << 20;

  // A step of a chain: `spring` makes `counter` too full, and the counter before it less full.
  struct Link {
    std::uint32_t counter, spring, before;
  };

  std::uint32_t bank_counter(OwnedSpring s) const { return banks_.bank_counter(s); }

  void add_to_last_lanes(int springs) {
    for (std::uint32_t lane = 0; lane < lanes; ++lane) load_[(tiles_ - 1) * tile_counters + lane] += springs;
  }

  void change_loads(OwnedSpring s, int by) {
    load_[lane_counter(s)] += by;
    load_[bank_counter(s)] += by;
  }

  // The first half of the springs in turn with the second half: neighbors often load the same counters, and the
  // processor would wait for their new values.
  template <class Visit>
  void for_each_spring(Visit visit) {
    const std::size_t half = springs_.size() / 2;
    for (std::size_t i = 0; i < half; ++i) visit(springs_[i]), visit(springs_[half + i]);
    if (springs_.size() % 2 != 0) visit(springs_.back());
  }

  void choose_first() {
    for_each_spring([&](OwnedSpring& s) {
      const int moved = advantage(s) > 0;
      change_loads(s, 1 - moved);
      change_loads(exchanged(s), moved);
      s = exchanged_if(moved, s);
    });
  }

  // Exchanges ends where the advantage is at least this much. With 3, the sum of the squares of the loads falls. With 2
  // it may stay the same, which lets loads wander to where there is room.
  void even_out(int least) {
    for_each_spring([&](OwnedSpring& s) {
      const int moved = advantage(s) >= least;
      change_loads(s, -moved);
      change_loads(exchanged(s), moved);
      s = exchanged_if(moved, s);
    });
  }

  // How much more the two counters of a spring have than the two that its other mass would load.
  int advantage(OwnedSpring s) const {
    const OwnedSpring t = exchanged(s);
    return load_[lane_counter(s)] + load_[bank_counter(s)] - load_[lane_counter(t)] - load_[bank_counter(t)];
  }

  int busiest(std::uint32_t tile) const {
    const int* const load = &load_[tile * tile_counters];
    return *std::max_element(load, load + tile_counters);
  }

  // By counter the springs that load it, or would if their other mass owned them.
  void list_candidates() {
    first_candidate_.assign(load_.size() + 1, 0);
    const auto for_each_counter = [this](OwnedSpring s, auto visit) {
      visit(lane_counter(s)), visit(bank_counter(s));
      visit(lane_counter(exchanged(s))), visit(bank_counter(exchanged(s)));
    };
    for (const OwnedSpring s : springs_) for_each_counter(s, [&](std::uint32_t c) { ++first_candidate_[c]; });
    std::uint32_t count = 0;
    for (std::uint32_t& first : first_candidate_) first = count += first;
    candidates_.resize(count);
    for (std::uint32_t i = 0; i < springs_.size(); ++i)
      for_each_counter(springs_[i], [&](std::uint32_t c) { candidates_[--first_candidate_[c]] = i; });
  }

  void lower_peaks() {
    limit_.resize(load_.size() / tile_counters);
    for (std::uint32_t tile = 0; tile < tiles_; ++tile) {
      const int limit = busiest(tile);
      limit_[tile] = static_cast<std::uint32_t>(limit);
      for (std::uint32_t i = 0; i < tile_counters; ++i) load_[tile * tile_counters + i] -= limit;
    }
    visited_.assign(load_.size(), 0);
    std::vector<std::uint32_t> open(tiles_);
    std::iota(open.begin(), open.end(), 0u);
    if (partly_empty_) {
      while (lower(tiles_ - 1)) continue;
      open.pop_back();
    }
    while (!open.empty()) std::erase_if(open, [&](std::uint32_t tile) { return !lower(tile); });
  }

  // From here on loads are relative to the limit of their tile.

  // Rows are computed rows_at_once at a time, so limits become multiples of it where that takes no rows more: tiles
  // whose limits rise take springs of tiles whose limits fall, first of those that are little above a multiple. What is
  // too many in the end comes off single rows. A partly empty tile keeps its limit.
  void group_rows() {
    constexpr std::uint32_t group = rows_at_once;
    std::vector<std::uint32_t> above(tiles_), order(tiles_);
    std::uint32_t too_many = 0;
    for (std::uint32_t tile = 0; tile < tiles_ - partly_empty_; ++tile) {
      above[tile] = limit_[tile] % group;
      if (above[tile] == 0) continue;
      change_limit(tile, static_cast<int>(group - above[tile]));
      too_many += group - above[tile];
    }
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::stable_sort(order, {}, [&](std::uint32_t tile) { return above[tile]; });
    for (const std::uint32_t step : {group, 1u})
      for (const std::uint32_t tile : order)
        while (above[tile] > 0 && too_many >= step && lower_by(tile, step)) {
          too_many -= step;
          if (step == group) break;
        }
  }

  // lower(), all of these times or not at all.
  bool lower_by(std::uint32_t tile, std::uint32_t rows) {
    for (std::uint32_t lowered = 0; lowered < rows; ++lowered)
      if (!lower(tile)) {
        change_limit(tile, static_cast<int>(lowered));
        return false;
      }
    return true;
  }

  // Lowers the limit of a tile by one and the loads with it. Returns false if that fails. Loads that were lowered by
  // then stay so.
  bool lower(std::uint32_t tile) {
    if (limit_[tile] == 0) return false;
    change_limit(tile, -1);
    for (std::uint32_t counter = tile * tile_counters; counter < (tile + 1) * tile_counters; ++counter)
      while (load_[counter] > 0)
        if (!relieve(counter)) {
          change_limit(tile, 1);
          return false;
        }
    return true;
  }

  void change_limit(std::uint32_t tile, int by) {
    limit_[tile] += static_cast<std::uint32_t>(by);
    for (std::uint32_t i = 0; i < tile_counters; ++i) load_[tile * tile_counters + i] -= by;
  }

  // Finds a chain of springs that change owners so that this counter has one spring less and no other is above its
  // limit. Looks at no more than max_visited counters.
  bool relieve(std::uint32_t counter) {
    ++visit_;
    visited_[counter] = visit_;
    links_[0] = {counter, 0, 0};
    std::uint32_t found = 1;
    for (std::uint32_t at = 0; at < std::min(found, max_visited); ++at) {
      const std::uint32_t from = links_[at].counter;
      const bool is_lane = from % tile_counters < lanes;
      const auto load_lane = [](OwnedSpring s) { return lane_counter(s); };
      const auto load_bank = [this](OwnedSpring s) { return bank_counter(s); };
      if (is_lane ? extend(at, found, load_lane) : extend(at, found, load_bank)) return true;
    }
    return false;
  }

  // Looks for the end of the chain among the springs that load a counter, and appends the counters that could continue
  // it. Without branches on whether a spring loads the counter, which would often be mispredicted.
  template <class CounterOf>
  bool extend(std::uint32_t at, std::uint32_t& found, CounterOf counter_of) {
    const std::uint32_t from = links_[at].counter;
    for (std::uint32_t c = first_candidate_[from]; c < first_candidate_[from + 1]; ++c) {
      const std::uint32_t spring = candidates_[c];
      const OwnedSpring s = springs_[spring], t = exchanged(s);
      const std::uint32_t lane = lane_counter(t), bank = bank_counter(t);
      const bool loads = counter_of(s) == from;
      const bool lane_free = load_[lane] < 0, bank_free = load_[bank] < 0;
      if (loads & lane_free & bank_free) {
        if (pass_on(at, spring)) return true;
        continue;
      }
      const std::uint32_t full = lane_free ? bank : lane;
      const bool continues = loads & (lane_free != bank_free) & (visited_[full] != visit_);
      links_[found] = {full, spring, at};
      visited_[full] = continues ? visit_ : visited_[full];
      found = std::min(found + continues, max_visited);
    }
    return false;
  }

  // Exchanges the ends of the springs of a chain. A chain may meet a counter twice and overload it; then it is undone.
  bool pass_on(std::uint32_t last, std::uint32_t spring) {
    std::array<std::uint32_t, max_visited> chain;
    std::uint32_t length = 0;
    chain[length++] = spring;
    for (std::uint32_t at = last; at > 0; at = links_[at].before) chain[length++] = links_[at].spring;
    for (std::uint32_t i = 0; i < length; ++i) exchange(chain[i]);
    bool fits = true;
    for (std::uint32_t i = 0; i < length; ++i) {
      const OwnedSpring s = springs_[chain[i]];
      fits = fits && load_[lane_counter(s)] <= 0 && load_[bank_counter(s)] <= 0;
    }
    if (fits) return true;
    for (std::uint32_t i = 0; i < length; ++i) exchange(chain[i]);
    return false;
  }

  void exchange(std::uint32_t spring) {
    change_loads(springs_[spring], -1);
    springs_[spring] = exchanged(springs_[spring]);
    change_loads(springs_[spring], 1);
  }

  std::vector<OwnedSpring> springs_;
  std::uint32_t tiles_;  // without those of ghosts
  bool partly_empty_;    // the last tile
  MassBanks banks_;
  std::vector<int> load_;                                    // [counter]
  std::vector<std::uint32_t> limit_;                         // [tile]
  std::vector<std::uint32_t> first_candidate_, candidates_;  // OwnedSprings
  std::vector<std::uint32_t> visited_;                       // [counter] the last search that met it
  std::uint32_t visit_ = 0;
  std::array<Link, max_visited + 1> links_;
};

}  // namespace

// In a row, a mass takes part once as an owner, and once for each of its banks. There are enough if all masses are busy
// in each row.
MassBanks::MassBanks(std::size_t masses, std::span<const OwnedSpring> springs) {
  if (masses > lanes) return;
  constexpr std::uint32_t most = 4;
  const auto rows = divide_up(static_cast<std::uint32_t>(springs.size()), static_cast<std::uint32_t>(masses));
  std::array<std::uint32_t, lanes> valence{};
  for (const OwnedSpring s : springs) ++valence[s.owner], ++valence[s.partner];
  std::uint32_t next = lanes;
  for (std::uint32_t slot = 0; slot < masses; ++slot) {
    if (valence[slot] <= 2 * rows) continue;
    const std::uint32_t others = std::min(std::bit_ceil(divide_up(valence[slot], rows) - 1), most) - 1;
    if (next + others > lanes + most_extra_banks) continue;
    others_[slot] = static_cast<std::uint8_t>(others);
    before_others_[slot] = static_cast<std::uint8_t>(next - 1);
    next += others;
    has_others_ = true;
  }
}

OwnedSprings choose_owners(std::size_t masses, std::vector<OwnedSpring> springs, std::size_t ghosts) {
  return OwnerSearch(masses, std::move(springs), ghosts).take();
}

}  // namespace mercury::cuda
