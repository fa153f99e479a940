// SPDX-License-Identifier: Apache-2.0
// Every pair of solver and environment follows an independent calculation in double precision.
#include <gtest/gtest.h>

#include <array>

#include "backend.h"
#include "bodies.h"
#include "mercury/cuda_devices.h"
#include "reference.h"

namespace mercury {
namespace {

using reference::largest_deviation;
using reference::Reference;

// Runs one second at dt = 1e-3 s beside the reference and compares every 50 ms. Returns the largest distance [m].
double deviation_over_a_second(const Configuration& configuration, const Robot& robot, const State* start = nullptr) {
  Simulation simulation(configuration, {&robot, 1});
  Reference expected(configuration, robot);
  if (start) {
    simulation.set_state(0, start->positions, start->velocities);
    expected.set_state(*start);
  }
  double largest = 0;
  for (int look = 0; look < 20; ++look) {
    simulation.step(50);
    expected.step(50);
    largest = std::max(largest, largest_deviation(expected.positions(), simulation.positions(0)));
  }
  return largest;
}

class Agreement : public EveryPair {
 protected:
  bool on_ground() const { return has_ground(configuration().environment); }
  double tolerance() const { return on_ground() ? 1e-3 : 1e-4; }  // [m]
};

TEST_P(Agreement, RandomVoxelRobotFollowsTheReferenceFromRest) {
  EXPECT_LT(deviation_over_a_second(configuration(), bodies::random_voxels({}, 1)), tolerance());
}

TEST_P(Agreement, RobotThatMovesByHalfWavesFollowsTheReference) {
  EXPECT_LT(deviation_over_a_second(configuration(), bodies::with_half_waves(bodies::random_voxels({}, 1))),
            tolerance());
}

TEST_P(Agreement, ShakenRobotFollowsTheReference) {
  const Robot robot = bodies::random_voxels({}, 2);
  State start = bodies::shaken(robot, 0.01f, 0.5f, 3);
  for (Vec3& x : start.positions) x.z += 0.02f;  // clear of the floor: on land it falls
  EXPECT_LT(deviation_over_a_second(configuration(), robot, &start), tolerance());
}

TEST_P(Agreement, TiltedRobotInACurrentOrDroppedFollowsTheReference) {
  Configuration setting = configuration();
  if (auto* water = std::get_if<FaceDrag>(&setting.environment.water))
    *water = {.lift_coefficient = 0.5f, .flow = {0.3f, -0.2f, 0.1f}};
  if (auto* simple = std::get_if<PointDrag>(&setting.environment.water))
    *simple = {.point_drag = 3, .flow = {0.3f, -0.2f, 0.1f}};
  setting.damping = 0.5;
  Robot robot = bodies::random_voxels({.x = 3, .y = 4, .z = 5}, 4);
  bodies::rotate(robot, bodies::random_rotation(5));
  State start = bodies::moving(robot, {0.5f, 0, -0.5f});
  if (on_ground()) {
    float lowest = 0;
    for (const Vec3 x : start.positions) lowest = std::min(lowest, x.z);
    for (Vec3& x : start.positions) x.z += 0.05f - lowest;
  }
  EXPECT_LT(deviation_over_a_second(setting, robot, &start), tolerance());
}

INSTANTIATE_TEST_SUITE_P(All, Agreement, every_pair, EveryPair::name);

TEST(Backends, CpuAndCudaAgreeWithinATenthOfAMillimeterAfterASecond) {
  if (cuda_device_count() == 0) GTEST_SKIP() << "no CUDA device on this machine";
  for (const Solver solver : {Solver::force, Solver::xpbd})
    for (const std::string_view environment : tested_environments) {
      const std::array robots = {bodies::random_voxels({}, 6), bodies::with_half_waves(bodies::random_voxels({}, 7))};
      Configuration configuration{.solver = solver, .environment = environment_named(environment)};
      configuration.device.kind = DeviceKind::cpu;
      Simulation cpu(configuration, robots);
      configuration.device.kind = DeviceKind::cuda;
      Simulation cuda(configuration, robots);
      cpu.step(1000);
      cuda.step(1000);
      for (std::size_t robot = 0; robot < robots.size(); ++robot) {
        const auto expected = cpu.positions(robot), actual = cuda.positions(robot);
        float largest = 0;
        for (std::size_t i = 0; i < expected.size(); ++i) largest = std::max(largest, length(expected[i] - actual[i]));
        EXPECT_LT(largest, 1e-4f) << name_of(solver) << " " << environment << ", robot " << robot;
      }
    }
}

}  // namespace
}  // namespace mercury
