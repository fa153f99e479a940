// SPDX-License-Identifier: Apache-2.0
// Against formulas of textbooks, against dense matrices, and against the force solver itself.
#include "mercury/body_properties.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "mercury/random.h"
#include "mercury/random_voxel.h"
#include "mercury/simulation.h"

namespace mercury {
namespace {

constexpr double pi = std::numbers::pi;

// Masses on a line, a spring between neighbors.
Robot chain(int count, float mass, float stiffness) {
  Robot robot{.materials = {{}, {stiffness}}};
  for (int i = 0; i < count; ++i) robot.masses.push_back({0.1f * static_cast<float>(i), 0, 0});
  for (int i = 0; i + 1 < count; ++i)
    robot.springs.push_back({static_cast<std::uint16_t>(i), static_cast<std::uint16_t>(i + 1), 1, 0.1f});
  robot.mass.assign(robot.masses.size(), mass);
  return robot;
}

Robot voxel_robot(std::uint64_t seed) {
  Robot robot = random_voxel_robot({.smallest = {3, 2, 2}, .largest = {4, 3, 2}}, seed);
  robot.materials.assign(materials_of(robot).begin(), materials_of(robot).end());
  return robot;
}

// K and D, with masses divided out: entry by entry, from the definition of a spring's force.
Eigen::MatrixXd matrix_of(const Robot& robot, bool of_damping) {
  const auto size = static_cast<Eigen::Index>(3 * robot.masses.size());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size, size);
  for (const Spring& spring : robot.springs) {
    Eigen::VectorXd way = Eigen::VectorXd::Zero(size);  // of the length, by each coordinate
    const Vec3 d = robot.masses[spring.b] - robot.masses[spring.a];
    const Eigen::Vector3d n = Eigen::Vector3d(d.x, d.y, d.z).normalized();
    way.segment<3>(3 * spring.a) = -n;
    way.segment<3>(3 * spring.b) = n;
    const Material& material = materials_of(robot)[spring.material];
    const double rate = of_damping ? double{material.relaxation_time} : 1;
    matrix += rate * material.stiffness * way * way.transpose();
  }
  Eigen::VectorXd root(size);
  for (Eigen::Index i = 0; i < size; ++i)
    root[i] = 1 / std::sqrt(double{mass_of(robot, static_cast<std::size_t>(i / 3))});
  return root.asDiagonal() * matrix * root.asDiagonal();
}

TEST(BodyProperties, AMassBetweenTwoSpringsVibratesWithTheRootOfTwoKPerM) {
  Robot robot = chain(3, 0.25f, 80);
  robot.mass[0] = 7;
  robot.fixed = {0, 2};
  const double w = std::sqrt(2 * 80 / 0.25);
  const BodyProperties found = body_properties(robot);
  EXPECT_NEAR(*found.lowest_frequency, w / (2 * pi), 1e-9 * w);
  EXPECT_NEAR(*found.largest_dt, 2 / w, 1e-9);
  EXPECT_NEAR(found.mass, 7.5, 1e-12);
}

TEST(BodyProperties, TwoMassesVibrateWithTheirReducedMass) {
  Robot robot = chain(2, 1, 30);
  robot.mass = {0.5f, 2};
  const double w = std::sqrt(30 * (1 / 0.5 + 1 / 2.0));
  const BodyProperties found = body_properties(robot);
  EXPECT_NEAR(*found.lowest_frequency, w / (2 * pi), 1e-9 * w);
  EXPECT_NEAR(*found.largest_dt, 2 / w, 1e-9);
}

// A chain also has motions that deform no spring: two for each mass, across it.
TEST(BodyProperties, AChainVibratesAsTheDispersionOfAChainSays) {
  for (const int count : {2, 3, 10, 100, 1000}) {
    const double k = 50, m = 0.5;
    const auto w = [&](int j) { return 2 * std::sqrt(k / m) * std::sin(j * pi / (2 * count)); };
    const BodyProperties found = body_properties(chain(count, static_cast<float>(m), static_cast<float>(k)));
    ASSERT_TRUE(found.lowest_frequency) << count;
    EXPECT_NEAR(*found.lowest_frequency, w(1) / (2 * pi), 1e-4 * w(1)) << count;
    EXPECT_NEAR(*found.largest_dt, 2 / w(count - 1), 5e-4 * 2 / w(count - 1)) << count;
  }
}

TEST(BodyProperties, AStiffnessScaleMultipliesEveryStiffness) {
  const Robot robot = voxel_robot(2);
  const BodyProperties once = body_properties(robot), scaled = body_properties(robot, 200);
  EXPECT_NEAR(*scaled.modulus, 200 * *once.modulus, 1e-6 * *scaled.modulus);
  EXPECT_NEAR(*scaled.lowest_frequency, std::sqrt(200) * *once.lowest_frequency, 1e-4 * *scaled.lowest_frequency);
  EXPECT_NEAR(*scaled.largest_dt, *once.largest_dt / std::sqrt(200), 1e-3 * *scaled.largest_dt);
  EXPECT_EQ(scaled.mass, once.mass);
}

TEST(BodyProperties, FrequenciesAreThoseOfDenseMatrices) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    Robot robot = voxel_robot(seed);
    Random random(seed);
    for (std::size_t i = 0; i < robot.masses.size(); ++i)
      robot.mass.push_back(static_cast<float>(random.uniform(0.2, 3)));
    const Eigen::VectorXd values =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix_of(robot, false), Eigen::EigenvaluesOnly).eigenvalues();
    const double largest = values[values.size() - 1];
    Eigen::Index first = 0;
    while (values[first] < 1e-9 * largest) ++first;
    ASSERT_GE(first, 6);
    const BodyProperties found = body_properties(robot);
    ASSERT_TRUE(found.lowest_frequency);
    EXPECT_NEAR(*found.lowest_frequency, std::sqrt(values[first]) / (2 * pi), 1e-4 * *found.lowest_frequency);
    EXPECT_NEAR(*found.largest_dt, 2 / std::sqrt(largest), 5e-4 * *found.largest_dt);
  }
}

