// SPDX-License-Identifier: Apache-2.0
// The cost model of grouping: all numbers that decide which robots step together.
//
// They affect speed only; a robot's trajectory is the same in any group. The unit of time is one row: evaluating the
// springs of one entry of a lockstep group, one per lane, with 8 lanes and all data in the core's cache. The costs were
// measured with bench_cpu_springs.
#pragma once

#include <cstddef>
#include <cstdint>

#include "sim/cpu/layout/body.h"
#include "sim/cpu/layout/topology.h"

namespace mercury::cpu {

struct CostModel {
  // Per step of a lockstep group.            [rows]
  double entry = 1.0;      // one spring per lane
  double slot = 1.4;       // moving one mass per lane
  double face_pair = 3.0;  // one face pair per lane

  // Per step of a robot alone.               [rows]
  double body = 9.0;               // independent of its size
  double run = 0.9;                // a row of springs whose partners stand next to each other
  double gathered_row = 2.0;       // a row of other springs
  double tile = 4.5;               // moving one tile of masses
  double tile_with_springs = 5.0;  // the same if gathered rows need x_aos
  double tile_with_faces = 5.5;    // the same if faces need x_aos and v_aos
  double face_run = 2.5;           // one face pair per lane, whose corners stand side by side
  double face_tile = 8.5;          // the same with corners anywhere

  // The costs of a robot alone, times this.  [1]
  double few_lanes = 0.95;   // with fewer than 8 lanes
  double many_lanes = 1.15;  // with more than 8: gathering costs more

  // How robots are partitioned into groups (partition.h).
  double worth_of_size = 0.75;  // [1]: a robot that costs c rows joins a group as if it added 0.75 c rows less
  double min_gain = 0.5;        // [rows]: two groups exchange members only if both together gain more than this
};
inline constexpr CostModel costs;

struct GroupingLimits {
  // Search for similar robots.
  std::size_t robots_compared = 512;       // with one another
  std::size_t candidates_compared = 256;   // for each place in a group
  std::size_t items_distinguished = 4096;  // cells, springs and face pairs, of each at most
  std::size_t springs_per_robot = 128;     // on average; if there are more, cells stand for their springs
  std::size_t groups_in_reach = 8;         // for exchanges of members
  int exchange_rounds = 4;

  // Work batches.
  std::size_t batches_per_thread = 4;    // at least, so that the threads finish at about the same time
  std::size_t batch_bytes = 512 * 1024;  // what a step touches must stay in a core's own cache
  std::size_t batch_muscles = 4096;
  std::size_t factors_at_once = 16384;  // muscles times steps computed ahead; stays in the cache, too
  std::int64_t steps_at_once = 32;      // computed ahead
};
inline constexpr GroupingLimits limits;

// Costs of one step. `faces`: whether they give forces.
double cost_in_lockstep(const Topology& topology, bool faces);
double cost_alone(const Body& body, bool faces);        // from prepare_to_step_alone() on
double least_cost_alone(const Body& body, bool faces);  // no more than cost_alone()

// Bytes that a step of a group touches, and about those of a body alone.
std::size_t footprint(const Topology& topology, std::size_t lanes);
std::size_t footprint(const Body& body);

// Whether a group is small enough to be faster than its members alone: twice the cache of a core is the limit, since a
// group steps several times in a row.
bool fits_in_cache(const Topology& topology, std::size_t lanes);
// Whether a body is small enough to be a member.
bool fits_in_group(const Body& body);

// How many of the groups to keep. In the last round some threads have no group. If they are many, the groups of that
// round take longer than their members alone, who are about half as much work again but keep all threads busy.
std::size_t groups_worth_keeping(std::size_t groups, std::size_t threads);

}  // namespace mercury::cpu
