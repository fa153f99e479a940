// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/edge_colouring.h"

#include <algorithm>
#include <array>

namespace mercury::cuda {

EdgeColouring::EdgeColouring(std::span<const OwnedSpring> edges) : edges_(edges) {
  std::array<std::uint32_t, lanes> lane_degree{}, bank_degree{};
  for (const OwnedSpring& edge : edges) {
    colours_ = std::max(colours_, ++lane_degree[lane(edge)]);
    colours_ = std::max(colours_, ++bank_degree[bank(edge)]);
  }
  at_lane_.assign(std::size_t{lanes} * colours_, none);
  at_bank_.assign(std::size_t{lanes} * colours_, none);
  for (std::uint32_t e = 0; e < edges.size(); ++e) colour(e);
}

std::uint32_t EdgeColouring::free_colour(const std::vector<std::uint32_t>& at, std::uint32_t vertex) const {
  const auto first = at.begin() + static_cast<std::ptrdiff_t>(vertex * colours_);
  return static_cast<std::uint32_t>(std::find(first, first + colours_, none) - first);
}

void EdgeColouring::colour(std::uint32_t e) {
  const std::uint32_t u = lane(edges_[e]), v = bank(edges_[e]);
  for (std::uint32_t c = 0; c < colours_; ++c)
    if (at_lane(u, c) == none && at_bank(v, c) == none) return assign(e, c);
  const std::uint32_t free_at_lane = free_colour(at_lane_, u), free_at_bank = free_colour(at_bank_, v);
  swap_path(v, free_at_lane, free_at_bank);
  assign(e, free_at_lane);
}

void EdgeColouring::assign(std::uint32_t e, std::uint32_t colour) {
  at_lane(lane(edges_[e]), colour) = e;
  at_bank(bank(edges_[e]), colour) = e;
}

// Exchanges two colours along the path that leaves the bank by `wanted`, which frees `wanted` at the bank.
void EdgeColouring::swap_path(std::uint32_t first_bank, std::uint32_t wanted, std::uint32_t other) {
  path_.clear();
  bool from_bank = true;
  for (std::uint32_t vertex = first_bank, c = wanted;; c = c == wanted ? other : wanted, from_bank = !from_bank) {
    const std::uint32_t e = from_bank ? at_bank(vertex, c) : at_lane(vertex, c);
    if (e == none) break;
    path_.push_back(e);
    vertex = from_bank ? lane(edges_[e]) : bank(edges_[e]);
  }
  // Two passes: an entry that the path has already given to the next edge must not be cleared.
  std::uint32_t c = wanted;
  for (const std::uint32_t e : path_) {
    if (at_lane(lane(edges_[e]), c) == e) at_lane(lane(edges_[e]), c) = none;
    if (at_bank(bank(edges_[e]), c) == e) at_bank(bank(edges_[e]), c) = none;
    c = c == wanted ? other : wanted;
  }
  c = other;
  for (const std::uint32_t e : path_) {
    assign(e, c);
    c = c == wanted ? other : wanted;
  }
}

}  // namespace mercury::cuda
