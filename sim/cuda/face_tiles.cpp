// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/face_tiles.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace mercury::cuda {
namespace {

constexpr std::uint32_t columns = 4;

using Banks = std::array<std::uint8_t, columns>;  // of a pair's four masses
using Tiles = std::uint64_t;                      // a set of face tiles, one bit each
constexpr std::size_t max_tiles = 64;

Tiles tile_bit(std::uint32_t tile) { return Tiles{1} << tile; }
std::uint32_t first_of(Tiles tiles) { return static_cast<std::uint32_t>(std::countr_zero(tiles)); }

// A vertex order exchanges a and c (bit 0), or b and d (bit 1), or both.
FacePair in_vertex_order(FacePair p, std::uint32_t order) {
  if (order & 1) std::swap(p.a, p.c);
  if (order & 2) std::swap(p.b, p.d);
  return p;
}

Banks banks_of(const FacePair& p) {
  const auto bank = [](std::uint16_t slot) { return static_cast<std::uint8_t>(slot % lanes); };
  return {bank(p.a), bank(p.b), bank(p.c), bank(p.d)};
}

// For each tile how often it is in some of the sets that were added, up to 63 of them: bit i of the number is in plane
// i.
class TileCounts {
 public:
  void add(Tiles tiles) {
    for (Tiles& plane : planes_) {
      const Tiles carry = plane & tiles;
      plane ^= tiles;
      tiles = carry;
    }
  }
  struct Most {
    std::uint32_t count, tile;
  };
  Most most() const {
    Tiles among = ~Tiles{0};
    std::uint32_t count = 0;
    for (std::uint32_t plane = planes; plane-- > 0;)
      if ((among & planes_[plane]) != 0) {
        among &= planes_[plane];
        count |= 1u << plane;
      }
    return {count, first_of(among)};
  }

  static constexpr std::uint32_t planes = 6;

 private:
  std::array<Tiles, planes> planes_{};
};

// Deals up to 2048 pairs out to as few face tiles as can hold them.
class FaceTiles {
 public:
  explicit FaceTiles(std::span<const FacePair> pairs) : pairs_(pairs), banks_(pairs.size()), choices_(pairs.size()) {
    const std::size_t tiles = (pairs.size() + lanes - 1) / lanes;
    with_room_ = ~Tiles{0} >> (max_tiles - tiles);
    for (auto& column : free_) column.fill(with_room_);
    for (std::size_t p = 0; p < pairs.size(); ++p) banks_[p] = banks_of(pairs[p]);
    std::vector<std::uint32_t> left = by_load();
    std::erase_if(left, [&](std::uint32_t p) { return place(p); });
    place_with_conflicts(left);
  }

  void append_to(std::vector<FacePair>& ordered) const {
    const std::size_t first = ordered.size();
    ordered.resize(first + (pairs_.size() + lanes - 1) / lanes * lanes, padding_faces);
    std::array<std::uint32_t, max_tiles> used{};
    for (std::size_t p = 0; p < pairs_.size(); ++p) {
      const auto [tile, order] = choices_[p];
      ordered[first + tile * lanes + used[tile]++] = in_vertex_order(pairs_[p], order);
    }
  }

 private:
  struct Choice {
    std::uint8_t tile, order;
  };

  // The pairs whose banks are corners of most others first, since they fit into the fewest tiles. Sorted by counting.
  std::vector<std::uint32_t> by_load() const {
    CornerBanks corners;
    for (const FacePair& p : pairs_) corners.add(p);
    const std::uint32_t most = 2 * (std::ranges::max(corners.shared) + std::ranges::max(corners.outer));
    const auto lightness = [&](const Banks& b) {
      return most - corners.shared[b[0]] - corners.shared[b[2]] - corners.outer[b[1]] - corners.outer[b[3]];
    };
    std::vector<std::uint32_t> first(most + 1);
    for (const Banks& banks : banks_) ++first[lightness(banks)];
    std::uint32_t count = 0;
    for (std::uint32_t& f : first) f = std::exchange(count, count + f);
    std::vector<std::uint32_t> sorted(pairs_.size());
    for (std::uint32_t p = 0; p < pairs_.size(); ++p) sorted[first[lightness(banks_[p])]++] = p;
    return sorted;
  }

  // Two columns that a vertex order can exchange: 0 and 2 (a and c), or 1 and 3 (b and d).
  struct Side {
    Tiles fits;               // tiles where both columns have room for the pair, in either order
    Tiles blocked_by_first;   // only the first column is in the way, in either order
    Tiles blocked_by_second;  // only the second one is
  };
  Side side(const Banks& banks, std::uint32_t first) const {
    const std::uint32_t second = first + 2, x = banks[first], y = banks[second];
    const Tiles x1 = free_[first][x], y2 = free_[second][y], y1 = free_[first][y], x2 = free_[second][x];
    return {(x1 & y2) | (y1 & x2), (~x1 & y2) | (~y1 & x2), (x1 & ~y2) | (y1 & ~x2)};
  }

