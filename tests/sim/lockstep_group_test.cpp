// SPDX-License-Identifier: Apache-2.0
// Which robots the CPU steps together, and where their masses, springs and faces stand in a lockstep group.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>

#include "mixed_robots.h"
#include "sim/cpu/grouping/group_plan.h"
#include "sim/cpu/grouping/partition.h"
#include "sim/cpu/kernels/kernel.h"
#include "sim/cpu/layout/lockstep_group.h"

namespace mercury {
namespace {

using test::mixed_robots;

class Bodies {
 public:
  Bodies(const std::vector<Robot>& robots, std::size_t lanes) {
    for (const Robot& robot : robots) {
      bodies_.push_back(std::make_unique<cpu::Body>(cpu::make_body(robot, lanes)));
      pointers_.push_back(bodies_.back().get());
    }
  }
  operator std::span<cpu::Body* const>() const { return pointers_; }
  const cpu::Body& operator[](std::size_t i) const { return *bodies_[i]; }
  std::vector<cpu::Body*> members(const cpu::GroupPlan& plan) const {
    std::vector<cpu::Body*> members;
    for (const std::size_t i : plan.bodies) members.push_back(pointers_[i]);
    return members;
  }

 private:
  std::vector<std::unique_ptr<cpu::Body>> bodies_;
  std::vector<cpu::Body*> pointers_;
};

// Without this, the tests of mixed batches would show nothing: they could pass with each robot stepped alone.
TEST(LockstepGroups, MixRobotsOfDifferentTopologies) {
  for (const cpu::Kernel& kernel : cpu::kernels()) {
    const std::vector<Robot> robots = mixed_robots(kernel.lanes);
    const Bodies bodies(robots, kernel.lanes);
    const std::vector<cpu::GroupPlan> plans = cpu::plan_lockstep_groups(bodies, 1, {});
    std::set<std::size_t> members;
    for (const cpu::GroupPlan& plan : plans) members.insert(plan.bodies.begin(), plan.bodies.end());
    EXPECT_GE(members.size(), kernel.lanes) << kernel.name;
    std::size_t mixed = 0;
    for (const cpu::GroupPlan& plan : plans)
      mixed += plan.bodies.size() > 1 && !same_topology(robots[plan.bodies[0]], robots[plan.bodies[1]]);
    EXPECT_GE(mixed, 1u) << kernel.name;
  }
}

// 1,100 long and flat robots, alternating, which is more than are compared at a time. Only the last few of each part
// mix.
TEST(LockstepGroups, KeepRobotsOfOneShapeTogether) {
  constexpr std::size_t robots = 1100, group_size = 8;
  const Robot kinds[] = {bodies::random_voxels({.x = 8, .y = 1, .z = 1}, 1),
                         bodies::random_voxels({.x = 3, .y = 1, .z = 4}, 2)};
  std::vector<cpu::LatticeCell> cells[2];
  std::vector<FacePair> faces[2];
  for (int kind = 0; kind < 2; ++kind) {
    cells[kind] = cpu::lattice_cells_of(kinds[kind]);
    faces[kind] = pair_faces(kinds[kind]);
  }
  std::vector<cpu::RobotItems> items;
  for (std::size_t i = 0; i < robots; ++i) items.push_back({cells[i % 2], kinds[i % 2].springs, faces[i % 2]});
  std::set<std::size_t> seen;
  std::size_t mixed = 0, small = 0;
  for (const std::vector<std::size_t>& group : cpu::partition_by_similarity(items, group_size)) {
    EXPECT_LE(group.size(), group_size);
    small += group.size() < group_size;
    mixed += std::ranges::any_of(group, [&](std::size_t i) { return i % 2 != group.front() % 2; });
    for (const std::size_t i : group) EXPECT_TRUE(seen.insert(i).second) << i;
  }
  EXPECT_EQ(seen.size(), robots);
  EXPECT_LE(mixed, 1u);
  EXPECT_LE(small, 2u);
}

TEST(LockstepGroups, HoldEachMassSpringAndFacePairOnce) {
  const std::vector<Robot> robots = mixed_robots(8);
  const Bodies bodies(robots, 8);
  for (const cpu::GroupPlan& plan : cpu::plan_lockstep_groups(bodies, 1, {})) {
    const cpu::Topology& topology = *plan.merged.topology;
    std::vector<std::uint32_t> owners;
    for (std::uint32_t slot = 0; slot < topology.slots.size(); ++slot)
      owners.insert(owners.end(), topology.slots[slot].owned, slot);
    for (std::size_t lane = 0; lane < plan.bodies.size(); ++lane) {
      const cpu::Body& body = bodies[plan.bodies[lane]];
      const auto& [slots, entries, face_pairs] = *plan.merged.index_maps[lane];
      const auto distinct = [](const auto& values) { return std::set(values.begin(), values.end()).size(); };
      EXPECT_EQ(distinct(slots), body.robot->masses.size());
      EXPECT_EQ(distinct(entries), body.robot->springs.size());
      EXPECT_EQ(distinct(face_pairs), body.face_pairs.size());
      for (std::size_t s = 0; s < entries.size(); ++s) {
        const Spring& spring = body.robot->springs[s];
        EXPECT_EQ(std::minmax(owners[entries[s]], topology.partners[entries[s]]),
                  std::minmax(slots[spring.a], slots[spring.b]));
      }
      for (std::size_t p = 0; p < face_pairs.size(); ++p) {
        const FacePair &own = body.face_pairs[p], &merged = topology.face_pairs[face_pairs[p]];
        EXPECT_TRUE(merged.a == slots[own.a] && merged.b == slots[own.b] && merged.c == slots[own.c] &&
                    merged.d == slots[own.d]);
      }
    }
  }
}

// In split face tiles, the corners depend on the half that a lane is in.
TEST(LockstepGroups, GiveEachLaneTheCornersOfItsOwnFacePairs) {
  for (const std::size_t lanes : {4u, 8u, 16u}) {
    const std::vector<Robot> robots = mixed_robots(lanes);
    const Bodies bodies(robots, lanes);
    std::size_t split = 0;
    for (const cpu::GroupPlan& plan : cpu::plan_lockstep_groups(bodies, 1, {})) {
      const cpu::LockstepGroup group = cpu::make_lockstep_group(bodies.members(plan), plan.merged, false);
      split += group.split_face_tiles.size();
      for (std::size_t lane = 0; lane < plan.bodies.size(); ++lane) {
        const cpu::IndexMap& index_map = *group.index_maps[lane];
        const std::vector<FacePair>& pairs = bodies[plan.bodies[lane]].face_pairs;
        std::set<std::uint32_t> tiles;
        for (std::size_t p = 0; p < pairs.size(); ++p) {
          const std::uint32_t tile = group.face_tile_of_pair[index_map.face_pairs[p]];
          EXPECT_TRUE(tiles.insert(tile).second) << "two face pairs of a robot in one face tile";
          std::array<std::uint32_t, 4> corners{};
          if (tile < group.face_tiles.size()) {
            const auto& [a, b, c, d] = group.face_tiles[tile];
            corners = {a, b, c, d};
          } else {
            const auto& [a, b, c, d] = group.split_face_tiles[tile - group.face_tiles.size()];
            const auto own_half = [&](cpu::LockstepGroup::Halves offsets) {
              return 2 * lane < lanes ? offsets.lower : offsets.upper;
            };
            corners = {own_half(a), own_half(b), own_half(c), own_half(d)};
          }
          const auto offset = [&](std::uint16_t mass) { return group.offset_of(index_map.slots[mass]); };
          EXPECT_EQ(corners,
                    (std::array{offset(pairs[p].a), offset(pairs[p].b), offset(pairs[p].c), offset(pairs[p].d)}));
        }
      }
    }
    EXPECT_EQ(split > 0, lanes > 4) << lanes << " lanes";
  }
}

}  // namespace
}  // namespace mercury
