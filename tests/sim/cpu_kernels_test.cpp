// SPDX-License-Identifier: Apache-2.0
// On each instruction set, the CPU computes the bits of a plain loop over one spring after the other.
#include <gtest/gtest.h>

#include <random>

#include "bench/cpu_lattice.h"
#include "bodies.h"
#include "kernel_batch.h"

namespace mercury {
namespace {

using test::KernelCase;

// The robot without some of its springs and faces.
Robot torn(const Robot& robot, std::uint64_t seed) {
  Robot result = robot;
  std::mt19937_64 random(seed);
  std::erase_if(result.springs, [&](const Spring&) { return random() % 3 == 0; });
  std::erase_if(result.faces, [&](const Face&) { return random() % 5 == 0; });
  return result;
}

// The robot and its shifted copy, which no spring joins.
Robot entangled(const Robot& robot) {
  Robot result = robot;
  const auto masses = static_cast<std::uint16_t>(robot.masses.size());
  for (const Vec3 x : robot.masses) result.masses.push_back(x + Vec3{0.03f, 0.02f, 0.04f});
  for (const Spring& s : robot.springs)
    result.springs.push_back({static_cast<std::uint16_t>(s.a + masses), static_cast<std::uint16_t>(s.b + masses),
                              s.material, s.rest_length});
  return result;
}

std::vector<Robot> various_robots() {
  const Robot lattice = bodies::random_voxels({.x = 5, .y = 4, .z = 3}, 1);
  std::vector<Robot> robots = {lattice,
                               bodies::random_voxels({.x = 17, .y = 2, .z = 2}, 2),
                               bodies::random_voxels({.x = 2, .y = 2, .z = 2}, 3),
                               bench::scrambled(lattice, 4),
                               torn(lattice, 5),
                               bench::scrambled(torn(lattice, 6), 7),
                               entangled(bodies::random_voxels({.x = 3, .y = 2, .z = 2}, 8)),
                               bodies::pair({50, 0.5f, 3, 0.2f}),
                               bodies::point({0, 0, 1})};
  robots.push_back(lattice);  // every spring twice
  robots.back().springs.insert(robots.back().springs.end(), lattice.springs.begin(), lattice.springs.end());
  return robots;
}

class CpuKernel : public testing::TestWithParam<KernelCase> {
 protected:
  Vec3 flow;
  float drag_tangential = 0;
  KernelCase kernel_case() const {
    KernelCase of = GetParam();
    of.flow = flow;
    of.drag_tangential = drag_tangential;
    return of;
  }
  void expect_same(const Robot& robot, const State& start, std::span<const Perturbation> perturbations,
                   std::int64_t steps, const std::string& which) const {
    SCOPED_TRACE(which);
    test::expect_the_plain_loop(kernel_case(), {&robot, 1}, {&start, 1}, {1, 40, steps - 41}, perturbations);
  }
};
INSTANTIATE_TEST_SUITE_P(All, CpuKernel, testing::ValuesIn(test::every_kernel_case()), test::name_of_kernel_case);

TEST_P(CpuKernel, GivesTheBitsOfThePlainLoop) {
  const std::vector<Robot> robots = various_robots();
  for (std::size_t i = 0; i < robots.size(); ++i) {
    State start = bodies::shaken(robots[i], 0.01f, 0.5f, i);
    for (Vec3& x : start.positions) x.z += 0.3f;
    const std::vector<Perturbation> perturbations = {{0, 0, {0.3f, 0.1f, 0.4f}, 20}};
    expect_same(robots[i], start, perturbations, 500, "robot " + std::to_string(i));
  }
}

TEST_P(CpuKernel, GivesTheBitsOfThePlainLoopInACurrent) {
  flow = {0.3f, -0.2f, 1.5f};
  const std::vector<Robot> robots = various_robots();
  for (const std::size_t i : {0u, 3u, 5u})
    expect_same(robots[i], bodies::shaken(robots[i], 0.01f, 0.5f, i), {}, 100, "robot " + std::to_string(i));
}

TEST_P(CpuKernel, GivesTheBitsOfThePlainLoopWithTangentialDrag) {
  if (GetParam().environment != Ocean::name) return;
  drag_tangential = 0.7f;
  const std::vector<Robot> robots = various_robots();
  for (std::size_t i = 0; i < robots.size(); ++i)
    expect_same(robots[i], bodies::shaken(robots[i], 0.01f, 0.5f, i), {}, 100, "robot " + std::to_string(i));
}

// 30 m/s: near pairs are searched again and again, and the robots move far.
TEST_P(CpuKernel, GivesTheBitsOfThePlainLoopForFastRobots) {
  const std::vector<Robot> robots = various_robots();
  for (const std::size_t i : {1u, 3u, 6u}) {
    State start = bodies::shaken(robots[i], 0.02f, 3, i);
    for (Vec3& v : start.velocities) v += Vec3{20, 20, -10};
    expect_same(robots[i], start, {}, 300, "robot " + std::to_string(i));
  }
}

TEST_P(CpuKernel, FindsTheExplosionsOfThePlainLoop) {
  const Robot robot = bodies::random_voxels({.x = 4, .y = 3, .z = 3}, 1);
  const float infinity = std::numeric_limits<float>::infinity();
  const std::vector<std::pair<Vec3, Vec3>> ways = {
      {{}, {1e10f, 0, 0}}, {{}, {0, 0, infinity}}, {{}, {2e4f, 0, 0}}, {{0, 500, 1}, {}}, {{0, 0, 9e5f}, {0, 0, 1e9f}}};
  for (std::size_t way = 0; way < ways.size(); ++way) {
    State start = bodies::shaken(robot, 0.01f, 0.3f, way);
    start.positions[20] += ways[way].first;
    start.velocities[20] += ways[way].second;
    expect_same(robot, start, {}, 60, "way " + std::to_string(way));
  }
}

// Robots with the same topology but different materials, lengths and states.
class CpuKernelInLockstep : public CpuKernel {
 protected:
  void SetUp() override {
    std::mt19937_64 random(11);
    for (std::size_t i = 0; i < GetParam().kernel.lanes + GetParam().kernel.lanes * 3 / 4 + 1; ++i) {
      robots.push_back(original);
      for (Spring& spring : robots.back().springs) {
        spring.material = static_cast<MaterialId>(1 + random() % 253);
        spring.rest_length *= 1 + 0.05f * static_cast<float>(random() % 8);
      }
      starts.push_back(bodies::shaken(original, 0.01f, 0.5f, i));
      for (Vec3& x : starts.back().positions) x.z += 0.02f * static_cast<float>(i % 5);
    }
  }