  // Puts a pair into the first tile that fits. Returns false if none does.
  bool place(std::uint32_t p) {
    const Tiles tiles = with_room_ & side(banks_[p], 0).fits & side(banks_[p], 1).fits;
    if (tiles == 0) return false;
    put(p, first_of(tiles));
    return true;
  }

  void put(std::uint32_t p, std::uint32_t tile) {
    const Tiles bit = tile_bit(tile);
    const auto fits = [&](std::uint32_t first) {
      return (free_[first][banks_[p][first]] & free_[first + 2][banks_[p][first + 2]] & bit) != 0;
    };
    const std::uint32_t order = (fits(0) ? 0u : 1u) | (fits(1) ? 0u : 2u);
    choices_[p] = {static_cast<std::uint8_t>(tile), static_cast<std::uint8_t>(order)};
    const Banks banks = banks_in(order, banks_[p]);
    for (std::uint32_t column = 0; column < columns; ++column) {
      if (++uses_[column][banks[column]][tile] == limit_[column][tile]) free_[column][banks[column]] &= ~bit;
    }
    if (++size_[tile] == lanes) with_room_ &= ~bit;
  }

  static Banks banks_in(std::uint32_t order, Banks banks) {
    if (order & 1) std::swap(banks[0], banks[2]);
    if (order & 2) std::swap(banks[1], banks[3]);
    return banks;
  }

  // Lets columns use banks once more until all pairs have a place, each time the column that lets most pairs in.
  void place_with_conflicts(std::vector<std::uint32_t>& left) {
    while (!left.empty()) {
      std::array<TileCounts, columns> wanted;
      for (std::size_t i = 0; i < std::min<std::size_t>(left.size(), (1u << TileCounts::planes) - 1); ++i) {
        const Side shared = side(banks_[left[i]], 0), outer = side(banks_[left[i]], 1);
        wanted[0].add(with_room_ & outer.fits & shared.blocked_by_first);
        wanted[1].add(with_room_ & shared.fits & outer.blocked_by_first);
        wanted[2].add(with_room_ & outer.fits & shared.blocked_by_second);
        wanted[3].add(with_room_ & shared.fits & outer.blocked_by_second);
      }
      std::uint32_t column = 0;
      TileCounts::Most most = wanted[0].most();
      for (std::uint32_t other = 1; other < columns; ++other)
        if (const TileCounts::Most its = wanted[other].most(); its.count > most.count) most = its, column = other;
      if (most.count > 0) {
        raise_limit(column, most.tile);
      } else {  // each pair needs two columns
        const std::uint32_t tile = first_of(with_room_);
        const std::uint32_t first = side(banks_[left.front()], 0).fits >> tile & 1;
        raise_limit(first, tile);
        raise_limit(first + 2, tile);
      }
      std::erase_if(left, [&](std::uint32_t p) { return place(p); });
    }
  }

  void raise_limit(std::uint32_t column, std::uint32_t tile) {
    ++limit_[column][tile];
    for (Tiles& tiles : free_[column]) tiles |= tile_bit(tile);
  }

  template <class T>
  using ByBankAndTile = std::array<std::array<std::array<T, max_tiles>, lanes>, columns>;  // [column][bank][tile]

  std::span<const FacePair> pairs_;
  std::vector<Banks> banks_;                            // [pair]
  std::vector<Choice> choices_;                         // [pair]
  std::array<std::array<Tiles, lanes>, columns> free_;  // [column][bank] tiles that may use the bank once more
  Tiles with_room_;                                     // for one more pair
  ByBankAndTile<std::uint8_t> uses_{};
  std::array<std::array<std::uint8_t, max_tiles>, columns> limit_ = all_one();  // [column][tile] uses per bank
  std::array<std::uint8_t, max_tiles> size_{};                                  // [tile]

  static constexpr std::array<std::array<std::uint8_t, max_tiles>, columns> all_one() {
    std::array<std::array<std::uint8_t, max_tiles>, columns> limits;
    for (auto& column : limits) column.fill(1);
    return limits;
  }
};

}  // namespace

void CornerBanks::add(const FacePair& p) {
  ++shared[p.a % lanes], ++shared[p.c % lanes];
  ++outer[p.b % lanes], ++outer[p.d % lanes];
}

std::uint32_t CornerBanks::fewest_passes(std::size_t pairs) const {
  const auto two_columns = static_cast<std::uint32_t>(2 * ((pairs + lanes - 1) / lanes));
  return std::max(two_columns, std::ranges::max(shared)) + std::max(two_columns, std::ranges::max(outer));
}

std::vector<FacePair> make_face_tiles(std::span<const FacePair> pairs) {
  std::vector<FacePair> ordered;
  ordered.reserve(pairs.size() + lanes);
  constexpr std::size_t most = max_tiles * lanes;
  for (std::size_t first = 0; first < pairs.size(); first += most)
    FaceTiles(pairs.subspan(first, std::min(most, pairs.size() - first))).append_to(ordered);
  return ordered;
}

}  // namespace mercury::cuda
