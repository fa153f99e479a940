// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/face_tiles.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace mercury::cuda {
namespace {

constexpr std::uint32_t columns = 4;

using Tiles = std::uint64_t;  // a set of face tiles, one bit each
constexpr std::size_t max_tiles = 64;

Tiles tile_bit(std::uint32_t tile) { return Tiles{1} << tile; }
std::uint32_t first_of(Tiles tiles) { return static_cast<std::uint32_t>(std::countr_zero(tiles)); }

// A vertex order exchanges a and c (bit 0), or b and d (bit 1), or both.
FacePair in_vertex_order(FacePair p, std::uint32_t order) {
  if (order & 1) std::swap(p.a, p.c);
  if (order & 2) std::swap(p.b, p.d);
  return p;
}

std::uint16_t corner(const FacePair& p, std::uint32_t column) {
  return column == 0 ? p.a : column == 1 ? p.b : column == 2 ? p.c : p.d;
}

std::size_t slots_of(std::span<const FacePair> pairs) {
  std::size_t slots = 0;
  for (const FacePair& p : pairs)
    slots = std::max({slots, std::size_t{p.a} + 1, std::size_t{p.b} + 1, std::size_t{p.c} + 1, std::size_t{p.d} + 1});
  return slots;
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
  explicit FaceTiles(std::span<const FacePair> pairs) : pairs_(pairs), choices_(pairs.size()) {
    const std::size_t tiles = (pairs.size() + lanes - 1) / lanes;
    with_room_ = ~Tiles{0} >> (max_tiles - tiles);
    for (auto& column : room_for_mass_) column.fill(with_room_);
    for (auto& column : room_for_corner_) column.fill(with_room_);
    for (auto& column : has_) column.resize(slots_of(pairs));
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

  // The pairs whose banks are corners of most others first, since they fit into the fewest tiles. Pairs with about as
  // many keep their order, because those that follow one another often share masses. Sorted by counting.
  std::vector<std::uint32_t> by_load() const {
    CornerBanks corners;
    for (const FacePair& p : pairs_) corners.add(p);
    const auto width = static_cast<std::uint32_t>(1 + pairs_.size() / 32);
    const std::uint32_t most = 2 * (std::ranges::max(corners.shared) + std::ranges::max(corners.outer));
    const auto lightness = [&](const FacePair& p) {
      return (most - corners.shared[p.a % lanes] - corners.shared[p.c % lanes] - corners.outer[p.b % lanes] -
              corners.outer[p.d % lanes]) /
             width;
    };
    std::vector<std::uint32_t> first(most / width + 1);
    for (const FacePair& p : pairs_) ++first[lightness(p)];
    std::uint32_t count = 0;
    for (std::uint32_t& f : first) f = std::exchange(count, count + f);
    std::vector<std::uint32_t> sorted(pairs_.size());
    for (std::uint32_t p = 0; p < pairs_.size(); ++p) sorted[first[lightness(pairs_[p])]++] = p;
    return sorted;
  }

  // The tiles whose column can take a corner in this slot.
  Tiles fits(std::uint32_t column, std::uint16_t slot) const {
    return room_for_mass_[column][slot % lanes] | (has_[column][slot] & room_for_corner_[column][slot % lanes]);
  }

  // Two columns that a vertex order can exchange: 0 and 2 (a and c), or 1 and 3 (b and d).
  struct Side {
    Tiles fits;               // tiles where both columns have room for the pair, in either order
    Tiles blocked_by_first;   // only the first column is in the way, in either order
    Tiles blocked_by_second;  // only the second one is
  };
  Side side(const FacePair& p, std::uint32_t first) const {
    const std::uint32_t second = first + 2;
    const std::uint16_t x = corner(p, first), y = corner(p, second);
    const Tiles x1 = fits(first, x), y2 = fits(second, y), y1 = fits(first, y), x2 = fits(second, x);
    return {(x1 & y2) | (y1 & x2), (~x1 & y2) | (~y1 & x2), (x1 & ~y2) | (y1 & ~x2)};
  }

  // Puts a pair into the first tile that fits. Returns false if none does.
  bool place(std::uint32_t p) {
    const Tiles tiles = with_room_ & side(pairs_[p], 0).fits & side(pairs_[p], 1).fits;
    if (tiles == 0) return false;
    put(p, first_of(tiles));
    return true;
  }

  void put(std::uint32_t p, std::uint32_t tile) {
    const FacePair& pair = pairs_[p];
    const std::uint32_t order = (exchanges(pair, 0, tile) ? 1u : 0u) | (exchanges(pair, 1, tile) ? 2u : 0u);
    choices_[p] = {static_cast<std::uint8_t>(tile), static_cast<std::uint8_t>(order)};
    const FacePair ordered = in_vertex_order(pair, order);
    for (std::uint32_t column = 0; column < columns; ++column) {
      const std::uint16_t slot = corner(ordered, column);
      ++corners_[column][slot % lanes][tile];
      masses_[column][slot % lanes][tile] += (has_[column][slot] & tile_bit(tile)) == 0;
      has_[column][slot] |= tile_bit(tile);
      update_room(column, slot % lanes, tile);
    }
    if (++size_[tile] == lanes) with_room_ &= ~tile_bit(tile);
  }

  // Whether a pair should exchange the corners of a side: if only that fits, or if more of its masses are in their
  // columns already.
  bool exchanges(const FacePair& p, std::uint32_t first, std::uint32_t tile) const {
    const FacePair exchanged = in_vertex_order(p, 3);
    if (!fits_in_order(exchanged, first, tile)) return false;
    return !fits_in_order(p, first, tile) || known(exchanged, first, tile) > known(p, first, tile);
  }

  std::uint32_t known(const FacePair& p, std::uint32_t first, std::uint32_t tile) const {
    const Tiles x = has_[first][corner(p, first)] >> tile, y = has_[first + 2][corner(p, first + 2)] >> tile;
    return static_cast<std::uint32_t>((x & 1) + (y & 1));
  }

  bool fits_in_order(const FacePair& p, std::uint32_t first, std::uint32_t tile) const {
    return (fits(first, corner(p, first)) & fits(first + 2, corner(p, first + 2)) & tile_bit(tile)) != 0;
  }

  void update_room(std::uint32_t column, std::uint32_t bank, std::uint32_t tile) {
    const std::uint32_t limit = limit_[column][tile];
    const bool room = corners_[column][bank][tile] < std::max(limit, least_corners);
    const bool for_mass = room && masses_[column][bank][tile] < limit;
    const auto set = [&](Tiles& tiles, bool on) { tiles = (tiles & ~tile_bit(tile)) | Tiles{on} << tile; };
    set(room_for_corner_[column][bank], room);
    set(room_for_mass_[column][bank], for_mass);
  }

  // Lets columns use banks for one more mass until all pairs have a place, each time the column that lets most pairs
  // in.
  void place_with_conflicts(std::vector<std::uint32_t>& left) {
    while (!left.empty()) {
      std::array<TileCounts, columns> wanted;
      for (std::size_t i = 0; i < std::min<std::size_t>(left.size(), (1u << TileCounts::planes) - 1); ++i) {
        const Side shared = side(pairs_[left[i]], 0), outer = side(pairs_[left[i]], 1);
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
        const std::uint32_t first = side(pairs_[left.front()], 0).fits >> tile & 1;
        raise_limit(first, tile);
        raise_limit(first + 2, tile);
      }
      std::erase_if(left, [&](std::uint32_t p) { return place(p); });
    }
  }

  void raise_limit(std::uint32_t column, std::uint32_t tile) {
    ++limit_[column][tile];
    for (std::uint32_t bank = 0; bank < lanes; ++bank) update_room(column, bank, tile);
  }

  template <class T>
  using ByBankAndTile = std::array<std::array<std::array<T, max_tiles>, lanes>, columns>;  // [column][bank][tile]

  // Corners that a bank can have at first: those of one mass are read in one pass, and added in as many as they are.
  static constexpr std::uint32_t least_corners = 2;

  std::span<const FacePair> pairs_;
  std::vector<Choice> choices_;  // [pair]
  // [column][bank] tiles where the bank can take one more mass, or one more corner of a mass that it has
  std::array<std::array<Tiles, lanes>, columns> room_for_mass_, room_for_corner_;
  std::array<std::vector<Tiles>, columns> has_;                                 // [column][slot] tiles that have it
  Tiles with_room_;                                                             // for one more pair
  ByBankAndTile<std::uint8_t> corners_{}, masses_{};                            // in use; different ones
  std::array<std::array<std::uint8_t, max_tiles>, columns> limit_ = all_one();  // [column][tile] masses per bank
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
