// SPDX-License-Identifier: Apache-2.0
// Partitions robots into groups whose members have most in common, so that few lanes of a lockstep group are padding.
//
// 1. A robot is a set of items: the lattice cells that its masses are in, its springs and its face pairs, each named by
//    cells. What a group costs is the union of its members' sets, by the cost model.
// 2. Greedy: the largest robot left starts a group; those that add least to the union join, large ones rather than
// small
//    ones.
// 3. Exchange: groups next to each other in size exchange members as long as that makes both together cheaper.
//
// Sets are bit vectors with one bit for each item that at least two robots have: costs are population counts.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "mercury/robot.h"
#include "mercury/work_watch.h"
#include "sim/cpu/layout/lattice_cells.h"
#include "sim/physics/face_pairs.h"

namespace mercury::cpu {

struct RobotItems {
  std::span<const LatticeCell> cells;  // by mass
  std::span<const Spring> springs;
  std::span<const FacePair> face_pairs;  // empty if they give no force
};

// Groups of robots, by index. All have `group_size` members, except the last group of every
// GroupingLimits::robots_compared robots.
std::vector<std::vector<std::size_t>> partition_by_similarity(std::span<const RobotItems> robots,
                                                              std::size_t group_size, const WorkWatch& watch = {});

}  // namespace mercury::cpu
