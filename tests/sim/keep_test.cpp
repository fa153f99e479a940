// SPDX-License-Identifier: Apache-2.0
// Simulation::keep(): robots are removed and reordered. The rest go on unchanged.
#include <gtest/gtest.h>

#include <array>

#include "backend.h"
#include "bodies.h"
#include "mixed_robots.h"

namespace mercury {
namespace {

class Keep : public EveryPair {};
INSTANTIATE_TEST_SUITE_P(All, Keep, every_pair, EveryPair::name);

TEST_P(Keep, RobotsThatStayMoveAsIfAllHadStayed) {
  const std::vector<Robot> robots = test::growing_robots(4);
  Simulation all(configuration(), robots), fewer(configuration(), robots);
  fewer.step(100);
  fewer.keep(std::array<std::size_t, 2>{3, 1});
  fewer.step(100);
  all.step(200);
  ASSERT_EQ(fewer.size(), 2u);
  EXPECT_EQ(fewer.robot(0), robots[3]);
  EXPECT_EQ(fewer.robot(1), robots[1]);
  EXPECT_EQ(fewer.hash(0), all.hash(3));
  EXPECT_EQ(fewer.hash(1), all.hash(1));
  EXPECT_EQ(fewer.mass_count(), robots[3].masses.size() + robots[1].masses.size());
  EXPECT_EQ(fewer.steps(), 200);
}

class KeepOn : public BackendTest {};
INSTANTIATE_TEST_SUITE_P(All, KeepOn, every_device, BackendTest::name);

TEST_P(KeepOn, TunedMaterialsMoveWithTheirRobot) {
  Simulation simulation({.device = device()}, test::growing_robots(4));
  const Material soft{.stiffness = 7};
  simulation.set_material(2, 5, soft);
  simulation.keep(std::array<std::size_t, 2>{2, 0});
  EXPECT_EQ(simulation.material(0, 5), soft);
  EXPECT_EQ(simulation.material(1, 5), default_materials()[5]);
}

TEST_P(KeepOn, AnExplosionIsKept) {
  Simulation simulation({.environment = empty_space(), .device = device()}, test::growing_robots(4));
  State far = simulation.state(1);
  far.positions[0].x = 2e6f;
  simulation.set_state(1, far.positions, far.velocities);
  simulation.step(3);
  ASSERT_TRUE(simulation.telemetry(1).exploded);
  const double then = simulation.telemetry(1).exploded_at;
  simulation.keep(std::array<std::size_t, 2>{1, 2});
  EXPECT_TRUE(simulation.telemetry(0).exploded);
  EXPECT_EQ(simulation.telemetry(0).exploded_at, then);
  EXPECT_FALSE(simulation.telemetry(1).exploded);
}

TEST_P(KeepOn, AllRobotsCanBeRemoved) {
  Simulation simulation({.device = device()}, test::growing_robots(4));
  simulation.keep({});
  simulation.step(10);
  EXPECT_EQ(simulation.size(), 0u);
  EXPECT_EQ(simulation.mass_count(), 0u);
  EXPECT_EQ(simulation.add(test::growing_robots(4)[0]), 0u);
}

TEST_P(KeepOn, AnIndexMustExistAndAppearOnce) {
  Simulation simulation({.device = device()}, test::growing_robots(4));
  EXPECT_THROW(simulation.keep(std::array<std::size_t, 1>{4}), std::out_of_range);
  EXPECT_THROW(simulation.keep(std::array<std::size_t, 2>{1, 1}), std::invalid_argument);
  EXPECT_EQ(simulation.size(), 4u);
}

}  // namespace
}  // namespace mercury
