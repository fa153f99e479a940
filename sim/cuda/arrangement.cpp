// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/arrangement.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <unordered_map>
#include <utility>

namespace mercury::cuda {
namespace {

std::vector<std::uint16_t> slots_of_masses(const SlotOrder& order) {
  std::vector<std::uint16_t> slots(order.masses);
  order.for_each_run([&](std::uint32_t mass, std::uint32_t slot, std::uint32_t count) {
    for (std::uint32_t i = 0; i < count; ++i) slots[mass + i] = static_cast<std::uint16_t>(slot + i);
  });
  return slots;
}

// Tries a few shifts and returns the one that spreads the corners of the faces over the banks most evenly.
std::uint32_t best_shift(std::uint32_t masses, std::span<const FacePair> pairs) {
  std::vector<std::uint32_t> shared(masses), outer(masses);  // how often each mass is a or c, b or d
  for (const FacePair& p : pairs) {
    ++shared[p.a], ++shared[p.c];
    ++outer[p.b], ++outer[p.d];
  }
  std::uint32_t best = 0, fewest_passes = ~0u;
  for (const std::uint32_t shift : {0u, 1u, 2u, 3u, 5u, 6u, 7u, 13u, 16u, 25u, 27u, 29u}) {
    CornerBanks banks;
    SlotOrder{masses, shift}.for_each_run([&](std::uint32_t mass, std::uint32_t slot, std::uint32_t count) {
      for (std::uint32_t i = 0; i < count; ++i) banks.shared[slot % lanes + i] += shared[mass + i];
      for (std::uint32_t i = 0; i < count; ++i) banks.outer[slot % lanes + i] += outer[mass + i];
    });
    const std::uint32_t passes = banks.fewest_passes(pairs.size());
    if (passes < fewest_passes) best = shift, fewest_passes = passes;
  }
  return best;
}

}  // namespace

Arrangement arrange(const Robot& robot) {
  const auto masses = static_cast<std::uint32_t>(robot.masses.size());
  std::vector<FacePair> pairs = pair_faces(robot);
  const SlotOrder order{masses, best_shift(masses, pairs)};
  const std::vector<std::uint16_t> slot = slots_of_masses(order);
  for (FacePair& p : pairs) p = {slot[p.a], slot[p.b], slot[p.c], slot[p.d]};
  std::vector<OwnedSpring> springs;
  springs.reserve(robot.springs.size());
  for (const Spring& s : robot.springs) springs.push_back({slot[s.a], slot[s.b]});
  return {order, schedule_springs(masses, std::move(springs)), make_face_tiles(pairs)};
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
