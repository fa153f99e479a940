// SPDX-License-Identifier: Apache-2.0
// What is said of a robot's masses goes along to the robots that are made from it.
#include "robots/carried_points.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mercury/generator.h"
#include "mercury/random_voxel.h"

namespace mercury {
namespace {

using testing::Each;
using testing::ElementsAre;

TEST(CarriedPoints, StayAtTheirPlacesAndNewOnesHaveTheMeanMass) {
  const Robot from{.masses = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                   .mass = {1, 2, 6},
                   .velocity = {{0, 0, 1}, {0, 0, 2}, {0, 0, 3}},
                   .fixed = {2, 0}};
  Robot to{.masses = {{0, 1, 0}, {5, 0, 0}, {0, 0, 1e-5f}}};
  carry_points(from, to);
  EXPECT_THAT(to.mass, ElementsAre(6, 3, 1));
  EXPECT_THAT(to.velocity, ElementsAre(Vec3{0, 0, 3}, Vec3{}, Vec3{0, 0, 1}));
  EXPECT_THAT(to.fixed, ElementsAre(0, 2));
  Robot plain{.masses = to.masses};
  carry_points(Robot{.masses = from.masses}, plain);
  EXPECT_EQ(plain, (Robot{.masses = to.masses}));
  Robot heavy{.masses = to.masses, .mass = {9, 9, 9}};
  carry_points(from, heavy);
  EXPECT_THAT(heavy.mass, Each(9)) << "what the robot has already stays";
}

TEST(CarriedPoints, ChildrenOfARobotKeepItsMass) {
  Robot parent = random_voxel_robot({}, 5);
  parent.mass.assign(parent.masses.size(), 0.25f);
  int changed = 0;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const Robot child = mutate_robot(parent, {.strength = 3, .seed = seed}, "child");
    changed += child.masses.size() != parent.masses.size();
    EXPECT_EQ(child.mass.size(), child.masses.size());
    EXPECT_THAT(child.mass, Each(0.25f));
  }
  EXPECT_GT(changed, 0);
}

}  // namespace
}  // namespace mercury
