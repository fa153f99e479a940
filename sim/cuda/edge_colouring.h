// SPDX-License-Identifier: Apache-2.0
// Colours the springs of one tile so that springs of one colour share neither a lane nor a bank. A colour becomes a
// row.
//
// The springs are the edges of a bipartite graph: on one side the 32 lanes of the owners, on the other the 32 banks of
// the partners.
//
//   lanes      0    1    2   ...  31          spring: owner's lane -> partner's bank
//              | \  |  / |         |          edges that meet at a lane: the lane computes one spring per row
//              |  \ | /  |         |          edges that meet at a bank: one access per row and bank
//   banks      0    1    2   ...  31
//
// 1. Such a graph can be coloured with as many colours as the busiest vertex has edges (Koenig's theorem). No
//    schedule has fewer rows.
// 2. An edge takes the first colour that is free at both ends. If there is none, some colour `p` is free at its lane
//    and some other colour `q` at its bank. Exchanging p and q along the path of edges coloured p, q, p, ... that
//    starts at the bank frees p at the bank too. The path never ends at the lane, because it enters lanes by edges of
//    colour p.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/cuda/spring_owners.h"

namespace mercury::cuda {

class EdgeColouring {
 public:
  // `edges` = the springs of one tile; the span must outlive this object.
  explicit EdgeColouring(std::span<const OwnedSpring> edges);

  std::uint32_t colours() const { return colours_; }
  // The index of a lane's edge of this colour, or none.
  static constexpr std::uint32_t none = 0xffffffffu;
  std::uint32_t edge_at(std::uint32_t lane, std::uint32_t colour) const { return at_lane_[lane * colours_ + colour]; }

 private:
  static std::uint32_t lane(const OwnedSpring& edge) { return edge.owner % lanes; }
  static std::uint32_t bank(const OwnedSpring& edge) { return edge.partner % lanes; }
  std::uint32_t& at_lane(std::uint32_t lane, std::uint32_t colour) { return at_lane_[lane * colours_ + colour]; }
  std::uint32_t& at_bank(std::uint32_t bank, std::uint32_t colour) { return at_bank_[bank * colours_ + colour]; }

  std::uint32_t free_colour(const std::vector<std::uint32_t>& at, std::uint32_t vertex) const;
  void colour(std::uint32_t e);
  void assign(std::uint32_t e, std::uint32_t colour);
  void swap_path(std::uint32_t bank, std::uint32_t wanted, std::uint32_t other);

  std::span<const OwnedSpring> edges_;
  std::uint32_t colours_ = 0;
  std::vector<std::uint32_t> at_lane_, at_bank_;  // [vertex][colour], the edge or none
  std::vector<std::uint32_t> path_;
};

}  // namespace mercury::cuda
