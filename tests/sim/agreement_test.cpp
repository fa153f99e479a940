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

// Runs at dt = 1e-3 s beside the reference and compares every 50 ms. Returns the largest distance [m].
double deviation(const Configuration& configuration, const Robot& robot, int looks, const State* start = nullptr) {
  Simulation simulation(configuration, {&robot, 1});
  Reference expected(configuration, robot);
  if (start) {
    simulation.set_state(0, start->positions, start->velocities);
    expected.set_state(*start);
  }
  double largest = 0;
  for (int look = 0; look < looks; ++look) {
    simulation.step(50);
    expected.step(50);
    largest = std::max(largest, largest_deviation(expected.positions(), simulation.positions(0)));
  }
  return largest;
}

double deviation_over_a_second(const Configuration& configuration, const Robot& robot, const State* start = nullptr) {
  return deviation(configuration, robot, 20, start);
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

// A GPU reads the rest lengths of springs in another way if a robot has more than three.
TEST_P(Agreement, RobotsOfFewRestLengthsFollowTheReference) {
  Robot tetrahedron;
  tetrahedron.masses = {{0.1f, 0.1f, 0.2f}, {0.2f, 0.2f, 0.2f}, {0.2f, 0.1f, 0.1f}, {0.1f, 0.2f, 0.1f}};
  tetrahedron.faces = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  for (Vec3& x : tetrahedron.masses) x.z += 1;  // on land it falls: which edge it comes to stand on would be chance
  for (std::uint16_t a = 0; a < 4; ++a)
    for (std::uint16_t b = 0; b < a; ++b)
      tetrahedron.springs.push_back({.a = a, .b = b, .material = static_cast<MaterialId>(1 + 20 * a + b)});
  for (std::size_t lengths = 1; lengths <= 5; ++lengths) {
    for (std::size_t i = 0; i < 6; ++i)
      tetrahedron.springs[i].rest_length = 0.141f * (1 + 0.02f * static_cast<float>(i % lengths));
    EXPECT_LT(deviation(configuration(), tetrahedron, 6), tolerance()) << lengths;
  }
  Robot lattice = bodies::random_voxels({.x = 3, .y = 3, .z = 3}, 8);  // three lengths
  lattice.springs[50].rest_length *= 1.01f;
  EXPECT_LT(deviation_over_a_second(configuration(), lattice), tolerance());
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
