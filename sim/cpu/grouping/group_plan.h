// SPDX-License-Identifier: Apache-2.0
// Decides which robots step together as lockstep groups (layout/lockstep_group.h).
//
//   all bodies --> same topology? --> groups without padding
//                      | no
//                      v
//                  similar cells? --> partition.h --> merge_topologies() --> cheaper than alone? --> groups
//                      | no                                                     | no
//                      v                                                        v
//                    alone                                                    alone
//
// 1. Robots with the same topology fill all entries: any of them can step together.
// 2. Other robots are compared by the lattice cells of their masses. They share the slot of a cell. Poses are made
//    common first, unless faces give forces: the vertex order of a face pair depends on the pose, and pairs must match.
// 3. A group is kept if the cost model says that it is faster than its members alone, and if it leaves no thread idle.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "mercury/robot.h"
#include "mercury/work_watch.h"
#include "sim/cpu/layout/body.h"
#include "sim/cpu/layout/topology.h"

namespace mercury::cpu {

struct GroupPlan {
  std::vector<std::size_t> bodies;  // 1 to as many as there are lanes, by index in the span given
  MergedTopology merged;            // one index map per body
};

// Each body is in one plan at most; the others step alone.
std::vector<GroupPlan> plan_lockstep_groups(std::span<Body* const> bodies, std::size_t threads,
                                            const Configuration& configuration, const WorkWatch& watch = {});

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
struct Member {
  const Robot* robot;
  std::span<const FacePair> face_pairs;  // pair_faces(*robot)
  std::vector<std::uint32_t> slots;      // by mass, no two the same
};

// The smallest topology for these members, with this number of slots (at most max_masses).
MergedTopology merge_topologies(std::span<const Member> members, std::size_t slots);

}  // namespace mercury::cpu
