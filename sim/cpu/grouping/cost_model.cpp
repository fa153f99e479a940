// SPDX-License-Identifier: Apache-2.0
#include "sim/cpu/grouping/cost_model.h"

#include <unistd.h>

#include <algorithm>

namespace mercury::cpu {
namespace {

std::size_t cache_of_a_core() {
  constexpr std::size_t min_bytes = 256 * 1024;
#ifdef _SC_LEVEL2_CACHE_SIZE
  if (const long bytes = sysconf(_SC_LEVEL2_CACHE_SIZE); bytes > 0)
    return std::max(min_bytes, static_cast<std::size_t>(bytes));
#endif
  return min_bytes;
}
const std::size_t max_group_bytes = 2 * cache_of_a_core();

std::size_t footprint(std::size_t entries, std::size_t slots, std::size_t lanes) {
  return lanes * (entries * (2 * sizeof(float) + sizeof(FactorId)) + slots * 9 * sizeof(float));
}

double factor_of_lanes(std::size_t lanes) { return lanes > 8 ? costs.many_lanes : lanes < 8 ? costs.few_lanes : 1.0; }

}  // namespace

double cost_in_lockstep(const Topology& topology, bool faces) {
  return costs.entry * static_cast<double>(topology.partners.size()) +
         costs.slot * static_cast<double>(topology.slots.size()) +
         (faces ? costs.face_pair * static_cast<double>(topology.face_pairs.size()) : 0.0);
}

double cost_alone(const Body& body, bool faces) {
  const SpringSchedule& schedule = body.springs;
  const std::size_t lanes = body.slots.lanes;
  const double per_tile = faces                          ? costs.tile_with_faces
                          : schedule.has_gathered_rows() ? costs.tile_with_springs
                                                         : costs.tile;
  const double cost = costs.body + costs.run * static_cast<double>(schedule.runs.size()) +
                      costs.gathered_row * static_cast<double>(schedule.partners.size() / lanes) +
                      per_tile * static_cast<double>(body.slots.tiles()) +
                      (faces ? costs.face_run * static_cast<double>(body.faces.runs.size()) +
                                   costs.face_tile * static_cast<double>(body.faces.gathered_tiles(lanes))
                             : 0.0);
  return factor_of_lanes(lanes) * cost;
}

// As if all springs and faces were in full runs.
double least_cost_alone(const Body& body, bool faces) {
  const std::size_t lanes = body.slots.lanes;
  const auto rows = [&](std::size_t items) { return static_cast<double>((items + lanes - 1) / lanes); };
  const double cost = costs.body + costs.run * rows(body.robot->springs.size()) +
                      (faces ? costs.tile_with_faces : costs.tile) * static_cast<double>(body.slots.tiles()) +
                      (faces ? costs.face_run * rows(body.face_pairs.size()) : 0.0);
  return factor_of_lanes(lanes) * cost;
}

std::size_t footprint(const Topology& topology, std::size_t lanes) {
  return footprint(topology.partners.size(), topology.slots.size(), lanes);
}

std::size_t footprint(const Body& body) {
  return body.springs.rest_length.size() * (2 * sizeof(float) + sizeof(FactorId)) +
         body.springs.partners.size() * sizeof(std::uint32_t) + body.faces.runs.size() * sizeof(FaceSchedule::Run) +
         body.faces.tiles.size() * sizeof(std::uint32_t) + body.slots.size_with_spare() * 32 * sizeof(float);
}

bool fits_in_cache(const Topology& topology, std::size_t lanes) {
  return footprint(topology, lanes) <= max_group_bytes;
}

bool fits_in_group(const Body& body) {
  return body.status.exploded_step < 0 && !body.own &&
         footprint(body.robot->springs.size(), body.robot->masses.size(), body.slots.lanes) <= max_group_bytes;
}

std::size_t groups_worth_keeping(std::size_t groups, std::size_t threads) {
  const std::size_t in_last_round = groups % threads;
  return groups < limits.batches_per_thread * threads && 3 * in_last_round < 2 * threads ? groups - in_last_round
                                                                                         : groups;
}

}  // namespace mercury::cpu
