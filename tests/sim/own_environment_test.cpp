// SPDX-License-Identifier: Apache-2.0
// Simulation::set_environments(): robots of one batch that live in different waters, on different ground.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "backend.h"
#include "bodies.h"
#include "mixed_robots.h"
#include "tests/refusal.h"

namespace mercury {
namespace {

// The same parts with other values.
Environment varied(Environment environment) {
  environment.gravity = environment.gravity + Vec3{0.3f, 0, -0.4f};
  if (auto* water = std::get_if<FaceDrag>(&environment.water))
    *water = {.density = 700, .drag_coefficient = 1.5f, .lift_coefficient = 0.1f, .flow = {0.1f, 0.2f, 0}};
  if (auto* water = std::get_if<ResistiveDrag>(&environment.water))
    *water = {.density = 700, .normal_coefficient = 1.5f, .added_mass_coefficient = 0.3f, .flow = {0.1f, 0.2f, 0}};
  if (auto* water = std::get_if<PointDrag>(&environment.water)) *water = {.point_drag = 3, .flow = {0.1f, 0.2f, 0}};
  if (auto* ground = std::get_if<Plane>(&environment.ground)) *ground = {.friction = 0.2f, .static_friction = 0.3f};
  return environment;
}

float largest_difference(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  float largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, length(a[i] - b[i]));
  return largest;
}

class OwnEnvironment : public EveryPair {
 protected:
  // Robot 1 alone is in `own`, from the start on.
  Simulation with_own(const Environment& own, const std::vector<Robot>& robots) const {
    Simulation simulation(configuration(), robots);
    simulation.set_environments(std::array<std::size_t, 1>{1}, std::array{own});
    return simulation;
  }
};
INSTANTIATE_TEST_SUITE_P(All, OwnEnvironment, every_pair, EveryPair::name);

TEST_P(OwnEnvironment, ARobotMovesAsInABatchThatLivesThereAndTheOthersAsBefore) {
  const std::vector<Robot> robots = test::growing_robots(3);
  const Environment other = varied(configuration().environment);
  Configuration there = configuration();
  there.environment = other;
  Simulation one = with_own(other, robots), here(configuration(), robots), all_there(there, robots);
  for (Simulation* simulation : {&one, &here, &all_there}) simulation->step(300);
  EXPECT_LT(largest_difference(one.positions(1), all_there.positions(1)), 1e-4f);
  EXPECT_GT(largest_difference(one.positions(1), here.positions(1)), 1e-3f);
  for (const std::size_t i : {0u, 2u}) EXPECT_LT(largest_difference(one.positions(i), here.positions(i)), 1e-4f);
}

TEST_P(OwnEnvironment, ARobotDoesNotFeelThoseOfOthers) {
  const std::vector<Robot> robots = test::growing_robots(3);
  const Environment other = varied(configuration().environment);
  Simulation a = with_own(other, robots), b(configuration(), robots);
  b.set_environments(std::array<std::size_t, 3>{0, 1, 2}, std::array{varied(other), other, varied(other)});
  a.step(100);
  b.step(60);
  b.step(40);
  EXPECT_EQ(a.hash(1), b.hash(1));
  EXPECT_NE(a.hash(0), b.hash(0));
}

TEST_P(OwnEnvironment, ItLastsWhileRobotsComeAndGoAndEndsWithConfigure) {
  const std::vector<Robot> robots = test::growing_robots(3);
  const Environment other = varied(configuration().environment);
  Simulation changed = with_own(other, robots), same = with_own(other, robots);
  changed.step(40);
  changed.keep(std::array<std::size_t, 2>{2, 1});
  changed.add(robots[0]);
  EXPECT_EQ(changed.environment(1), other);
  EXPECT_EQ(changed.environment(2), configuration().environment);
  changed.step(60);
  same.step(100);
  EXPECT_EQ(changed.hash(1), same.hash(1));
  same.configure(configuration());
  EXPECT_EQ(same.environment(1), configuration().environment);
  Simulation never(configuration(), robots);
  for (std::size_t i = 0; i < robots.size(); ++i) never.set_state(i, same.state(i));
  never.set_clock(same.clock());
  same.step(50);
  never.step(50);
  EXPECT_EQ(same.hashes(), never.hashes());
}

class OwnEnvironmentOn : public BackendTest {};
INSTANTIATE_TEST_SUITE_P(All, OwnEnvironmentOn, every_device, BackendTest::name);

// x = x0 + g t^2 / 2 + g t dt / 2, since a step moves by its new velocity.
TEST_P(OwnEnvironmentOn, EachFallsByItsGravity) {
  const std::vector<Robot> points(40, bodies::point());
  Simulation simulation({.dt = 1e-3, .damping = 0, .environment = empty_space(), .device = device()}, points);
  std::vector<std::size_t> robots;
  std::vector<Environment> environments;
  for (std::size_t i = 0; i < points.size(); ++i) {
    robots.push_back(i);
    environments.push_back(empty_space());
    environments.back().gravity = {0, 0.1f * static_cast<float>(i), -1};
  }
  simulation.set_environments(robots, environments);
  simulation.step(1000);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 x = simulation.positions(i)[0];
    EXPECT_NEAR(x.y, 0.1f * static_cast<float>(i) * 0.5005f, 2e-4f);
    EXPECT_NEAR(x.z, -0.5005f, 2e-5f);
  }
}

