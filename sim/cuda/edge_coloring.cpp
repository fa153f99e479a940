// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/edge_coloring.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace mercury::cuda {
namespace {

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
  EdgeColoring(std::span<const OwnedSpring> springs, std::span<const std::uint32_t> row_start)
      : springs_(springs), row_start_(row_start), words_(one_word ? 1 : words_of_colors(row_start)),
        entries_(std::size_t{row_start.back()} * lanes), lane_at_bank_(entries_.size(), no_lane) {
    const auto tiles = static_cast<std::uint32_t>(row_start.size() - 1);
    free_.resize(std::size_t{tiles} * 2 * lanes * words_);
    for (std::uint32_t tile = 0; tile < tiles; ++tile)
      for (std::uint32_t vertex = 0; vertex < 2 * lanes; ++vertex)
        free_all(tile * 2 * lanes + vertex, row_start[tile + 1] - row_start[tile]);
    // Neighbors often share a lane, and would wait for each other. So the halves take turns.
    const auto half = static_cast<std::uint32_t>(springs.size() / 2);
    for (std::uint32_t i = 0; i < half; ++i) color(i), color(half + i);
    if (springs.size() % 2 != 0) color(2 * half);
  }

  std::vector<ScheduledSpring> take() { return std::move(entries_); }

 private:
  static constexpr std::uint8_t no_lane = 0xff;
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
    const std::uint32_t tile = s.owner / lanes, first_lane = tile * 2 * lanes, first_bank = first_lane + lanes;
    const std::uint32_t lane = s.owner % lanes, bank = s.partner % lanes;
    const std::uint32_t c = common_color(first_lane + lane, first_bank + bank);
    if (c == no_color) return exchange_path(tile, lane, {i, s.partner});
    flip(first_lane + lane, c);
    flip(first_bank + bank, c);
    const std::size_t row = (row_start_[tile] + c) * std::size_t{lanes};
    entries_[row + lane] = {i, s.partner};
    lane_at_bank_[row + bank] = static_cast<std::uint8_t>(lane);
  }

  // Gives an edge a color p that is free at its lane. Along the path, each edge that has p gives way and takes q, and
  // each edge that has q gives way in turn and takes p.
  void exchange_path(std::uint32_t tile, std::uint32_t lane, ScheduledSpring edge) {
    const std::uint32_t first_lane = tile * 2 * lanes, first_bank = first_lane + lanes;
    std::uint32_t bank = edge.partner % lanes;
    const std::uint32_t p = common_color(first_lane + lane, first_lane + lane);
    const std::uint32_t q = common_color(first_bank + bank, first_bank + bank);
    const std::size_t row_p = (row_start_[tile] + p) * std::size_t{lanes};
    const std::size_t row_q = (row_start_[tile] + q) * std::size_t{lanes};
    flip(first_lane + lane, p);
    flip(first_bank + bank, q);
    while (true) {  // `edge` takes p at its lane, where p is free
      entries_[row_p + lane] = edge;
      const std::uint8_t other = std::exchange(lane_at_bank_[row_p + bank], static_cast<std::uint8_t>(lane));
      if (other == no_lane) {  // the bank had the edge by q, and has it by p now
        flip(first_bank + bank, p);
        flip(first_bank + bank, q);
        lane_at_bank_[row_q + bank] = no_lane;
        return;
      }
      // At the bank q is free now, at the lane of the other edge p.
      lane_at_bank_[row_q + bank] = other;
      lane = other;
      edge = std::exchange(entries_[row_q + lane], entries_[row_p + lane]);
      if (edge.spring == padding) {
        entries_[row_p + lane] = {};
        flip(first_lane + lane, p);
        flip(first_lane + lane, q);
        return;
      }
      bank = edge.partner % lanes;
    }
  }

  const std::span<const OwnedSpring> springs_;
  const std::span<const std::uint32_t> row_start_;
  const std::uint32_t words_;               // of a set of colors
  std::vector<std::uint64_t> free_;         // [tile][lane or bank][word], a bit per color
  std::vector<ScheduledSpring> entries_;    // [row][lane]
  std::vector<std::uint8_t> lane_at_bank_;  // [row][bank]
};

}  // namespace

std::vector<ScheduledSpring> color_springs(std::span<const OwnedSpring> springs,
                                           std::span<const std::uint32_t> row_start) {
  if (words_of_colors(row_start) == 1) return EdgeColoring<true>(springs, row_start).take();
  return EdgeColoring<false>(springs, row_start).take();
}

}  // namespace mercury::cuda