TEST(BodyProperties, RelaxationShortensTheLargestStep) {
  Robot robot = chain(2, 1, 100);
  for (const float tau : {0.001f, 0.02f, 1.f}) {
    robot.materials[1].relaxation_time = tau;
    const double w = std::sqrt(200), t = double{tau};
    const double expected = -t + std::sqrt(t * t + 4 / (w * w));
    EXPECT_NEAR(*body_properties(robot).largest_dt, expected, 1e-6 * expected) << tau;
  }
}

// The largest root of z^2 - (2 - dt^2 A - dt B) z + (1 - dt B), by size.
double growth(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, double dt) {
  const Eigen::Index size = a.rows();
  const auto identity = Eigen::MatrixXd::Identity(size, size);
  Eigen::MatrixXd step(2 * size, 2 * size);
  step << 2 * identity - dt * dt * a - dt * b, -identity + dt * b, identity, Eigen::MatrixXd::Zero(size, size);
  return step.eigenvalues().cwiseAbs().maxCoeff();
}

// No vibration is one of stiffness and of damping alone here.
TEST(BodyProperties, TheLargestStepOfMixedRelaxationTimesIsWhereTheStepGrows) {
  Robot robot = random_voxel_robot({.smallest = {1, 1, 1}, .largest = {1, 1, 1}, .air = 0}, 1);
  robot.materials = {{}, {50}, {200, 0, 0, 0, false, 0.003f}, {80, 0, 0, 0, false, 0.08f}};
  for (std::size_t i = 0; i < robot.springs.size(); ++i) robot.springs[i].material = static_cast<MaterialId>(1 + i % 3);
  const Eigen::MatrixXd a = matrix_of(robot, false), b = matrix_of(robot, true);
  const double dt = *body_properties(robot).largest_dt;
  EXPECT_LT(growth(a, b, 0.999 * dt), 1 + 1e-6);  // rigid motions: a double root of 1
  EXPECT_GT(growth(a, b, 1.001 * dt), 1 + 1e-4);
}

// How many times its kinetic energy at the start a robot has after 2,000 steps that begin with small random velocities.
double energy_ratio(Robot robot, double dt) {
  Random random(3);
  const auto small = [&] { return static_cast<float>(1e-4 * random.normal()); };
  for (std::size_t i = 0; i < robot.masses.size(); ++i) robot.velocity.push_back({small(), small(), small()});
  for (Material& material : robot.materials) material.amplitude = 0;
  Configuration configuration{.dt = dt, .damping = 0, .environment = Environment{}};
  configuration.device = {.kind = DeviceKind::cpu, .threads = 1};
  Simulation simulation(configuration, std::span(&robot, 1));
  const double start = simulation.telemetry()[0].kinetic_energy;
  simulation.step(2000);
  const Telemetry end = simulation.telemetry()[0];
  return end.exploded ? INFINITY : end.kinetic_energy / start;
}

// Symplectic Euler keeps v^2 - dt w^2 x v + w^2 x^2 of a vibration, an ellipse on which v^2 is at most its value at x =
// 0 over 1 - (w dt / 2)^2. Above the largest step, only the limit of viscous forces keeps springs with a relaxation
// time from exploding.
TEST(BodyProperties, TheForceSolverIsStableUpToTheLargestStep) {
  for (const float tau : {0.f, 0.01f, 0.1f}) {
    Robot robot = voxel_robot(4);
    for (Material& material : robot.materials) material.relaxation_time = tau;
    const double dt = *body_properties(robot).largest_dt;
    EXPECT_LT(energy_ratio(robot, 0.99 * dt), 1 / (1 - 0.99 * 0.99)) << tau;
    EXPECT_GT(energy_ratio(robot, 1.01 * dt), 1000) << tau;
  }
}

// Edges, diagonals of sides and of the body: k a^2 (12 + 12 * 2 + 4 * 3) / (6 a^3).
TEST(BodyProperties, ACubeHasItsDensityAndTheModulusOfItsSprings) {
  Robot robot = random_voxel_robot({.smallest = {1, 1, 1}, .largest = {1, 1, 1}, .air = 0}, 1);
  robot.materials = {{}, {50}};
  for (Spring& spring : robot.springs) spring.material = 1;
  const BodyProperties unit = body_properties(robot);
  EXPECT_NEAR(unit.mass, 8, 1e-12);
  EXPECT_NEAR(*unit.density, 8000, 0.1);
  EXPECT_NEAR(*unit.modulus, 8 * 50 / 0.1, 0.1);
  robot.mass.assign(8, 0.125f);
  EXPECT_NEAR(*body_properties(robot).density, 1000, 0.01);
  std::swap(robot.faces[0].a, robot.faces[0].b);
  EXPECT_FALSE(body_properties(robot).density || body_properties(robot).modulus) << "its skin is not closed";
}

TEST(BodyProperties, WithoutSpringsThereAreNoVibrations) {
  const BodyProperties found = body_properties(Robot{.masses = {{0, 0, 0}, {1, 0, 0}}});
  EXPECT_EQ(found.mass, 2);
  EXPECT_FALSE(found.density || found.modulus || found.lowest_frequency || found.largest_dt);
  Robot robot = chain(2, 1, 10);
  robot.fixed = {0, 1};
  EXPECT_FALSE(body_properties(robot).largest_dt);
}

}  // namespace
}  // namespace mercury
