// SPDX-License-Identifier: Apache-2.0
// How a body is folded: shares that are counted by hand, and what a simulation reports on every backend.
#include "mercury/folding.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "backend.h"
#include "bodies.h"
#include "mercury/evaluator.h"

namespace mercury {
namespace {

using Positions = std::vector<Vec3>;

// Two tetrahedra of 1 and 3 units of volume on both sides of a triangle in the x-y plane.
Robot two_tetrahedra() {
  Robot robot{.materials = bodies::one_material({.stiffness = 50}),
              .masses = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.3f, 0.3f, 1}, {0.3f, 0.3f, -3}}};
  for (std::uint16_t a = 0; a < 5; ++a)
    for (std::uint16_t b = a + 1; b < 5; ++b)
      if (!(a == 3 && b == 4)) robot.springs.push_back({a, b, 1, rest_distance(robot, a, b)});
  return robot;
}

Positions mirrored(Positions positions) {
  for (Vec3& x : positions) x.x = -x.x;
  return positions;
}

TEST(BodyCells, ABodyAtRestIsNotFolded) {
  for (const Robot& robot :
       {bodies::voxels({}, {.stiffness = 50}), two_tetrahedra(), bodies::point(), bodies::pair({.stiffness = 50})}) {
    const Folding folding = BodyCells(robot).folding(robot.masses);
    EXPECT_EQ(folding.inverted, 0);
    EXPECT_EQ(folding.overlap, 0);
  }
  EXPECT_EQ(BodyCells(bodies::voxels({.x = 2, .y = 3, .z = 4}, {.stiffness = 50})).size(), 24);
  EXPECT_EQ(BodyCells(two_tetrahedra()).size(), 2);
}

TEST(BodyCells, AMirroredBodyIsInsideOutAndATurnedOneIsNot) {
  for (Robot robot : {bodies::voxels({}, {.stiffness = 50}), two_tetrahedra()}) {
    const BodyCells cells(robot);
    EXPECT_EQ(cells.folding(mirrored(robot.masses)).inverted, 1);
    bodies::rotate(robot, bodies::random_rotation(7));
    EXPECT_EQ(cells.folding(robot.masses).inverted, 0);
  }
}

TEST(BodyCells, TetrahedraCountWithTheirVolumes) {
  const Robot robot = two_tetrahedra();
  const BodyCells cells(robot);
  Positions positions = robot.masses;
  positions[4].z = 0.5f;  // through the triangle
  EXPECT_NEAR(cells.folding(positions).inverted, 0.75, 1e-6);
  positions = robot.masses;
  positions[3].z = -0.5f;
  EXPECT_NEAR(cells.folding(positions).inverted, 0.25, 1e-6);
}

// A tapered cell of eight joined masses, whose narrow end turns by a few degrees: the masses of a side leave their
// plane, and nothing is inside out. Pushed through the wide end, it is.
TEST(BodyCells, ATwistedTaperedCellIsNotInsideOut) {
  Robot robot{.materials = bodies::one_material({.stiffness = 50})};
  for (int corner = 0; corner < 8; ++corner) {
    const float wide = (corner & 1) != 0 ? 0.9f : 1.0f, high = (corner & 1) != 0 ? 0.95f : 1.0f;
    robot.masses.push_back({(corner & 1) != 0 ? 1.0f : 0.0f, (corner & 2) != 0 ? wide / 2 : -wide / 2,
                            (corner & 4) != 0 ? high / 2 : -high / 2});
  }
  for (std::uint16_t a = 0; a < 8; ++a)
    for (std::uint16_t b = a + 1; b < 8; ++b) robot.springs.push_back({a, b, 1, rest_distance(robot, a, b)});
  const BodyCells cells(robot);
  ASSERT_GT(cells.size(), 0u);
  for (const float angle : {-0.2f, 0.2f}) {
    Positions positions = robot.masses;
    for (Vec3& x : positions)
      if (x.x > 0.5f)
        x = {x.x, x.y * std::cos(angle) - x.z * std::sin(angle), x.y * std::sin(angle) + x.z * std::cos(angle)};
    EXPECT_EQ(cells.folding(positions).inverted, 0) << angle;
  }
  Positions positions = robot.masses;
  for (Vec3& x : positions)
    if (x.x > 0.5f) x.x = -1;
  EXPECT_GT(cells.folding(positions).inverted, 0.5);
}