// Sliding to rest takes v^2 / (2 mu g).
TEST_P(OwnEnvironmentOn, EachSlidesByItsFriction) {
  const std::vector<Robot> points(3, bodies::point());
  const Environment land{.ground = Plane{.friction = 0.5f}, .gravity = {0, 0, -10}};
  Simulation simulation({.dt = 1e-4, .damping = 0, .environment = land, .device = device()}, points);
  Environment slippery = land, rough = land;
  slippery.ground = Plane{.friction = 0.25f};
  rough.ground = Plane{.friction = 1};
  simulation.set_environments(std::array<std::size_t, 2>{0, 2}, std::array{slippery, rough});
  for (std::size_t i = 0; i < 3; ++i) simulation.set_state(i, bodies::moving(points[i], {1, 0, 0}));
  simulation.step(5000);
  const std::array<float, 3> distances{0.2f, 0.1f, 0.05f};
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(simulation.positions(i)[0].x, distances[i], 1e-3f);
}

// What floats depends on the water that it displaces.
TEST_P(OwnEnvironmentOn, EachFloatsInItsResistiveWater) {
  Robot robot = bodies::voxels({.x = 2, .y = 2, .z = 2}, {.stiffness = 5000});
  robot.mass.assign(robot.masses.size(), 8.0f / static_cast<float>(robot.masses.size()));  // 8 kg of 8 l
  const Environment water{.water = ResistiveDrag{.density = 1000}, .gravity = {0, 0, -9.81f}};
  const std::vector<Robot> robots(3, robot);
  Simulation simulation({.dt = 1e-4, .environment = water, .device = device()}, robots);
  Environment light = water, dense = water;
  light.water = ResistiveDrag{.density = 500};
  dense.water = ResistiveDrag{.density = 2000};
  simulation.set_environments(std::array<std::size_t, 2>{0, 2}, std::array{light, dense});
  Configuration in_dense = simulation.configuration();
  in_dense.environment = dense;
  Simulation reference(in_dense, robots);
  simulation.step(3000);
  reference.step(3000);
  const std::vector<Telemetry> now = simulation.telemetry();
  EXPECT_LT(now[0].center_of_mass.z, now[1].center_of_mass.z - 0.05f);
  EXPECT_GT(now[2].center_of_mass.z, now[1].center_of_mass.z + 0.05f);
  EXPECT_NEAR(now[2].center_of_mass.z, reference.telemetry(2).center_of_mass.z, 1e-5f);
}

TEST_P(OwnEnvironmentOn, RefusesWhatAllRobotsShare) {
  Robot feeling = bodies::voxels({.x = 1, .y = 1, .z = 1}, {.stiffness = 100});
  feeling.sensors.push_back({.kind = SensorKind::flow});
  Simulation simulation({.environment = Land{}, .device = device()}, std::array{bodies::point(), bodies::point()});
  const auto refused = [&](const Environment& own) {
    return refusal([&] { simulation.set_environments(std::array<std::size_t, 1>{1}, std::array{own}); });
  };
  const Environment land = Land{};
  EXPECT_THAT(refused(Ocean{}), testing::HasSubstr("needs the parts of land"));
  Environment own = land;
  own.stiffness_scale = 3;
  EXPECT_THAT(refused(own), testing::HasSubstr("stiffness_scale"));
  own = land;
  own.contacts->contact_stiffness = 7;
  EXPECT_THAT(refused(own), testing::HasSubstr("contact_stiffness"));
  own = land;
  own.ground = Plane{.friction = -1};
  EXPECT_THAT(refused(own), testing::HasSubstr("friction"));
  EXPECT_THROW(simulation.set_environments(std::array<std::size_t, 1>{2}, std::array{land}), std::out_of_range);
  EXPECT_THROW(simulation.set_environments(std::array<std::size_t, 2>{1, 1}, std::array{land, land}),
               std::invalid_argument);
  EXPECT_EQ(simulation.environment(1), land);
  Simulation swimming({.environment = Ocean{}, .device = device()}, std::array{feeling});
  EXPECT_THAT(
      refusal([&] {
        swimming.set_environments(std::array<std::size_t, 1>{0}, std::array<Environment, 1>{Ocean{.flow = {1, 0, 0}}});
      }),
      testing::HasSubstr("senses the flow"));
}

TEST(OwnEnvironmentOfPlainBackends, AreSplitAmongParts) {
  std::vector<std::unique_ptr<Backend>> parts;
  for (int i = 0; i < 2; ++i) parts.push_back(make_cpu_backend({.kind = DeviceKind::cpu, .threads = 1}));
  const std::vector<Robot> robots = test::growing_robots(3);
  const Configuration configuration{.device = {.kind = DeviceKind::cpu}};
  Simulation split(configuration, robots, make_split_backend(std::move(parts))), whole(configuration, robots);
  const std::array<std::size_t, 2> which{2, 0};
  const std::array environments{varied(Ocean{}), varied(varied(Ocean{}))};
  for (Simulation* simulation : {&split, &whole}) {
    simulation->set_environments(which, environments);
    simulation->step(100);
  }
  EXPECT_EQ(split.hashes(), whole.hashes());
}

}  // namespace
}  // namespace mercury
