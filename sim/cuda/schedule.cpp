// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/schedule.h"

#include <algorithm>
#include <bit>
#include <span>
#include <utility>

namespace mercury::cuda {
namespace {

// Colors the springs of each tile so that springs of one color share neither a lane nor a bank. A color becomes a
// row.
//
// The springs of a tile are the edges of a bipartite graph: on one side the 32 lanes of the owners, on the other the 32
// banks of the partners. A mass with several banks (spring_owners.h) is as many of them.
//
//   lanes      0    1    2   ...  31          spring: owner's lane -> partner's bank
//              | \  |  / |         |          edges that meet at a lane: the lane computes one spring per row
//              |  \ | /  |         |          edges that meet at a bank: one access per row and bank
//   banks      0    1    2   ...  31
//
// 1. Such a graph can be colored with as many colors as the busiest vertex has edges (Koenig's theorem). No
//    schedule has fewer rows.
// 2. Each vertex keeps the set of its free colors as bits. An edge takes the first bit of the intersection of its two
//    ends' sets.
// 3. If the intersection is empty, some color p is free at the lane and some other color q at the bank. Exchanging p
//    and q along the path of edges colored p, q, p, ... that starts at the bank frees p at the bank too. The path
//    never ends at the lane, because it enters lanes by edges of color p.
// Words of 64 bits that the colors of the tile with most rows need.
std::uint32_t words_of_colors(std::span<const std::uint32_t> row_start) {
  std::uint32_t most = 1;
  for (std::size_t tile = 0; tile + 1 < row_start.size(); ++tile)
    most = std::max(most, row_start[tile + 1] - row_start[tile]);
  return (most + 63) / 64;
}

// All tiles at once, because their graphs have no edge in common. Nearly always a word has a bit for each color, and
// code for one word takes two thirds of the time.
template <bool one_word>
class EdgeColoring {
 public:
  EdgeColoring(const OwnedSprings& owned, std::span<const std::uint32_t> row_start)
      : springs_(owned.springs), mass_banks_(owned.banks), row_start_(row_start),
        words_(one_word ? 1 : words_of_colors(row_start)), entries_(std::size_t{row_start.back()} * lanes),
        lane_at_bank_(std::size_t{row_start.back()} * banks, no_lane) {
    const auto tiles = static_cast<std::uint32_t>(row_start.size() - 1);
    free_.resize(std::size_t{tiles} * tile_counters * words_);
    for (std::uint32_t tile = 0; tile < tiles; ++tile)
      for (std::uint32_t vertex = 0; vertex < tile_counters; ++vertex)
        free_all(tile * tile_counters + vertex, row_start[tile + 1] - row_start[tile]);
    // Neighbors often share a lane, and would wait for each other. So the halves take turns.
    const auto half = static_cast<std::uint32_t>(springs_.size() / 2);
    for (std::uint32_t i = 0; i < half; ++i) color(i), color(half + i);
    if (springs_.size() % 2 != 0) color(2 * half);
  }

  std::vector<ScheduledSpring> take() { return std::move(entries_); }

 private:
  static constexpr std::uint8_t no_lane = 0xff;
  static constexpr std::uint32_t banks = tile_counters - lanes;
  static constexpr std::uint32_t no_color = 0xffffffffu;

  std::uint32_t words() const { return one_word ? 1 : words_; }
  std::uint64_t& free_word(std::uint32_t vertex, std::uint32_t word) { return free_[vertex * words() + word]; }

  void free_all(std::uint32_t vertex, std::uint32_t colors) {
    for (std::uint32_t word = 0; word < words(); ++word, colors -= std::min(colors, 64u))
      free_word(vertex, word) = colors >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << colors) - 1;
  }
  void flip(std::uint32_t vertex, std::uint32_t color) {
    free_word(vertex, color / 64) ^= std::uint64_t{1} << color % 64;
  }
  // The first color that is free at both vertices.
  std::uint32_t common_color(std::uint32_t u, std::uint32_t v) {
    for (std::uint32_t word = 0; word < words(); ++word)
      if (const std::uint64_t both = free_word(u, word) & free_word(v, word); both != 0)
        return word * 64 + static_cast<std::uint32_t>(std::countr_zero(both));
    return no_color;
  }