// The last layer of masses of a bar goes beyond the layer before: the voxel between them is inside out.
TEST(BodyCells, VoxelsAreCountedOneByOne) {
  const Robot robot = bodies::voxels({.x = 5, .y = 1, .z = 2, .edge = 1}, {.stiffness = 50});
  const BodyCells cells(robot);
  Positions positions = robot.masses;
  for (Vec3& x : positions)
    if (x.x > 4.5f) x.x = 3.5f;
  EXPECT_NEAR(cells.folding(positions).inverted, 2.0 / 10, 1e-6);
  EXPECT_EQ(cells.folding(positions).overlap, 0) << "neighbors are no other part of the body";
}

// The end of a bar, made thinner, is bent into its first voxel.
TEST(BodyCells, MassesWithinOtherPartsOfTheBodyAreCounted) {
  const Robot robot = bodies::voxels({.x = 10, .y = 1, .z = 1, .edge = 1}, {.stiffness = 50});
  const BodyCells cells(robot);
  const Positions& rest = robot.masses;
  Positions positions = rest;
  int moved = 0;
  for (std::size_t i = 0; i < rest.size(); ++i)
    if (rest[i].x > 9.5f) {
      positions[i] = {0.5f, 0.3f + 0.4f * rest[i].y, 0.35f + 0.4f * rest[i].z};
      ++moved;
    }
  ASSERT_EQ(moved, 4);
  EXPECT_NEAR(cells.folding(positions).overlap, 4.0 / static_cast<double>(rest.size()), 1e-6);
  for (Vec3& x : positions) x = 3.0f * x + Vec3{100, -50, 7};  // wherever it is, and however large
  EXPECT_NEAR(cells.folding(positions).overlap, 4.0 / static_cast<double>(rest.size()), 1e-6);
}

// Masses of one box that lie in another one from the start, without a spring between them, do not count.
TEST(BodyCells, PartsThatAreInEachOtherAtRestDoNotCount) {
  Robot robot = two_tetrahedra();
  const Robot small = two_tetrahedra();
  const auto first = static_cast<std::uint16_t>(robot.masses.size());
  for (const Vec3& x : small.masses) robot.masses.push_back(0.1f * x + Vec3{0.2f, 0.2f, 0.1f});
  for (const Spring& spring : small.springs) {
    const auto a = static_cast<std::uint16_t>(first + spring.a), b = static_cast<std::uint16_t>(first + spring.b);
    robot.springs.push_back({a, b, 1, rest_distance(robot, a, b)});
  }
  const BodyCells cells(robot);
  EXPECT_EQ(cells.folding(robot.masses).overlap, 0);
  Positions positions = robot.masses;
  for (std::size_t i = first; i < positions.size(); ++i) positions[i].z -= 1;  // into the other tetrahedron
  // The lowest of the five was there at rest.
  EXPECT_NEAR(cells.folding(positions).overlap, 0.4, 1e-6);
}

class FoldingOn : public BackendTest {};
INSTANTIATE_TEST_SUITE_P(All, FoldingOn, every_device, BackendTest::name);

