// SPDX-License-Identifier: Apache-2.0
// Merges the topologies of several robots into one that has room for all of them.
//
//   robot A     robot B     merged        entry   A in lane 0   B in lane 1
//
//   0 --- 1     0 --- 1     0 --- 1       0-1     spring        spring
//   |               / |     |   / |       0-2     spring        padding
//   2             2   3     2     3       1-2     padding       spring
//                                         1-3     padding       spring
//
// Springs (or face pairs) of different robots between the same slots share an entry (or a face tile). Two springs of
// one robot between the same slots have an entry each.
#pragma once

#include <span>
#include <vector>

#include "mercury/robot.h"
#include "sim/cpu/layout/topology.h"

namespace mercury::cpu {

struct Member {
  const Robot* robot;
  std::span<const FacePair> face_pairs;  // pair_faces(*robot)
  std::vector<std::uint32_t> slots;      // by mass, no two the same
};

// The smallest topology for these members, with this number of slots (at most max_masses).
MergedTopology merge_topologies(std::span<const Member> members, std::size_t slots);

}  // namespace mercury::cpu
