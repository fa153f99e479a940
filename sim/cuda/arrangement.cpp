// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/arrangement.h"

#include <oneapi/tbb/parallel_for.h>

#include <unordered_map>

namespace mercury::cuda {
namespace {

std::vector<FacePair> in_slots(std::span<const FacePair> pairs, const SlotOrder& order) {
  const auto slot = [&](std::uint16_t mass) { return static_cast<std::uint16_t>(order.slot_of(mass)); };
  std::vector<FacePair> moved;
  for (const FacePair& p : pairs) moved.push_back({slot(p.a), slot(p.b), slot(p.c), slot(p.d)});
  return moved;
}

std::vector<Spring> in_slots(std::span<const Spring> springs, const SlotOrder& order) {
  std::vector<Spring> moved(springs.begin(), springs.end());
  for (Spring& s : moved) {
    s.a = static_cast<std::uint16_t>(order.slot_of(s.a));
    s.b = static_cast<std::uint16_t>(order.slot_of(s.b));
  }
  return moved;
}

}  // namespace

// Tries a few shifts and takes the one that spreads the corners of the faces over the banks most evenly.
Arrangement arrange(const Robot& robot) {
  const auto masses = static_cast<std::uint32_t>(robot.masses.size());
  const std::vector<FacePair> pairs = pair_faces(robot);
  SlotOrder best{masses, 0};
  std::vector<FacePair> best_pairs;
  std::uint32_t fewest_passes = ~0u;
  for (const std::uint32_t shift : {0u, 5u, 13u}) {
    const SlotOrder order{masses, shift};
    std::vector<FacePair> moved = in_slots(pairs, order);
    const std::uint32_t passes = busiest_bank(moved);
    if (passes >= fewest_passes) continue;
    fewest_passes = passes;
    best = order;
    best_pairs = std::move(moved);
  }
  return {best, schedule_springs(masses, in_slots(robot.springs, best)), make_face_tiles(best_pairs)};
}

std::vector<std::uint32_t> first_of_topology(std::span<const Robot* const> robots) {
  std::vector<std::uint64_t> keys(robots.size());
  oneapi::tbb::parallel_for(std::size_t{0}, robots.size(), [&](std::size_t i) { keys[i] = topology_key(*robots[i]); });
  std::unordered_map<std::uint64_t, std::uint32_t> first_of_key;
  for (std::uint32_t i = 0; i < robots.size(); ++i) first_of_key.try_emplace(keys[i], i);
  std::vector<std::uint32_t> first(robots.size());
  oneapi::tbb::parallel_for(std::size_t{0}, robots.size(), [&](std::size_t i) {
    const std::uint32_t candidate = first_of_key.at(keys[i]);
    first[i] = same_topology(*robots[candidate], *robots[i]) ? candidate : static_cast<std::uint32_t>(i);
  });
  return first;
}

}  // namespace mercury::cuda
