// SPDX-License-Identifier: Apache-2.0
#include "sim/cpu/layout/near_pairs.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/physics/springs.h"

namespace mercury::cpu {

NearPairs::NearPairs(const Robot& robot, const Slots& slots) : masses_(slots.of_mass), lanes_(slots.lanes) {
  start_.assign(slots.mass_at.size() + 1, 0);
  for (const Spring& spring : robot.springs) {
    ++start_[slots.of_mass[spring.a] + 1];
    ++start_[slots.of_mass[spring.b] + 1];
  }
  for (std::size_t i = 0; i + 1 < start_.size(); ++i) start_[i + 1] += start_[i];
  joined_.resize(start_.back());
  std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
  for (const Spring& spring : robot.springs) {
    const std::uint32_t a = slots.of_mass[spring.a], b = slots.of_mass[spring.b];
    joined_[next[a]++] = b;
    joined_[next[b]++] = a;
  }
}

bool NearPairs::joined(std::uint32_t i, std::uint32_t j) const {
  return std::find(joined_.begin() + start_[i], joined_.begin() + start_[i + 1], j) != joined_.begin() + start_[i + 1];
}

// Masses sorted by cell, x fastest. Cells are at least one radius wide, so that near masses are in neighboring cells.
struct NearPairs::Grid {
  std::array<std::uint32_t, 3> size{1, 1, 1};
  std::vector<std::uint32_t> start, sorted;
  std::vector<std::array<std::uint32_t, 3>> cell;  // of each element of `sorted`

  std::uint32_t index(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
    return x + size[0] * (y + size[1] * z);
  }

  Grid(std::span<const std::uint32_t> masses, const std::array<std::span<const float>, 3>& x, float radius) {
    std::array<float, 3> low, inverse;
    float edge = 1.001f * radius;  // pairs within one radius lie in neighboring cells, also after rounding
    std::array<float, 3> extent;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      float high = low[axis] = x[axis][masses[0]];
      for (const std::uint32_t i : masses) {
        low[axis] = std::min(low[axis], x[axis][i]);
        high = std::max(high, x[axis][i]);
      }
      extent[axis] = high - low[axis];
    }
    // Bounds the number of cells, however far apart the masses are.
    const auto cells_across = [&](std::size_t axis) { return std::floor(extent[axis] / edge) + 1; };
    const auto most = static_cast<float>(64 + 4 * masses.size());
    while (cells_across(0) * cells_across(1) * cells_across(2) > most) edge *= 1.5f;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      size[axis] = static_cast<std::uint32_t>(cells_across(axis));
      inverse[axis] = 1 / edge;
    }
    const auto coordinate = [&](std::size_t axis, std::uint32_t i) {
      return std::min(static_cast<std::uint32_t>((x[axis][i] - low[axis]) * inverse[axis]), size[axis] - 1);
    };
    start.assign(std::size_t{size[0]} * size[1] * size[2] + 1, 0);
    std::vector<std::array<std::uint32_t, 3>> of_mass;
    for (const std::uint32_t i : masses) {
      of_mass.push_back({coordinate(0, i), coordinate(1, i), coordinate(2, i)});
      const auto [cx, cy, cz] = of_mass.back();
      ++start[index(cx, cy, cz) + 1];
    }
    for (std::size_t c = 0; c + 1 < start.size(); ++c) start[c + 1] += start[c];
    sorted.resize(masses.size());
    cell.resize(masses.size());
    std::vector<std::uint32_t> next(start.begin(), start.end() - 1);
    for (std::size_t m = 0; m < masses.size(); ++m) {
      const auto [cx, cy, cz] = of_mass[m];
      const std::uint32_t position = next[index(cx, cy, cz)]++;
      sorted[position] = masses[m];
      cell[position] = of_mass[m];
    }
  }
};

void NearPairs::add_near_of(const Grid& grid, std::uint32_t i, std::uint32_t first, std::uint32_t last,
                            float squared_radius) {
  for (std::uint32_t n = first; n < last; ++n) {
    const std::uint32_t j = grid.sorted[n];
    const Vec3 d{x_[j] - x_[i], y_[j] - y_[i], z_[j] - z_[i]};
    if (squared_length(d) < squared_radius && !joined(i, j)) pairs_.push_back({i, j});
  }
}

std::span<const std::uint8_t> NearPairs::candidates() {
  if (!candidates_.empty()) return candidates_;
  const std::size_t bytes = bytes_per_tile(lanes_), row = (start_.size() - 1) / lanes_ * bytes;
  constexpr std::size_t read_beyond = 8;  // vector code reads whole words
  candidates_.resize((start_.size() - 1) * row + read_beyond);
  const auto byte_of = [&](std::uint32_t j) { return j / lanes_ * bytes + j % lanes_ / 8; };
  const auto bit_of = [&](std::uint32_t j) { return static_cast<std::uint8_t>(1u << j % lanes_ % 8); };
  std::vector<std::uint8_t> later(row);  // bits of the masses after mass i
  for (const std::uint32_t j : masses_) later[byte_of(j)] |= bit_of(j);
  for (std::uint32_t i = 0; i + 1 < start_.size(); ++i) {
    if ((later[byte_of(i)] & bit_of(i)) == 0) continue;  // padding
    later[byte_of(i)] ^= bit_of(i);
    std::uint8_t* const own = candidates_.data() + i * row;
    std::ranges::copy(later, own);
    for (std::uint32_t n = start_[i]; n < start_[i + 1]; ++n)
      own[byte_of(joined_[n])] &= static_cast<std::uint8_t>(~bit_of(joined_[n]));
  }
  return candidates_;
}

void NearPairs::start(std::span<const float> x, std::span<const float> y, std::span<const float> z) {
  x_.assign(x.begin(), x.end());
  y_.assign(y.begin(), y.end());
  z_.assign(z.begin(), z.end());
  pairs_.clear();
  listed_ = true;
  ++searches_;
}

void NearPairs::search_grid(std::span<const float> x, std::span<const float> y, std::span<const float> z,
                            float contact_distance) {
  start(x, y, z);
  const float radius = list_radius * contact_distance;
  const Grid grid(masses_, {x, y, z}, radius);
  for (std::uint32_t n = 0; n < grid.sorted.size(); ++n) {
    const auto [cx, cy, cz] = grid.cell[n];
    const std::uint32_t low = cx == 0 ? 0 : cx - 1, high = std::min(cx + 1, grid.size[0] - 1);
    add_near_of(grid, grid.sorted[n], n + 1, grid.start[grid.index(high, cy, cz) + 1], radius * radius);
    // The four rows that come later, as (y, z).
    constexpr std::array<std::array<int, 2>, 4> later{{{1, 0}, {-1, 1}, {0, 1}, {1, 1}}};
    for (const auto& [dy, dz] : later) {
      const std::uint32_t ry = cy + static_cast<std::uint32_t>(dy), rz = cz + static_cast<std::uint32_t>(dz);
      if (ry >= grid.size[1] || rz >= grid.size[2]) continue;  // -1 wraps around to a large number
      add_near_of(grid, grid.sorted[n], grid.start[grid.index(low, ry, rz)], grid.start[grid.index(high, ry, rz) + 1],
                  radius * radius);
    }
  }
}

}  // namespace mercury::cpu
