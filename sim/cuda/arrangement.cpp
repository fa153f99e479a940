// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/arrangement.h"

#include <algorithm>
#include <unordered_map>
#include <utility>

#include "mercury/parallel.h"
#include "sim/physics/fixed_point.h"

namespace mercury::cuda {
namespace {

std::vector<OwnedSpring> in_slots(std::span<const Spring> springs, std::span<const std::uint16_t> slot) {
  std::vector<OwnedSpring> moved;
  moved.reserve(springs.size());
  for (const Spring& s : springs) moved.push_back({slot[s.a], slot[s.b]});
  return moved;
}

// The largest distance of two masses is at most this [m].
float diameter_bound(const Robot& robot) {
  Vec3 low = robot.masses.front(), high = low;
  for (const Vec3 x : robot.masses) {
    low = {std::min(low.x, x.x), std::min(low.y, x.y), std::min(low.z, x.z)};
    high = {std::max(high.x, x.x), std::max(high.y, x.y), std::max(high.z, x.z)};
  }
  return length(high - low);
}

// Padding that is longer than springs may be makes the kernel measure again without it (SpringPass). In robots so large
// that it could be, padding with a partner too far away reads its owner instead, though the bank may be in use.
void shorten_padding(Schedule& schedule, const Robot& robot, const SlotOrder& order) {
  constexpr float share = 0.75f;  // of the limit, so that it may stretch
  const float diameter = diameter_bound(robot);
  float limit = 0;
  for (const Spring& spring : robot.springs) {
    limit = std::max(limit, share * stretch_limit * spring.rest_length);
    if (diameter <= limit) return;
  }
  const std::vector<std::uint16_t> masses = order.masses();
  for (std::uint32_t tile = 0; tile < schedule.tiles(); ++tile)
    for (std::uint32_t i = schedule.row_start[tile] * lanes; i < schedule.row_start[tile + 1] * lanes; ++i) {
      ScheduledSpring& entry = schedule.entries[i];
      const std::uint32_t owner = tile * lanes + i % lanes;
      if (entry.spring != padding || owner >= masses.size()) continue;
      const Vec3 d = robot.masses[masses[owner]] - robot.masses[masses[entry.partner]];
      if (dot(d, d) <= limit * limit) continue;
      --schedule.incoming_counts[entry.partner];
      ++schedule.incoming_counts[owner];
      entry.partner = static_cast<std::uint16_t>(owner);
    }
}

}  // namespace

Arrangement arrange(const Robot& robot, std::span<const FacePair> pairs, std::uint32_t ghosts) {
  auto order = std::make_shared<const SlotOrder>(choose_slots(robot, pairs, ghosts));
  Schedule schedule = schedule_springs(robot.masses.size() - ghosts, in_slots(robot.springs, order->slots), ghosts);
  shorten_padding(schedule, robot, *order);
  std::vector<FacePair> faces = make_face_tiles(order->placed(pairs));
  return {std::move(order), std::move(schedule), std::move(faces)};
}

std::vector<std::uint32_t> first_of_topology(std::span<const Robot* const> robots) {
  std::vector<std::uint64_t> keys(robots.size());
  const auto is_repeated = [&](std::size_t i) { return i > 0 && robots[i] == robots[i - 1]; };
  parallel_for(0, robots.size(), [&](std::size_t i) {
    if (!is_repeated(i)) keys[i] = topology_key(*robots[i]);
  });
  for (std::size_t i = 0; i < robots.size(); ++i)
    if (is_repeated(i)) keys[i] = keys[i - 1];
  return first_of_topology(robots, keys);
}

std::vector<std::uint32_t> first_of_topology(std::span<const Robot* const> robots,
                                             std::span<const std::uint64_t> keys) {
  std::unordered_map<std::uint64_t, std::uint32_t> first_of_key;
  for (std::uint32_t i = 0; i < robots.size(); ++i) first_of_key.try_emplace(keys[i], i);
  std::vector<std::uint32_t> first(robots.size());
  parallel_for(0, robots.size(), [&](std::size_t i) {
    const std::uint32_t candidate = first_of_key.at(keys[i]);
    const bool same = robots[candidate] == robots[i] || same_topology(*robots[candidate], *robots[i]);
    first[i] = same ? candidate : static_cast<std::uint32_t>(i);
  });
  return first;
}

}  // namespace mercury::cuda