  void expect_the_plain_loop(std::span<const Perturbation> perturbations = {}) const {
    test::expect_the_plain_loop(kernel_case(), robots, starts, {3, 45, 200, 52}, perturbations);
  }

  const Robot original = entangled(bodies::random_voxels({.x = 2, .y = 2, .z = 2}, 3));
  std::vector<Robot> robots;
  std::vector<State> starts;
};
INSTANTIATE_TEST_SUITE_P(All, CpuKernelInLockstep, testing::ValuesIn(test::every_kernel_case()),
                         test::name_of_kernel_case);

TEST_P(CpuKernelInLockstep, GivesTheBitsOfThePlainLoop) { expect_the_plain_loop(); }

TEST_P(CpuKernelInLockstep, GivesTheBitsOfThePlainLoopAtSpeed) {
  for (State& start : starts)
    for (std::size_t i = 0; i < start.velocities.size(); ++i)
      start.velocities[i] += Vec3{20, 5 * static_cast<float>(i % 3), -10};
  expect_the_plain_loop();
}

TEST_P(CpuKernelInLockstep, AnExplosionOrAPerturbationAffectsItsRobotOnly) {
  starts[2].velocities[5] += Vec3{1e10f, 0, 0};
  starts[3].velocities[7] += Vec3{3e3f, 0, 0};
  robots[1].materials.assign(materials_of(robots[1]).begin(), materials_of(robots[1]).end());
  for (Material& material : robots[1].materials) material.stiffness *= 2e4f;  // too stiff for the time step
  robots[1].materials[air] = {};
  const std::vector<Perturbation> perturbations = {{0, 0, {0.3f, 0.1f, 0.4f}, 20}};
  expect_the_plain_loop(perturbations);
}

}  // namespace
}  // namespace mercury
