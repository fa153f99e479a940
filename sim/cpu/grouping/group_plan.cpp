// SPDX-License-Identifier: Apache-2.0
#include "sim/cpu/grouping/group_plan.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

#include "mercury/parallel.h"
#include "mercury/work_counter.h"
#include "sim/cpu/grouping/cost_model.h"
#include "sim/cpu/grouping/partition.h"

namespace mercury::cpu {
namespace {

using Group = std::vector<std::size_t>;

bool have_same_topology(const Body& a, const Body& b) {
  return a.topology_key == b.topology_key && same_topology(*a.robot, *b.robot) && a.face_pairs == b.face_pairs;
}

// Takes groups of robots with the same topology from `left`, if at least three quarters of their lanes have a member.
std::vector<Group> groups_of_same_topology(std::span<Body* const> bodies, Group& left) {
  std::ranges::stable_sort(left, {}, [&](std::size_t i) { return bodies[i]->topology_key; });
  std::vector<Group> groups;
  Group others;
  for (auto first = left.begin(); first != left.end();) {
    const std::size_t lanes = bodies[*first]->slots.lanes;
    auto last = first + 1;
    while (last != left.end() && static_cast<std::size_t>(last - first) < lanes &&
           have_same_topology(*bodies[*first], *bodies[*last]))
      ++last;
    if (4 * static_cast<std::size_t>(last - first) >= 3 * lanes)
      groups.emplace_back(first, last);
    else
      others.insert(others.end(), first, last);
    first = last;
  }
  left = std::move(others);
  return groups;
}

// Lattice cells by body and mass; empty for bodies that take part in no group of similar robots.
using Patterns = std::vector<std::vector<LatticeCell>>;

Patterns patterns_of(std::span<Body* const> bodies, std::span<const std::size_t> wanted, bool faces) {
  Patterns patterns(bodies.size());
  parallel_for(0, wanted.size(), [&](std::size_t w) {
    const std::vector<LatticeCell>& cells = bodies[wanted[w]]->cells;
    patterns[wanted[w]] = faces || cells.empty() ? cells : in_common_pose(cells);
  });
  return patterns;
}

std::vector<Group> groups_of_similar(std::span<Body* const> bodies, const Patterns& patterns,
                                     std::span<const std::size_t> left, bool faces, const WorkWatch& watch) {
  Group candidates;
  std::ranges::copy_if(left, std::back_inserter(candidates), [&](std::size_t i) { return !patterns[i].empty(); });
  if (candidates.empty()) return {};
  std::vector<RobotItems> robots;
  for (const std::size_t i : candidates) {
    robots.push_back({patterns[i], bodies[i]->robot->springs, {}});
    if (faces) robots.back().face_pairs = bodies[i]->face_pairs;
  }
  std::vector<Group> groups = partition_by_similarity(robots, bodies[candidates.front()]->slots.lanes, watch);
  for (Group& group : groups)
    for (std::size_t& robot : group) robot = candidates[robot];
  return groups;
}

GroupPlan plan_same_topology(std::span<Body* const> bodies, Group group) {
  const Body& first = *bodies[group.front()];
  std::vector<std::uint32_t> slots(first.robot->masses.size());
  std::iota(slots.begin(), slots.end(), 0u);
  const Member member{first.robot, first.face_pairs, slots};
  GroupPlan plan{std::move(group), merge_topologies({&member, 1}, slots.size())};
  plan.merged.index_maps.resize(plan.bodies.size(), plan.merged.index_maps.front());
  return plan;
}

// Reorders members so that more face pairs are in one half of them only: two such pairs share a split face tile.
void maximize_split_face_tiles(GroupPlan& plan) {
  std::vector<std::shared_ptr<const IndexMap>>& index_maps = plan.merged.index_maps;
  const std::size_t members = plan.bodies.size(), half = members / 2;
  std::vector<std::uint64_t> members_of_pair(plan.merged.topology->face_pairs.size());  // one bit per index in `order`
  for (std::size_t m = 0; m < members; ++m)
    for (const std::uint32_t pair : index_maps[m]->face_pairs) members_of_pair[pair] |= std::uint64_t{1} << m;
  std::vector<std::size_t> order(members);
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto split_tiles = [&] {
    std::uint64_t in_lower = 0;
    for (std::size_t m = 0; 2 * m < members; ++m) in_lower |= std::uint64_t{1} << order[m];
    std::size_t lower = 0, upper = 0;
    for (const std::uint64_t pair : members_of_pair) {
      lower += (pair & ~in_lower) == 0;
      upper += (pair & in_lower) == 0;
    }
    return std::min(lower, upper);
  };
  std::size_t most = split_tiles();
  for (std::size_t i = 0; i < half; ++i)
    for (std::size_t j = half; j < members; ++j) {
      std::swap(order[i], order[j]);
      if (const std::size_t now = split_tiles(); now > most)
        most = now;
      else
        std::swap(order[i], order[j]);
    }
  const GroupPlan before = plan;
  for (std::size_t m = 0; m < members; ++m) {
    plan.bodies[m] = before.bodies[order[m]];
    index_maps[m] = before.merged.index_maps[order[m]];
  }
}

// Slots are the cells in which any member has a mass, in the order z, y, x.
GroupPlan plan_similar(std::span<Body* const> bodies, const Patterns& patterns, Group group) {
  constexpr std::uint32_t none = 0xffffffffu;
  std::size_t width = 0, height = 0, depth = 0;
  for (const std::size_t i : group)
    for (const LatticeCell c : patterns[i]) {
      width = std::max<std::size_t>(width, c.x + 1u);
      height = std::max<std::size_t>(height, c.y + 1u);
      depth = std::max<std::size_t>(depth, c.z + 1u);
    }
  std::vector<std::uint32_t> slot_of_cell(width * height * depth, none);
  const auto slot_of = [&](LatticeCell c) -> std::uint32_t& {
    return slot_of_cell[c.x + width * (c.y + height * c.z)];
  };
  for (const std::size_t i : group)
    for (const LatticeCell c : patterns[i]) slot_of(c) = 0;
  std::uint32_t slots = 0;
  for (std::uint32_t& slot : slot_of_cell)
    if (slot != none) slot = slots++;
  std::vector<Member> members;
  for (const std::size_t i : group) {
    members.push_back({bodies[i]->robot, bodies[i]->face_pairs, {}});
    members.back().slots.reserve(patterns[i].size());
    for (const LatticeCell c : patterns[i]) members.back().slots.push_back(slot_of(c));
  }
  GroupPlan plan{std::move(group), merge_topologies(members, slots)};
  if (bodies[plan.bodies.front()]->slots.lanes >= min_lanes_to_split) maximize_split_face_tiles(plan);
  return plan;
}

// Prepares the bodies to step alone if a bound of their costs does not decide.
bool is_faster_than_alone(std::span<Body* const> bodies, const GroupPlan& plan, bool faces) {
  const Topology& topology = *plan.merged.topology;
  if (!fits_in_cache(topology, bodies[plan.bodies.front()]->slots.lanes)) return false;
  const double together = cost_in_lockstep(topology, faces);
  double alone = 0, at_least = 0;
  for (const std::size_t i : plan.bodies) at_least += least_cost_alone(*bodies[i], faces);
  if (together < at_least) return true;
  for (const std::size_t i : plan.bodies) {
    prepare_to_step_alone(*bodies[i]);
    alone += cost_alone(*bodies[i], faces);
  }
  return together < alone;
}

}  // namespace

std::vector<GroupPlan> plan_lockstep_groups(std::span<Body* const> bodies, std::size_t threads,
                                            const Configuration& configuration, const WorkWatch& watch) {
  Group left;
  for (std::size_t i = 0; i < bodies.size(); ++i)
    if (fits_in_group(*bodies[i])) left.push_back(i);
  const bool faces = has_face_forces(configuration.environment);
  std::vector<Group> groups = groups_of_same_topology(bodies, left);
  const std::size_t same = groups.size();
  const Patterns patterns = patterns_of(bodies, left, faces);
  std::ranges::move(groups_of_similar(bodies, patterns, left, faces, watch), std::back_inserter(groups));
  groups.resize(groups_worth_keeping(groups.size(), threads));

  std::vector<GroupPlan> plans(groups.size());
  WorkCounter counter(watch, "planning groups", groups.size());
  parallel_for(0, groups.size(), [&](std::size_t g) {
    plans[g] = g < same ? plan_same_topology(bodies, std::move(groups[g]))
                        : plan_similar(bodies, patterns, std::move(groups[g]));
    if (g >= same && !is_faster_than_alone(bodies, plans[g], faces)) plans[g] = {};
    counter.add_one();
  });
  std::erase_if(plans, [](const GroupPlan& plan) { return plan.bodies.empty(); });
  return plans;
}

}  // namespace mercury::cpu