  void color(std::uint32_t i) {
    const OwnedSpring s = springs_[i];
    const std::uint32_t tile = s.owner / lanes, first_lane = tile * tile_counters, first_bank = first_lane + lanes;
    const std::uint32_t lane = s.owner % lanes, bank = mass_banks_.bank_of(s);
    const std::uint32_t c = common_color(first_lane + lane, first_bank + bank);
    if (c == no_color) return exchange_path(tile, lane, {i, s.partner});
    flip(first_lane + lane, c);
    flip(first_bank + bank, c);
    const std::size_t row = row_start_[tile] + c;
    entries_[row * lanes + lane] = {i, s.partner};
    lane_at_bank_[row * banks + bank] = static_cast<std::uint8_t>(lane);
  }

  // Gives an edge a color p that is free at its lane. Along the path, each edge that has p gives way and takes q, and
  // each edge that has q gives way in turn and takes p.
  void exchange_path(std::uint32_t tile, std::uint32_t lane, ScheduledSpring edge) {
    const std::uint32_t first_lane = tile * tile_counters, first_bank = first_lane + lanes;
    const auto bank_of = [&] {
      return mass_banks_.bank_of({static_cast<std::uint16_t>(tile * lanes + lane), edge.partner});
    };
    std::uint32_t bank = bank_of();
    const std::uint32_t p = common_color(first_lane + lane, first_lane + lane);
    const std::uint32_t q = common_color(first_bank + bank, first_bank + bank);
    const std::size_t row_p = row_start_[tile] + p, row_q = row_start_[tile] + q;
    flip(first_lane + lane, p);
    flip(first_bank + bank, q);
    while (true) {  // `edge` takes p at its lane, where p is free
      entries_[row_p * lanes + lane] = edge;
      const std::uint8_t other = std::exchange(lane_at_bank_[row_p * banks + bank], static_cast<std::uint8_t>(lane));
      if (other == no_lane) {  // the bank had the edge by q, and has it by p now
        flip(first_bank + bank, p);
        flip(first_bank + bank, q);
        lane_at_bank_[row_q * banks + bank] = no_lane;
        return;
      }
      // At the bank q is free now, at the lane of the other edge p.
      lane_at_bank_[row_q * banks + bank] = other;
      lane = other;
      edge = std::exchange(entries_[row_q * lanes + lane], entries_[row_p * lanes + lane]);
      if (edge.spring == padding) {
        entries_[row_p * lanes + lane] = {};
        flip(first_lane + lane, p);
        flip(first_lane + lane, q);
        return;
      }
      bank = bank_of();
    }
  }

  const std::span<const OwnedSpring> springs_;
  const MassBanks mass_banks_;
  const std::span<const std::uint32_t> row_start_;
  const std::uint32_t words_;               // of a set of colors
  std::vector<std::uint64_t> free_;         // [tile][lane or bank][word], a bit per color
  std::vector<ScheduledSpring> entries_;    // [row][lane]
  std::vector<std::uint8_t> lane_at_bank_;  // [row][bank]
};

// Rows of tile t are [row_start[t], row_start[t + 1]): as choose_owners() says. Returns the
// entries of all rows, 32 per row.
std::vector<ScheduledSpring> color_springs(const OwnedSprings& owned, std::span<const std::uint32_t> row_start) {
  if (words_of_colors(row_start) == 1) return EdgeColoring<true>(owned, row_start).take();
  return EdgeColoring<false>(owned, row_start).take();
}

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

Schedule schedule_springs(std::size_t masses, std::vector<OwnedSpring> springs, std::size_t ghosts) {
  const OwnedSprings owned = choose_owners(masses, std::move(springs), ghosts);
  Schedule schedule;
  schedule.row_start.push_back(0);
  for (const std::uint32_t rows : owned.rows) schedule.row_start.push_back(schedule.row_start.back() + rows);
  schedule.entries = color_springs(owned, schedule.row_start);
  for (std::uint32_t tile = 0; tile < tiles_for(masses); ++tile) {
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
