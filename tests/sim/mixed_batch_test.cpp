// SPDX-License-Identifier: Apache-2.0
// Small robots of different topologies that are stepped together in lockstep groups: each gives the bits that it gives
// alone, whatever happens to the others.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>

#include "bodies.h"
#include "kernel_batch.h"
#include "mixed_robots.h"

namespace mercury {
namespace {

using Batch = test::KernelBatch;
using test::expect_same;
using test::KernelCase;

class MixedBatch : public testing::TestWithParam<KernelCase> {
 protected:
  void SetUp() override {
    for (std::size_t i = 0; i < robots.size(); ++i) {
      starts.push_back(bodies::shaken(robots[i], 0.01f, 0.5f, i));
      for (Vec3& x : starts.back().positions) x.z += 0.02f * static_cast<float>(i % 5);
    }
  }

  void expect_the_plain_loop(std::span<const Perturbation> perturbations = {}, Vec3 flow = {},
                             float drag_tangential = 0) const {
    KernelCase of = GetParam();
    of.flow = flow;
    of.drag_tangential = drag_tangential;
    test::expect_the_plain_loop(of, robots, starts, {1, 2, 45, 7, 40, 1, 34}, perturbations);
  }

  std::vector<Robot> robots = test::mixed_robots(GetParam().kernel.lanes);
  std::vector<State> starts;
};
INSTANTIATE_TEST_SUITE_P(All, MixedBatch, testing::ValuesIn(test::every_kernel_case()), test::name_of_kernel_case);

TEST_P(MixedBatch, GivesTheBitsOfThePlainLoop) { expect_the_plain_loop(); }

TEST_P(MixedBatch, GivesTheBitsOfThePlainLoopAtSpeed) {
  for (State& start : starts)
    for (std::size_t i = 0; i < start.velocities.size(); ++i)
      start.velocities[i] += Vec3{20, 5 * static_cast<float>(i % 3), -10};
  expect_the_plain_loop();
}

TEST_P(MixedBatch, GivesTheBitsOfThePlainLoopInACurrent) { expect_the_plain_loop({}, {0.3f, -0.2f, 1.5f}); }

TEST_P(MixedBatch, GivesTheBitsOfThePlainLoopWithTangentialDrag) {
  if (GetParam().environment != Ocean::name) return;
  expect_the_plain_loop({}, {}, 0.7f);
}

TEST_P(MixedBatch, TangentialDragAffectsNoOtherRobotInAnExplosion) {
  if (GetParam().environment != Ocean::name) return;
  starts[2].velocities[5] += Vec3{1e10f, 0, 0};
  starts[4].velocities[1].x = std::numeric_limits<float>::infinity();
  starts[7].velocities[3] += Vec3{3e3f, 0, 0};
  expect_the_plain_loop({}, {}, 0.7f);
}

TEST_P(MixedBatch, APerturbationActsOnItsRobotOnly) {
  const std::vector<Perturbation> perturbations = {{0, 0, {0.3f, 0.1f, 0.4f}, 20},
                                                   {0, 5, {0.3f, 0.1f, 0.4f}, 2},
                                                   {7, 3, {-1, 0, 0.5f}, 50},
                                                   {9, 1, {1e6f, 0, 0}, 1e6f}};
  expect_the_plain_loop(perturbations);
}

TEST_P(MixedBatch, AnExplosionAffectsItsRobotOnly) {
  starts[2].velocities[5] += Vec3{1e10f, 0, 0};  // in the first step
  starts[7].velocities[3] += Vec3{3e3f, 0, 0};
  robots[3].materials.assign(materials_of(robots[3]).begin(), materials_of(robots[3]).end());
  for (Material& material : robots[3].materials) material.stiffness *= 2e4f;  // too stiff for the time step
  robots[3].materials[air] = {};
  expect_the_plain_loop();
}

TEST_P(MixedBatch, AnInfiniteVelocityAffectsItsRobotOnly) {
  starts[2].velocities[5].x = std::numeric_limits<float>::infinity();
  starts[7].velocities[3] += Vec3{0, -1e36f, 0};
  expect_the_plain_loop();
}

// Compares statuses, since a state that holds NaN differs from itself.
TEST_P(MixedBatch, ANaNVelocityExplodesItsRobotOnly) {
  starts[2].velocities[5].y = std::numeric_limits<float>::quiet_NaN();
  Batch batch(GetParam(), robots);
  for (std::size_t i = 0; i < robots.size(); ++i) batch.write(i, starts[i]);
  for (const std::int64_t call : {1, 40}) batch.step(call);
  for (std::size_t i = 0; i < robots.size(); ++i)
    EXPECT_EQ(batch.backend().status(i).exploded_step, i == 2 ? 0 : -1) << i;
}

// Edits some robots of a batch in all possible ways, and does the same to each of them alone.
TEST_P(MixedBatch, EditsReachTheirRobotOnly) {
  using Edit = std::function<void(Batch&, const std::function<bool(std::size_t)>& contains, std::size_t first)>;
  const auto table_of = [&](std::size_t i, float stiffness) {
    std::vector<Material> table(max_materials);
    std::ranges::copy(materials_of(robots[i]), table.begin());
    for (Material& material : table) {
      material.stiffness *= stiffness;
      material.frequency += 2 * stiffness;
    }
    return table;
  };
  const Edit script = [&](Batch& batch, const auto& contains, std::size_t first) {
    for (std::size_t i = 0; i < robots.size(); ++i)
      if (contains(i)) batch.write(i - first, starts[i]);
    batch.step(5);
    for (const std::size_t i : {1u, 4u})
      if (contains(i)) batch.backend().write_materials(i - first, table_of(i, 0.3f));
    batch.step(3);
    for (const std::size_t i : {0u, 5u})
      if (contains(i)) batch.write(i - first, starts[i]);
    batch.step(40);
    for (const std::size_t i : {2u, 6u})
      if (contains(i)) {
        State broken = batch.state(i - first);
        (i == 2 ? broken.velocities : broken.positions)[1].x = 1e10f;  // explodes in the next step, or before it
        batch.write(i - first, broken);
      }
    batch.step(2);
    batch.step(3);
    if (contains(2)) {
      batch.write(2 - first, starts[2]);
      batch.backend().set_status(2 - first, {});
    }
    batch.step(10);
    std::vector<Material> tables;
    for (std::size_t i = 0; i < robots.size(); ++i)
      if (contains(i)) std::ranges::copy(table_of(i, 1 + 0.1f * static_cast<float>(i)), std::back_inserter(tables));
    batch.backend().write_materials(tables);
    batch.step(4);
    KernelCase other = GetParam();
    other.solver = other.solver == Solver::force ? Solver::xpbd : Solver::force;
    batch.backend().configure(other.configuration());
    batch.step(6);
    other.environment = other.environment == Land::name ? Ocean::name : Land::name;
    batch.backend().configure(other.configuration());
    batch.step(6);
  };
  Batch all(GetParam(), robots);
  script(
      all, [](std::size_t) { return true; }, 0);
  for (std::size_t i = 0; i < robots.size(); ++i) {
    Batch alone(GetParam(), std::span(robots).subspan(i, 1));
    script(
        alone, [&](std::size_t j) { return j == i; }, i);
    expect_same(all.state(i), alone.state(0), i);
    EXPECT_EQ(all.backend().status(i).exploded_step, alone.backend().status(0).exploded_step) << i;
    EXPECT_EQ(all.backend().status(i).bad_mass, alone.backend().status(0).bad_mass) << i;
  }
  EXPECT_GE(all.backend().status(6).exploded_step, 0);
}

// Reports and reads states while lockstep groups hold them.
TEST_P(MixedBatch, ReportsWhatEachRobotReportsAlone) {
  Batch all(GetParam(), robots);
  for (std::size_t i = 0; i < robots.size(); ++i) all.write(i, starts[i]);
  all.step(20);
  const Clock clock{.dt = GetParam().configuration().dt, .step = 20};
  std::vector<Telemetry> reports(robots.size());
  std::vector<RobotStatus> statuses(robots.size());
  all.backend().report(clock, reports, statuses);
  std::size_t masses = 0;
  for (const Robot& robot : robots) masses += robot.masses.size();
  std::vector<Vec3> positions(masses), velocities(masses);
  all.backend().read_positions(positions);
  all.backend().read_velocities(velocities);
  std::size_t first = 0;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    Batch alone(GetParam(), std::span(robots).subspan(i, 1));
    alone.write(0, starts[i]);
    alone.step(20);
    Telemetry wanted;
    alone.backend().report(clock, {&wanted, 1}, {&statuses[i], 1});
    EXPECT_EQ(reports[i].center_of_mass, wanted.center_of_mass) << i;
    EXPECT_EQ(reports[i].kinetic_energy, wanted.kinetic_energy) << i;
    EXPECT_EQ(reports[i].elastic_energy, wanted.elastic_energy) << i;
    EXPECT_EQ(reports[i].largest_strain, wanted.largest_strain) << i;
    const State state = alone.state(0);
    EXPECT_TRUE(std::ranges::equal(state.positions, std::span(positions).subspan(first, state.positions.size()))) << i;
    EXPECT_TRUE(std::ranges::equal(state.velocities, std::span(velocities).subspan(first, state.velocities.size())))
        << i;
    first += state.positions.size();
  }
}

TEST_P(MixedBatch, AnyNumberOfThreadsGivesTheSameBits) {
  Batch one(GetParam(), robots), many(GetParam(), robots, 3);
  for (Batch* batch : {&one, &many}) {
    for (std::size_t i = 0; i < robots.size(); ++i) batch->write(i, starts[i]);
    batch->step(3);
    batch->step(50);
  }
  for (std::size_t i = 0; i < robots.size(); ++i) expect_same(many.state(i), one.state(i), i);
}

}  // namespace
}  // namespace mercury
