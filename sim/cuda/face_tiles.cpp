// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/face_tiles.h"

#include <algorithm>
#include <array>
#include <random>

namespace mercury::cuda {
namespace {

constexpr std::size_t columns = 4;

using Banks = std::array<std::uint8_t, columns>;  // of a pair's four masses

Banks banks_of(const FacePair& p) {
  const auto bank = [](std::uint16_t slot) { return static_cast<std::uint8_t>(slot % lanes); };
  return {bank(p.a), bank(p.b), bank(p.c), bank(p.d)};
}

std::array<FacePair, 4> vertex_orders(const FacePair& p) {
  return {p, FacePair{p.c, p.d, p.a, p.b}, FacePair{p.a, p.d, p.c, p.b}, FacePair{p.c, p.b, p.a, p.d}};
}

// Deals pairs out to a fixed number of face tiles (min-conflicts, Minton et al. 1992). Each pair goes to the tile and
// vertex order with the fewest conflicts. Pairs that still conflict then move, again and again.
class FaceTiles {
 public:
  FaceTiles(std::span<const FacePair> pairs, std::size_t tiles)
      : banks_(pairs.size()), choices_(pairs.size()), tiles_(tiles) {
    for (std::size_t p = 0; p < pairs.size(); ++p) {
      const auto orders = vertex_orders(pairs[p]);
      for (std::size_t o = 0; o < orders.size(); ++o) banks_[p][o] = banks_of(orders[o]);
    }
    for (std::size_t p = 0; p < pairs.size(); ++p) insert(p);
  }

  // Moves pairs until no conflict is left, or until there were as many moves as pairs.
  void settle() {
    std::size_t moves = banks_.size();
    for (std::size_t p = 0, settled = 0; settled < banks_.size(); p = (p + 1) % banks_.size()) {
      ++settled;
      if (!in_conflict(p)) continue;
      if (moves-- == 0) return;
      settled = 0;
      count(p, -1);
      insert(p);
    }
  }

  std::vector<FacePair> in_order(std::span<const FacePair> pairs) const {
    std::vector<FacePair> ordered(tiles_.size() * lanes, padding_faces);
    std::vector<std::size_t> used(tiles_.size());
    for (std::size_t p = 0; p < pairs.size(); ++p) {
      const auto [tile, order] = choices_[p];
      ordered[tile * lanes + used[tile]++] = vertex_orders(pairs[p])[order];
    }
    return ordered;
  }

 private:
  struct Tile {
    std::array<std::array<std::uint8_t, lanes>, columns> uses{};  // by column and bank
    std::uint32_t size = 0;
  };
  struct Choice {
    std::size_t tile = 0, order = 0;
  };

  const Banks& banks(std::size_t p) const { return banks_[p][choices_[p].order]; }

  // Adds the pair to its tile's counts (by = 1) or removes it (by = -1).
  void count(std::size_t p, int by) {
    Tile& tile = tiles_[choices_[p].tile];
    for (std::size_t column = 0; column < columns; ++column) {
      std::uint8_t& uses = tile.uses[column][banks(p)[column]];
      uses = static_cast<std::uint8_t>(uses + by);
    }
    tile.size += static_cast<std::uint32_t>(by);
  }

  bool in_conflict(std::size_t p) const {
    const Tile& tile = tiles_[choices_[p].tile];
    for (std::size_t column = 0; column < columns; ++column)
      if (tile.uses[column][banks(p)[column]] > 1) return true;
    return false;
  }

  unsigned conflicts(std::size_t p, const Choice& choice) const {
    unsigned others = 0;
    for (std::size_t column = 0; column < columns; ++column)
      others += tiles_[choice.tile].uses[column][banks_[p][choice.order][column]];
    return others;
  }

  // Puts a pair where it has the fewest conflicts. The search starts at a random tile and ends without a conflict, or
  // after max_tried tiles if one of them had room.
  void insert(std::size_t p) {
    constexpr std::size_t max_tried = 64;
    unsigned fewest = ~0u;
    std::size_t tile = random_() % tiles_.size();
    for (std::size_t tried = 0; tried < tiles_.size() && fewest > 0; ++tried, tile = (tile + 1) % tiles_.size()) {
      if (tried >= max_tried && fewest != ~0u) break;
      if (tiles_[tile].size == lanes) continue;
      for (std::size_t order = 0; order < 4; ++order) {
        const unsigned others = conflicts(p, {tile, order});
        if (others >= fewest) continue;
        fewest = others;
        choices_[p] = {tile, order};
      }
    }
    count(p, 1);
  }

  std::vector<std::array<Banks, 4>> banks_;  // [pair][vertex order]
  std::vector<Choice> choices_;              // [pair]
  std::vector<Tile> tiles_;
  std::minstd_rand random_;
};

}  // namespace

// A vertex order can swap a with c and b with d, so each of these two sets has two columns to spread over.
std::uint32_t busiest_bank(std::span<const FacePair> pairs) {
  std::array<std::uint32_t, lanes> shared{}, outer{};
  for (const FacePair& p : pairs) {
    const Banks banks = banks_of(p);
    ++shared[banks[0]], ++shared[banks[2]];
    ++outer[banks[1]], ++outer[banks[3]];
  }
  std::uint32_t busiest = 0;
  for (std::uint32_t bank = 0; bank < lanes; ++bank) busiest = std::max({busiest, shared[bank], outer[bank]});
  return (busiest + 1) / 2;
}

std::vector<FacePair> make_face_tiles(std::span<const FacePair> pairs) {
  if (pairs.empty()) return {};
  FaceTiles tiles(pairs, (pairs.size() + lanes - 1) / lanes);
  tiles.settle();
  return tiles.in_order(pairs);
}

}  // namespace mercury::cuda
