// SPDX-License-Identifier: Apache-2.0
// Robots with masses of their own, fixed masses and viscous springs, and resistive water: against theory.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <numbers>
#include <vector>

#include "backend.h"
#include "bodies.h"
#include "mercury/simulation.h"
#include "reference.h"

namespace mercury {
namespace {

using reference::Reference;

class RealBody : public BackendTest {
 protected:
  Configuration configuration(const Environment& environment, double damping = 0) const {
    Configuration made;
    made.damping = damping;
    made.environment = environment;
    made.device = device();
    return made;
  }
};
INSTANTIATE_TEST_SUITE_P(All, RealBody, every_device, BackendTest::name);

Environment space() { return {}; }
Environment space_with_gravity(Vec3 gravity) {
  Environment environment;
  environment.gravity = gravity;
  return environment;
}
Environment resistive(const ResistiveDrag& water, Vec3 gravity = {}) {
  Environment environment;
  environment.water = water;
  environment.gravity = gravity;
  return environment;
}

// A body of voxels with this density [kg/m3]: each voxel gives an eighth of its mass to each corner.
Robot body_of(const bodies::Grid& grid, float stiffness, float density, float relaxation_time = 0) {
  Robot robot = bodies::voxels(grid, {.stiffness = stiffness, .relaxation_time = relaxation_time});
  robot.mass.assign(robot.masses.size(), 0);
  const auto at = [&](float x, float corner) { return std::lround((x - corner) / grid.edge); };
  for (std::size_t i = 0; i < robot.masses.size(); ++i) {
    const Vec3 x = robot.masses[i];
    const auto voxels = [](long place, int size) { return place == 0 || place == size ? 1.0f : 2.0f; };
    robot.mass[i] = density * grid.edge * grid.edge * grid.edge / 8 * voxels(at(x.x, grid.corner.x), grid.x) *
                    voxels(at(x.y, grid.corner.y), grid.y) * voxels(at(x.z, grid.corner.z), grid.z);
  }
  return robot;
}

TEST_P(RealBody, AMassFallsAsGravitySaysWhateverItWeighs) {
  Robot robot = bodies::pair({.stiffness = 50});
  robot.mass = {0.2f, 3};
  robot.velocity = {{0, 0, 1}, {0, 0, 1}};
  Simulation simulation(configuration(space_with_gravity({0, 0, -9.81f})), {&robot, 1});
  simulation.step(1000);
  // Symplectic Euler: v = v0 - g t, x = v0 t - g t (t + dt) / 2.
  for (const Vec3 v : simulation.state(0).velocities) EXPECT_NEAR(v.z, 1 - 9.81, 1e-3);
  for (const Vec3 x : simulation.positions(0)) EXPECT_NEAR(x.z, 1 - 9.81 * 1.001 / 2, 1e-3);
}

TEST_P(RealBody, TwoMassesOscillateAtTheFrequencyOfTheirReducedMass) {
  Robot robot = bodies::pair({.stiffness = 50});
  robot.mass = {0.5f, 2};
  const double reduced = 0.5 * 2 / 2.5, omega = std::sqrt(50 / reduced), dt = 1e-3;
  for (const Solver solver : {Solver::force, Solver::xpbd}) {
    Configuration setting = configuration(space());
    setting.solver = solver;
    Simulation simulation(setting, {&robot, 1});
    const std::array start{Vec3{-0.1f, 0, 0}, Vec3{1, 0, 0}}, rest{Vec3{}, Vec3{}};
    simulation.set_state(0, start, rest);
    // A quarter of a period later the spring has its rest length.
    simulation.step(std::llround(std::numbers::pi / 2 / omega / dt));
    const auto x = simulation.positions(0);
    EXPECT_NEAR(length(x[1] - x[0]), 1, 2e-3) << name_of(solver);
    // The center of mass has not moved.
    EXPECT_NEAR((0.5 * x[0].x + 2 * x[1].x) / 2.5, (-0.05 + 2) / 2.5, 1e-6) << name_of(solver);
  }
}

// Where voxels of several materials share an edge, each of them has a spring there.
TEST_P(RealBody, AnyNumberOfSpringsBetweenTwoMassesAddUp) {
  std::vector<Robot> robots;
  std::vector<double> forces;  // [N]
  for (int count = 1; count <= 5; ++count) {
    Robot robot = bodies::voxels({.x = 2, .y = 1, .z = 1}, {.stiffness = 0});
    robot.materials.resize(2);
    double force = 0;
    for (int i = 0; i < count; ++i) {
      const auto id = static_cast<MaterialId>(robot.materials.size());
      robot.materials.push_back({.stiffness = 100.0f * static_cast<float>(i + 1)});
      robot.springs.push_back({0, 1, id, 2 * rest_distance(robot, 0, 1)});
      force += 100.0 * (i + 1) * static_cast<double>(rest_distance(robot, 0, 1));
    }
    robots.push_back(robot);
    forces.push_back(force);
  }
  const auto expect_forces = [&](std::span<const Robot> batch, std::size_t first) {
    Simulation simulation(configuration(space()), batch);
    simulation.step(1);
    for (std::size_t i = 0; i < batch.size(); ++i) {
      const double dt = 1e-3;
      const double found = static_cast<double>(length(simulation.state(i).velocities[0])) / dt;
      EXPECT_NEAR(found, forces[first + i], 1e-3 * forces[first + i]) << first + i + 1 << " springs";
    }
  };
  for (std::size_t i = 0; i < robots.size(); ++i) expect_forces({&robots[i], 1}, i);
  expect_forces(robots, 0);
}

// They took 90 s while each cost time for all others.
TEST(CpuRobot, AFileWithManySpringsBetweenTwoMassesIsSimulatedSoon) {
  Robot robot = bodies::voxels({.x = 2, .y = 1, .z = 1}, {});
  robot.springs.insert(robot.springs.end(), 400'000, robot.springs.front());
  const std::clock_t start = std::clock();
  Simulation simulation(Configuration{.device = {.kind = DeviceKind::cpu}}, {&robot, 1});
  simulation.step(1);
  EXPECT_LT(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC, 20);
}

TEST_P(RealBody, AFixedMassStaysAndHoldsTheOther) {
  Robot robot = bodies::pair({.stiffness = 400, .relaxation_time = 0.02f});
  robot.mass = {1, 2};
  robot.fixed = {0};
  for (const Solver solver : {Solver::force, Solver::xpbd}) {
    Configuration setting = configuration(space_with_gravity({5, 0, 0}));
    setting.solver = solver;
    Simulation simulation(setting, {&robot, 1});
    simulation.step(5000);
    const auto x = simulation.positions(0);
    EXPECT_EQ(x[0], robot.masses[0]);
    EXPECT_NEAR(x[1].x, 1 + 2 * 5.0 / 400, 1e-4) << name_of(solver);  // m g / k
  }
}

// m x'' = -2 k (x + tau x'), with x the stretch and 1 kg at both ends.
TEST_P(RealBody, AViscousSpringDecaysAsADampedOscillator) {
  const double k = 50, tau = 0.02, omega2 = 2 * k, rate = tau * omega2 / 2, dt = 2e-4;
  const Robot robot = bodies::pair({.stiffness = static_cast<float>(k), .relaxation_time = static_cast<float>(tau)});
  for (const Solver solver : {Solver::force, Solver::xpbd}) {
    Configuration setting = configuration(space());
    setting.dt = dt;
    setting.solver = solver;
    Simulation simulation(setting, {&robot, 1});
    const std::array start{Vec3{-0.05f, 0, 0}, Vec3{1.05f, 0, 0}}, rest{Vec3{}, Vec3{}};
    simulation.set_state(0, start, rest);
    const double damped = std::sqrt(omega2 - rate * rate);
    for (int n = 1; n <= 10; ++n) {
      simulation.step(500);
      const double t = 500 * n * dt;
      const double expected = 0.1 * std::exp(-rate * t) * (std::cos(damped * t) + rate / damped * std::sin(damped * t));
      const auto x = simulation.positions(0);
      EXPECT_NEAR(static_cast<double>(length(x[1] - x[0])) - 1, expected, 2e-3) << name_of(solver) << " " << t;
    }
  }
}

// The form x + tau v, which costs less, stretches what turns; this must not.
TEST_P(RealBody, ViscosityDoesNotSlowASpinningBody) {
  const double omega = 5;
  const Robot robot = bodies::pair({.stiffness = 2000, .relaxation_time = 0.03f});
  // At the length where the spring holds what turns: k (l - 1) = m omega^2 l / 2.
  const double length_now = 2000 / (2000 - omega * omega / 2);
  Configuration setting = configuration(space());
  setting.dt = 1e-4;
  Simulation simulation(setting, {&robot, 1});
  const auto half = static_cast<float>(length_now / 2), speed = static_cast<float>(omega * length_now / 2);
  const std::array start{Vec3{-half, 0, 0}, Vec3{half, 0, 0}}, velocities{Vec3{0, -speed, 0}, Vec3{0, speed, 0}};
  simulation.set_state(0, start, velocities);
  simulation.step(100000);  // eight turns
  const State end = simulation.state(0);
  const Vec3 d = end.positions[1] - end.positions[0], v = end.velocities[1] - end.velocities[0];
  EXPECT_NEAR(length(cross(d, v)) / dot(d, d), omega, 1e-3 * omega);
}

TEST_P(RealBody, AFreeBodyInAFlowEndsAtTheFlowsSpeed) {
  const Robot robot = body_of({.x = 2, .y = 2, .z = 2}, 200, 1000, 0.01f);
  const Vec3 flow{0.1f, 0, 0.05f};
  const auto check = [&](const Environment& environment, double damping) {
    Simulation simulation(configuration(environment, damping), {&robot, 1});
    simulation.step(400000);  // without damping, the speed that is left falls as 1 / t
    EXPECT_LT(length(simulation.telemetry(0).velocity - flow), 0.01f * length(flow))
        << name_of(environment) << " " << damping;
  };
  check(Ocean{.flow = flow}, 0.1);
  check(resistive({.flow = flow}), 0);
  check(resistive({.flow = flow}), 0.1);
}

// rho A / 2 (2 C_N + 4 C_T) v^2: a cube that sinks across two of its sides and along four. The mean speed in the last
// quarter of a time constant, before the cube turns: on an edge it sinks faster.
TEST_P(RealBody, ACubeSinksAtItsTerminalSpeedFromAMillimeterToMetersPerSecond) {
  struct Case {
    double side, stiffness, speed;
  };
  const double density = 1200;
  const ResistiveDrag water{};
  for (const auto& [side, stiffness, speed] :
       {Case{0.1, 10, 1e-3}, {0.1, 1e3, 1e-3}, {0.1, 1e3, 0.03}, {0.4, 1e4, 1e-3}, {0.4, 1e5, 0.01}, {0.4, 1e5, 3}}) {
    const Robot robot = body_of({.x = 2, .y = 2, .z = 2, .edge = static_cast<float>(side / 2)},
                                static_cast<float>(stiffness), static_cast<float>(density), 1e-4f);
    const double volume = side * side * side, area = side * side, lightest = density * volume / 64;
    const double drag =
        water.density / 2.0 * area * (2.0 * water.normal_coefficient + 4.0 * water.tangential_coefficient);
    const double gravity = drag * speed * speed / ((density - water.density) * volume);
    const double time_constant = (density + water.added_mass_coefficient * water.density) * volume / (drag * speed);
    Configuration setting = configuration(resistive(water, {0, 0, static_cast<float>(-gravity)}));
    // Long steps: in each, a slow body should move by many of the distances between floats.
    setting.dt = std::min({0.01, 0.5 / std::sqrt(17 * stiffness / lightest), time_constant / 200});
    Simulation simulation(setting, {&robot, 1});
    const std::vector<Vec3> almost(robot.masses.size(), Vec3{0, 0, static_cast<float>(-0.99 * speed)});
    simulation.set_state(0, robot.masses, almost);
    const auto steps = std::llround(time_constant / 100 / setting.dt);
    simulation.step(75 * steps);
    double found = 0;
    for (const Telemetry& sample : simulation.step_and_sample(25 * steps, steps)) found -= sample.velocity.z / 25;
    EXPECT_NEAR(found / speed, 1, 0.01) << "k " << stiffness << " N/m, " << speed << " m/s";
  }
}

TEST_P(RealBody, BuoyancyCarriesWhatIsAsDenseAsWaterAndLiftsWhatIsLighter) {
  for (const double density : {1000.0, 500.0}) {
    const Robot robot = body_of({.x = 2, .y = 2, .z = 2}, 500, static_cast<float>(density), 0.01f);
    const ResistiveDrag water{.normal_coefficient = 0, .tangential_coefficient = 0};
    Simulation simulation(configuration(resistive(water, {0, 0, -9.81f})), {&robot, 1});
    simulation.step(500);
    // (rho_body + C_A rho) a = (rho - rho_body) g
    const double expected = (1000 - density) / (density + 0.5 * 1000) * 9.81 * 0.5;
    // The mean velocity of the inertia; that of the mass differs while the body is pulled at its skin.
    EXPECT_NEAR(simulation.telemetry(0).velocity.z, expected, 0.03 * expected + 1e-3) << density;
  }
}

// The lowest bending frequency of a free bar: its water moves along with it.
TEST_P(RealBody, ABarVibratesMoreSlowlyWithTheWaterThatItMoves) {
  const float density = 1700;
  const bodies::Grid grid{.x = 12, .y = 1, .z = 1};
  const Robot robot = body_of(grid, 400, density);
  const auto period = [&](float water_density) {
    const ResistiveDrag water{.density = water_density, .normal_coefficient = 0, .tangential_coefficient = 0};
    Simulation simulation(configuration(resistive(water)), {&robot, 1});
    // About the first mode: a parabola without motion of the center.
    std::vector<Vec3> velocities;
    double mean = 0;
    const double half = static_cast<double>(grid.edge) * grid.x / 2;
    for (const Vec3 x : robot.masses) {
      const double s = (x.x - half) / half;
      velocities.push_back({0, 0, static_cast<float>(0.02 * s * s)});
      mean += 0.02 * s * s / static_cast<double>(robot.masses.size());
    }
    for (Vec3& v : velocities) v.z -= static_cast<float>(mean);
    simulation.set_state(0, robot.masses, velocities);
    // Times at which the ends pass the middle upward.
    std::vector<double> crossings;
    double last = 0;
    for (int step = 0; step < 40000 && crossings.size() < 9; ++step) {
      simulation.step(1);
      const auto x = simulation.positions(0);
      double end = 0, middle = 0;
      int ends = 0, middles = 0;
      for (std::size_t i = 0; i < x.size(); ++i) {
        const double s = std::abs((robot.masses[i].x - half) / half);
        if (s > 0.99) end += x[i].z, ++ends;
        if (s < 0.01) middle += x[i].z, ++middles;
      }
      const double bend = end / ends - middle / middles;
      if (last < 0 && bend >= 0) crossings.push_back(step - bend / (bend - last));
      last = bend;
    }
    return crossings.size() < 9 ? 0.0 : (crossings.back() - crossings.front()) / 8;
  };
  const double expected = std::sqrt(density / (density + 0.5 * 1000));
  EXPECT_NEAR(period(0) / period(1000), expected, 0.05 * expected);
}

// Two cubes that no spring joins, flying at each other.
TEST_P(RealBody, BodiesDoNotPassThroughThemselvesInWater) {
  Robot robot = body_of({.x = 2, .y = 2, .z = 2}, 2000, 1000, 0.005f);
  const Robot other = body_of({.x = 2, .y = 2, .z = 2, .corner = {0.35f, 0.05f, 0.05f}}, 2000, 1000, 0.005f);
  const auto first = static_cast<std::uint16_t>(robot.masses.size());
  robot.masses.insert(robot.masses.end(), other.masses.begin(), other.masses.end());
  robot.mass.insert(robot.mass.end(), other.mass.begin(), other.mass.end());
  for (Spring spring : other.springs) {
    spring.a = static_cast<std::uint16_t>(spring.a + first);
    spring.b = static_cast<std::uint16_t>(spring.b + first);
    robot.springs.push_back(spring);
  }
  for (const Face& face : other.faces)
    robot.faces.push_back({static_cast<std::uint16_t>(face.a + first), static_cast<std::uint16_t>(face.b + first),
                           static_cast<std::uint16_t>(face.c + first)});
  for (std::size_t i = 0; i < robot.masses.size(); ++i) robot.velocity.push_back({i < first ? 0.5f : -0.5f, 0, 0});
  Water water;
  water.drag.density = 100;  // so that they meet
  Simulation simulation(configuration(water), {&robot, 1});
  float nearest = 1;
  for (int n = 0; n < 100; ++n) {
    simulation.step(20);
    const auto x = simulation.positions(0);
    Vec3 left, right;
    for (std::size_t i = 0; i < x.size(); ++i) (i < first ? left : right) += (1.0f / static_cast<float>(first)) * x[i];
    nearest = std::min(nearest, right.x - left.x);
  }
  EXPECT_LT(nearest, 0.29f);  // they met: 0.2 m wide, with a contact distance of 0.09 m
  EXPECT_GT(nearest, 0.2f);   // and stayed apart
  EXPECT_FALSE(simulation.telemetry(0).exploded);
}

// A plate on a slope, as gravity that leans.
TEST_P(RealBody, AnElasticPlateHoldsBelowItsFrictionAndSlidesAbove) {
  const Robot robot = body_of({.x = 6, .y = 6, .z = 1}, 3000, 1000, 0.01f);
  const double friction = 0.8;
  const auto speed_at = [&](double slope) {
    const double angle = std::atan(slope);
    Environment land =
        Land{.gravity = {static_cast<float>(9.81 * std::sin(angle)), 0, static_cast<float>(-9.81 * std::cos(angle))},
             .friction = static_cast<float>(friction),
             .stiffness_scale = 1};
    Simulation simulation(configuration(land), {&robot, 1});
    simulation.step(2000);
    const float before = simulation.telemetry(0).center_of_mass.x;
    simulation.step(2000);
    return (simulation.telemetry(0).center_of_mass.x - before) / 2;
  };
  EXPECT_LT(speed_at(0.98 * friction), 1e-3);
  // Above, it accelerates by g (sin - mu cos).
  const double angle = std::atan(1.02 * friction), a = 9.81 * (std::sin(angle) - friction * std::cos(angle));
  EXPECT_GT(speed_at(1.02 * friction), 0.5 * a * 3);
}

// All of it at once, and a mixed batch: the robot does as it does alone.
TEST_P(RealBody, ARealRobotInABatchWithOthersMovesAsItDoesAlone) {
  Robot real = bodies::random_voxels({.x = 3, .y = 2, .z = 2}, 5);
  real.materials.assign(default_materials().begin(), default_materials().end());
  for (Material& material : real.materials) material.relaxation_time = 0.005f;
  for (std::size_t i = 0; i < real.masses.size(); ++i) real.mass.push_back(0.5f + 0.05f * static_cast<float>(i));
  const Robot paper = bodies::random_voxels({.x = 3, .y = 2, .z = 2}, 5);
  for (const Environment& environment : {Environment(Ocean{}), Environment(Water{}), Environment(Land{})}) {
    Simulation alone(configuration(environment, 0.1), {&real, 1}),
        as_in_the_paper(configuration(environment, 0.1), {&paper, 1});
    const std::array robots{paper, real, paper};
    Simulation together(configuration(environment, 0.1), robots);
    for (Simulation* simulation : {&alone, &as_in_the_paper, &together}) simulation->step(300);
    EXPECT_EQ(together.hash(1), alone.hash(0)) << name_of(environment);
    EXPECT_EQ(together.hash(0), as_in_the_paper.hash(0)) << name_of(environment);
    EXPECT_EQ(together.hash(2), as_in_the_paper.hash(0)) << name_of(environment);
  }
}

// A GPU arranges robots of one topology alike, which must not make a robot depend on another one's shape.
TEST_P(RealBody, ARobotMovesAsItDoesAloneBesideOneOfItsTopologyAndAnotherShape) {
  const Robot robot = body_of({.x = 3, .y = 2, .z = 3}, 2000, 1000, 0.005f);
  Robot upside_down = robot;
  for (Vec3& x : upside_down.masses) x = {x.x, -x.y, -x.z};
  const Configuration setting = configuration(resistive({.flow = {0.3f, 0.2f, -0.1f}}));
  const std::array both{upside_down, robot};
  Simulation alone(setting, {&robot, 1}), together(setting, both);
  const State moving = bodies::shaken(robot, 0.002f, 0.3f, 1);
  alone.set_state(0, moving);
  together.set_state(1, moving);
  for (Simulation* simulation : {&alone, &together}) simulation->step(200);
  EXPECT_EQ(together.hash(1), alone.hash(0));
}

class RealAgreement : public EveryPair {};
INSTANTIATE_TEST_SUITE_P(All, RealAgreement,
                         testing::Combine(every_device, testing::Values(Solver::force, Solver::xpbd),
                                          testing::Values("ocean", "land", "water", "ocean-simple",
                                                          "resistive+ground")),
                         EveryPair::name);

TEST_P(RealAgreement, ARobotWithMassesViscosityAndAFixedPointFollowsTheReference) {
  Robot robot = bodies::random_voxels({.x = 4, .y = 3, .z = 3}, 8);
  robot.materials.assign(default_materials().begin(), default_materials().end());
  for (std::size_t id = 1; id < robot.materials.size(); ++id)
    robot.materials[id].relaxation_time = 0.002f * static_cast<float>(id % 5);
  for (std::size_t i = 0; i < robot.masses.size(); ++i) robot.mass.push_back(0.8f + 0.3f * static_cast<float>(i % 4));
  robot.fixed = {static_cast<std::uint16_t>(robot.masses.size() - 1)};
  Configuration setting = configuration();
  setting.damping = 0.2;
  if (auto* water = std::get_if<ResistiveDrag>(&setting.environment.water)) water->flow = {0.2f, 0.1f, -0.1f};
  Simulation simulation(setting, {&robot, 1});
  Reference expected(setting, robot);
  const double tolerance = has_ground(setting.environment) ? 1e-3 : 1e-4;
  for (int look = 0; look < 10; ++look) {
    simulation.step(100);
    expected.step(100);
    ASSERT_LT(reference::largest_deviation(expected.positions(), simulation.positions(0)), tolerance) << look;
  }
  const Telemetry telemetry = simulation.telemetry(0);
  EXPECT_NEAR(telemetry.kinetic_energy, expected.kinetic_energy(), 0.01 * expected.kinetic_energy() + 1e-6);
  const reference::Vector center = expected.center_of_mass();
  EXPECT_NEAR(telemetry.center_of_mass.x, center.x(), tolerance);
  EXPECT_NEAR(telemetry.center_of_mass.z, center.z(), tolerance);
}

}  // namespace
}  // namespace mercury