TEST_P(FoldingOn, TelemetryHasItWhereItIsAskedFor) {
  const std::vector<Robot> robots = {bodies::random_voxels({.x = 6, .y = 2, .z = 2}, 1), two_tetrahedra(),
                                     bodies::random_voxels({.x = 3, .y = 3, .z = 3}, 2)};
  Simulation simulation({.device = device()}, robots);
  EXPECT_TRUE(std::isnan(simulation.telemetry(0).inverted));
  const State start = bodies::shaken(robots[0], 0.2f, 1, 3);
  simulation.set_state(0, start.positions, start.velocities);
  simulation.measure_folding(true);
  const auto expect_measured = [&](std::span<const Telemetry> telemetry) {
    for (std::size_t i = 0; i < simulation.size(); ++i) {
      const Folding expected = BodyCells(simulation.robot(i)).folding(simulation.positions(i));
      EXPECT_EQ(telemetry[i].inverted, expected.inverted) << i;
      EXPECT_EQ(telemetry[i].overlap, expected.overlap) << i;
    }
  };
  EXPECT_GT(simulation.telemetry(0).inverted, 0);
  expect_measured(simulation.telemetry());
  const std::vector<Telemetry> samples = simulation.step_and_sample(20, 10);
  ASSERT_EQ(samples.size(), 6u);
  expect_measured(std::span(samples).last(3));
  simulation.keep(std::vector<std::size_t>{2, 0});
  expect_measured(simulation.telemetry());
  simulation.add(robots[1]);
  expect_measured(simulation.telemetry());
  simulation.measure_folding([&](const Robot& robot) {
    return robot.masses.size() == robots[0].masses.size() ? MeasuredFolding::inverted : MeasuredFolding::none;
  });
  const Telemetry shaken = simulation.telemetry(1);  // robots[0], since keep()
  EXPECT_EQ(shaken.inverted, BodyCells(robots[0]).folding(simulation.positions(1)).inverted);
  EXPECT_TRUE(std::isnan(shaken.overlap));
  EXPECT_TRUE(std::isnan(simulation.telemetry(0).inverted));
  simulation.add(robots);
  const std::vector<Telemetry> samples_of_some = simulation.step_and_sample(20, 10);
  ASSERT_EQ(samples_of_some.size(), 12u);
  for (std::size_t i = 0; i < simulation.size(); ++i) {
    const float inverted = samples_of_some[simulation.size() + i].inverted;
    if (simulation.robot(i).masses.size() == robots[0].masses.size())
      EXPECT_EQ(inverted, BodyCells(simulation.robot(i)).folding(simulation.positions(i)).inverted) << i;
    else
      EXPECT_TRUE(std::isnan(inverted)) << i;
  }
  // Voxels and tetrahedra, without overlap.
  simulation.measure_folding(std::function([](const Robot&) { return MeasuredFolding::inverted; }));
  float most = 0;
  for (std::size_t i = 0; i < simulation.size(); ++i) {
    const State folded = bodies::shaken(simulation.robot(i), 0.2f, 0, i);
    simulation.set_state(i, folded.positions, folded.velocities);
    const float inverted = simulation.telemetry(i).inverted;
    EXPECT_EQ(inverted, BodyCells(simulation.robot(i)).folding(folded.positions).inverted) << i;
    most = std::max(most, inverted);
  }
  EXPECT_GT(most, 0);
  simulation.measure_folding(false);
  EXPECT_TRUE(std::isnan(simulation.telemetry(0).overlap));
}

TEST_P(FoldingOn, MeasuringItChangesNoTrajectory) {
  const std::vector<Robot> robots = {bodies::random_voxels({}, 1), bodies::random_voxels({.x = 2, .y = 2, .z = 2}, 2)};
  Simulation plain({.device = device()}, robots), measured({.device = device()}, robots);
  measured.measure_folding(true);
  const std::vector<Telemetry> a = plain.step_and_sample(50, 10), b = measured.step_and_sample(50, 10);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i].center_of_mass, b[i].center_of_mass);
  EXPECT_EQ(plain.hashes(), measured.hashes());
  EXPECT_EQ(plain.steps(), measured.steps());
}

TEST_P(FoldingOn, AnEvaluationHasTheLargestOfItsSamples) {
  const auto robot = std::make_shared<const Robot>(bodies::random_voxels({.x = 6, .y = 2, .z = 2}, 1));
  const State start = bodies::shaken(*robot, 0.2f, 0, 3);
  EvaluationRequest request{.configuration = {.device = device()}, .steps = 40, .sample_every = 10};
  request.folding = [](const Robot&) { return MeasuredFolding::all; };
  request.start = [&](std::size_t, const Robot&, std::span<Vec3> positions) {
    std::ranges::copy(start.positions, positions.begin());
  };
  Evaluator evaluator(request, source_of({robot}), 1);
  const Evaluation result = evaluator.next().value();
  Simulation simulation(request.configuration, {&*robot, 1});
  simulation.reset_to(start.positions);
  simulation.measure_folding(true);
  double inverted = double{simulation.telemetry(0).inverted};
  for (const Telemetry& sample : simulation.step_and_sample(40, 10))
    inverted = std::max(inverted, double{sample.inverted});
  EXPECT_EQ(result.inverted, inverted);
  EXPECT_GT(inverted, 0);
  request.folding = nullptr;
  EXPECT_TRUE(std::isnan(Evaluator(request, source_of({robot}), 1).next().value().inverted));
}

}  // namespace
}  // namespace mercury
