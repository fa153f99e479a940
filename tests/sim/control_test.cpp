// SPDX-License-Identifier: Apache-2.0
// What a program may change between calls of step(): materials, state, configuration, perturbations.
#include <gtest/gtest.h>

#include <cmath>

#include "backend.h"
#include "bodies.h"
#include "mercury/error.h"
#include "reference.h"
#include "tests/refusal.h"

namespace mercury {
namespace {

class Control : public BackendTest {
 protected:
  Configuration configuration(double damping = 0) const {
    return {.damping = damping, .environment = empty_space(), .device = device()};
  }
};
INSTANTIATE_TEST_SUITE_P(All, Control, every_device, BackendTest::name);

TEST_P(Control, AStifferMaterialShortensThePeriodOfItsRobotOnly) {
  const Robot pair = bodies::pair({50, 0, 0, 0});
  const std::vector<Robot> robots(2, pair);
  Simulation simulation(configuration(), robots);
  const std::vector<Vec3> stretched = {{-0.05f, 0, 0}, {1.05f, 0, 0}};
  for (std::size_t i = 0; i < 2; ++i) simulation.set_state(i, stretched, std::vector<Vec3>(2));
  simulation.set_material(1, 1, {200, 0, 0, 0});
  EXPECT_EQ(simulation.material(0, 1).stiffness, 50);
  EXPECT_EQ(simulation.material(1, 1).stiffness, 200);
  // After one second x = 0.05 cos(omega t), omega = sqrt(2 k).
  simulation.step(1000);
  for (std::size_t i = 0; i < 2; ++i) {
    const double omega = std::sqrt(2 * (i == 0 ? 50.0 : 200.0));
    const auto x = simulation.positions(i);
    EXPECT_NEAR(x[1].x - 1, 0.05 * std::cos(omega), 0.05 * omega * 1e-3) << i;  // first order in dt
    EXPECT_NEAR(x[0].x, -0.05 * std::cos(omega), 0.05 * omega * 1e-3) << i;
  }
}

TEST_P(Control, ChangedMaterialsFollowTheReferenceFromThatStepOn) {
  Robot robot = bodies::random_voxels({.x = 3, .y = 3, .z = 2}, 1);
  const auto defaults = default_materials();
  robot.materials.assign(defaults.begin(), defaults.end());
  for (const Solver solver : {Solver::force, Solver::xpbd}) {
    Configuration setting{.solver = solver, .device = device()};
    Simulation simulation(setting, {&robot, 1});
    simulation.step(300);
    Robot changed = robot;
    std::vector<Material> tables = simulation.materials();
    ASSERT_EQ(tables.size(), std::size_t{max_materials});
    for (std::size_t id = 1; id < changed.materials.size(); ++id) {
      const float f = static_cast<float>(id);
      changed.materials[id] = {30 + f, 0.1f, 2 + 0.01f * f, 0.1f * f};
      tables[id] = changed.materials[id];
    }
    simulation.set_materials(tables);
    EXPECT_EQ(simulation.materials(), tables);
    reference::Reference expected(setting, changed);
    expected.step(300);  // for its clock
    expected.set_state(simulation.state(0));
    simulation.step(500);
    expected.step(500);
    EXPECT_LT(reference::largest_deviation(expected.positions(), simulation.positions(0)), 1e-4) << name_of(solver);
  }
}

TEST_P(Control, ResetKeepsChangedMaterials) {
  const Robot pair = bodies::pair({50, 0, 0, 0});
  Simulation simulation(configuration(), {&pair, 1});
  simulation.set_material(0, 1, {70, 0.1f, 1, 0});
  simulation.step(10);
  simulation.reset();
  EXPECT_EQ(simulation.material(0, 1), (Material{70, 0.1f, 1, 0}));
}

TEST_P(Control, BadMaterialsStatesAndPerturbationsAreRefused) {
  const Robot pair = bodies::pair({50, 0, 0, 0});
  Simulation simulation(configuration(), {&pair, 1});
  EXPECT_THROW(simulation.set_material(0, 1, {-1, 0, 0, 0}), InputError);
  EXPECT_THROW(simulation.set_material(0, 1, {1, 1.5f, 0, 0}), InputError);
  EXPECT_THROW(simulation.set_material(0, 2, {1, 0, 0, 0}), std::out_of_range);
  EXPECT_THROW(simulation.set_material(1, 1, {1, 0, 0, 0}), std::out_of_range);
  EXPECT_THROW(simulation.set_materials(std::vector<Material>(3)), std::invalid_argument);
  EXPECT_THROW(simulation.set_state(0, std::vector<Vec3>(1), std::vector<Vec3>(2)), std::invalid_argument);
  EXPECT_THROW(simulation.set_state(0, std::vector<Vec3>(2), std::vector<Vec3>(3)), std::invalid_argument);
  const Perturbation perturbation{.robot = 0, .mass = 2, .target = {}, .stiffness = 1};
  EXPECT_THROW(simulation.set_perturbations({&perturbation, 1}), std::out_of_range);
  EXPECT_THROW(simulation.step(-1), std::invalid_argument);
  EXPECT_EQ(simulation.material(0, 1), (Material{50, 0, 0, 0}));
}

TEST_P(Control, ConfigureChangesSolverEnvironmentAndTimeStepAndKeepsStateAndTime) {
  const Robot robot = bodies::random_voxels({.x = 3, .y = 2, .z = 2}, 2);
  Configuration setting{.dt = 1e-3, .device = device()};
  Simulation simulation(setting, {&robot, 1});
  simulation.step(200);
  const State before = simulation.state(0);
  setting.dt = 5e-4;
  setting.damping = 0.4;
  setting.solver = Solver::xpbd;
  setting.environment = OceanSimple{.point_drag = 2};
  simulation.configure(setting);
  EXPECT_EQ(simulation.positions(0), before.positions);
  EXPECT_DOUBLE_EQ(simulation.time(), 0.2);
  simulation.step(400);
  EXPECT_DOUBLE_EQ(simulation.time(), 0.4);
  EXPECT_EQ(simulation.steps(), 600);

  reference::Reference expected(setting, robot);
  expected.step(400);  // 0.2 s at the new time step, for its clock
  expected.set_state(before);
  expected.step(400);
  EXPECT_LT(reference::largest_deviation(expected.positions(), simulation.positions(0)), 1e-4);

  setting.device.index += 1;
  EXPECT_THROW(simulation.configure(setting), std::invalid_argument);
  setting.device.index -= 1;
  setting.dt = -1;
  EXPECT_THROW(simulation.configure(setting), InputError);
}

// A perturbation is a spring of rest length 0 to a point: a free mass oscillates about it with omega = sqrt(k).
TEST_P(Control, AMassOscillatesAboutTheTargetOfItsPerturbationUntilThatIsRemoved) {
  const Robot point = bodies::point({0, 0, 0});
  const std::vector<Robot> robots(2, point);
  for (const Solver solver : {Solver::force, Solver::xpbd}) {
    Configuration setting = configuration();
    setting.solver = solver;
    Simulation simulation(setting, robots);
    const Perturbation perturbation{.robot = 1, .mass = 0, .target = {0.1f, -0.2f, 0}, .stiffness = 40};
    simulation.set_perturbations({&perturbation, 1});
    const double omega = std::sqrt(40.0);
    simulation.step(800);
    EXPECT_EQ(simulation.positions(0)[0], Vec3{}) << "not pulled";
    const State state = simulation.state(1);
    EXPECT_NEAR(state.positions[0].x, 0.1 * (1 - std::cos(omega * 0.8)), 1e-3);
    EXPECT_NEAR(state.positions[0].y, -0.2 * (1 - std::cos(omega * 0.8)), 2e-3);
    simulation.set_perturbations({});
    simulation.step(1000);
    const State free = simulation.state(1);
    EXPECT_EQ(free.velocities[0], state.velocities[0]);
    EXPECT_NEAR(free.positions[0].x, state.positions[0].x + state.velocities[0].x, 1e-4);
  }
}

TEST_P(Control, PerturbedRobotsFollowTheReference) {
  const Robot robot = bodies::random_voxels({.x = 3, .y = 2, .z = 2}, 3);
  for (const Solver solver : {Solver::force, Solver::xpbd}) {
    const Configuration setting{.solver = solver, .device = device()};
    Simulation simulation(setting, {&robot, 1});
    reference::Reference expected(setting, robot);
    const std::vector<Perturbation> perturbations = {
        {.robot = 0, .mass = 5, .target = {0.4f, 0.1f, 0.3f}, .stiffness = 50},
        {.robot = 0, .mass = 0, .target = {-0.2f, 0.1f, 0}, .stiffness = 30}};
    simulation.set_perturbations(perturbations);
    expected.set_perturbations(perturbations);
    simulation.step(700);
    expected.step(700);
    EXPECT_LT(reference::largest_deviation(expected.positions(), simulation.positions(0)), 1e-4) << name_of(solver);
  }
}

TEST_P(Control, ABadRobotIsNamedWithItsPlaceInTheBatch) {
  std::vector<Robot> robots = {bodies::pair({50, 0, 0, 0}), bodies::pair({50, 0, 0, 0})};
  robots[1].name = "eel";
  robots[1].springs[0].b = 9;
  EXPECT_EQ(refusal([&] { Simulation simulation(configuration(), robots); }),
            "robot 1 (eel): /springs/0: mass 9 is out of range, the robot has 2");
}

TEST_P(Control, AnEmptyBatchCanGrow) {
  Simulation simulation(configuration());
  EXPECT_EQ(simulation.size(), 0u);
  simulation.step(10);
  EXPECT_NEAR(simulation.time(), 0.01, 1e-12);
  EXPECT_TRUE(simulation.telemetry().empty());
  const Robot pair = bodies::pair({50, 0, 0, 0});
  EXPECT_EQ(simulation.add(pair), 0u);
  EXPECT_EQ(simulation.add(pair), 1u);
  simulation.step(10);
  EXPECT_EQ(simulation.size(), 2u);
  EXPECT_EQ(simulation.robot(1), pair);
}

}  // namespace
}  // namespace mercury
