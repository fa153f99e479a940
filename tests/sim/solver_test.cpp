// SPDX-License-Identifier: Apache-2.0
// Springs in empty space: both solvers against theory.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "backend.h"
#include "bodies.h"
#include "reference.h"

namespace mercury {
namespace {

using reference::Vector;
using reference::vector_of;

Configuration springs_only(Solver solver, double dt, Device device) {
  return {.dt = dt, .damping = 0, .solver = solver, .environment = empty_space(), .device = device};
}

class Springs : public BackendTest {
 protected:
  Configuration springs_only(Solver solver, double dt = 1e-3) const {
    return mercury::springs_only(solver, dt, device());
  }
};
INSTANTIATE_TEST_SUITE_P(All, Springs, every_device, BackendTest::name);

constexpr float stiffness = 50;  // [N/m]
constexpr Material passive{stiffness, 0, 0, 0};

// Mean time between passages of the pair's length upward through its rest length [s], over `periods` passages.
double measured_period(Simulation& simulation, int periods) {
  const double dt = simulation.configuration().dt;
  double first = 0, last = 0, before = 0;
  for (int passages = -1; passages < periods;) {
    simulation.step();
    const auto x = simulation.positions(0);
    const double stretch = double{x[1].x} - double{x[0].x} - 1;
    if (before < 0 && stretch >= 0) {
      last = simulation.time() - dt * stretch / (stretch - before);
      if (++passages == 0) first = last;
    }
    before = stretch;
    if (simulation.time() > 100) return std::nan("");
  }
  return (last - first) / periods;
}

TEST_P(Springs, PeriodOfAPairOfMassesIsTwoPiRootOfOneOverTwoK) {
  const double period = 2 * std::numbers::pi * std::sqrt(1 / (2.0 * stiffness));
  for (const Solver solver : {Solver::force, Solver::xpbd}) {
    const Robot pair = bodies::pair(passive);
    Simulation simulation(springs_only(solver), {&pair, 1});
    simulation.set_state(0, std::vector<Vec3>{{-0.1f, 0, 0}, {1.1f, 0, 0}}, std::vector<Vec3>(2));
    EXPECT_NEAR(measured_period(simulation, 10), period, 1e-3 * period) << name_of(solver);
  }
}

struct Momenta {
  Vector linear = Vector::Zero(), angular = Vector::Zero();
};
Momenta momenta(const State& state) {
  Momenta sum;
  for (std::size_t i = 0; i < state.positions.size(); ++i) {
    sum.linear += vector_of(state.velocities[i]);
    sum.angular += vector_of(state.positions[i]).cross(vector_of(state.velocities[i]));
  }
  return sum;
}

TEST_P(Springs, MomentumOfAShakenMuscularRobotIsConservedToRounding) {
  const Robot robot = bodies::random_voxels({}, 1);
  const State start = bodies::shaken(robot, 0.02f, 1, 2);
  for (const Solver solver : {Solver::force, Solver::xpbd}) {
    Simulation simulation(springs_only(solver), {&robot, 1});
    simulation.set_state(0, start.positions, start.velocities);
    simulation.step(1000);
    const Momenta before = momenta(start), after = momenta(simulation.state(0));
    // 216 velocities of some 0.5 m/s, each rounded 1000 times to 24 bits, errors adding up as in a random walk:
    // 216^1/2 1000^1/2 3e-8 = 1.4e-5 kg m/s.
    EXPECT_LT((after.linear - before.linear).norm(), 5e-5) << name_of(solver);
    // Central forces at x^n conserve angular momentum. XPBD's act at the predicted positions, so only Algorithm 1
    // conserves it to rounding.
    if (solver == Solver::force) {
      EXPECT_LT((after.angular - before.angular).norm(), 5e-5);
    }
  }
}

TEST_P(Springs, EnergyIsConservedWithinOnePercentForTenSeconds) {
  const Robot lattice = bodies::voxels({.x = 3, .y = 2, .z = 2}, passive);
  State start = bodies::moving(lattice, {});
  for (Vec3& x : start.positions) x = {1.2f * x.x, x.y, x.z + 0.3f * x.x};  // stretched and sheared
  Simulation simulation(springs_only(Solver::force, 2.5e-4), {&lattice, 1});
  simulation.set_state(0, start.positions, start.velocities);
  const auto energy = [&] {
    const Telemetry telemetry = simulation.telemetry(0);
    return telemetry.kinetic_energy + telemetry.elastic_energy;
  };
  const double before = energy();
  double least_kinetic = before, most_kinetic = 0;
  for (int look = 0; look < 400; ++look) {
    simulation.step(100);
    EXPECT_NEAR(energy(), before, 0.01 * before) << "at " << simulation.time() << " s";
    least_kinetic = std::min(least_kinetic, simulation.telemetry(0).kinetic_energy);
    most_kinetic = std::max(most_kinetic, simulation.telemetry(0).kinetic_energy);
  }
  EXPECT_GT(most_kinetic - least_kinetic, 0.2 * before);  // elastic and kinetic energy did exchange
}

// XPBD is unconditionally stable: after a long first step that moves the masses far, the springs remove the energy.
TEST_P(Springs, XpbdLosesEnergyAtAnyTimeStep) {
  const Robot lattice = bodies::voxels({.x = 3, .y = 2, .z = 2}, passive);
  const State start = bodies::shaken(lattice, 0.02f, 0.5f, 5);
  for (const double dt : {1e-3, 1e-2, 1e-1, 1.0}) {
    Simulation simulation(springs_only(Solver::xpbd, dt), {&lattice, 1});
    simulation.set_state(0, start.positions, start.velocities);
    const auto energy = [&] {
      const Telemetry telemetry = simulation.telemetry(0);
      return telemetry.kinetic_energy + telemetry.elastic_energy;
    };
    const double before = energy();
    simulation.step(25);
    const double first = energy();
    if (dt <= 1e-2) {
      EXPECT_LT(first, 1.001 * before) << "dt " << dt;
    }
    for (int look = 0; look < 40; ++look) {
      simulation.step(25);
      EXPECT_LT(energy(), 1.001 * first) << "dt " << dt << ", " << simulation.time() << " s";
    }
    EXPECT_LT(energy(), 0.9 * before) << "dt " << dt;
  }
}

TEST_P(Springs, DampingShrinksVelocitiesExponentially) {
  const Robot point = bodies::point();
  for (const Solver solver : {Solver::force, Solver::xpbd}) {
    Configuration configuration = springs_only(solver);
    configuration.damping = 0.7;
    Simulation simulation(configuration, {&point, 1});
    simulation.set_state(0, std::vector<Vec3>(1), std::vector<Vec3>{{2, -1, 0.5f}});
    simulation.step(1000);
    const Vec3 v = simulation.state(0).velocities[0];
    EXPECT_NEAR(v.x, 2 * std::exp(-0.7), 2e-5);
    EXPECT_NEAR(v.y, -1 * std::exp(-0.7), 1e-5);
  }
}

TEST_P(Springs, AFallIsAParabola) {
  const Robot point = bodies::point();
  for (const Solver solver : {Solver::force, Solver::xpbd}) {
    Configuration configuration = springs_only(solver);
    configuration.environment = OceanSimple{.point_drag = 0, .gravity = {1, 0, -9.81f}};
    Simulation simulation(configuration, {&point, 1});
    simulation.step(1000);
    const State state = simulation.state(0);
    // Steps of v then x: x_n = g dt^2 n (n + 1) / 2.
    EXPECT_NEAR(state.positions[0].z, -9.81 / 2 * 1.001, 1e-4);
    EXPECT_NEAR(state.positions[0].x, 0.5 * 1.001, 1e-5);
    EXPECT_NEAR(state.velocities[0].z, -9.81, 1e-4);
  }
}

// Largest distance between the two solvers' positions of the same masses after `seconds`.
double distance_of_solvers(const Robot& robot, const State& start, double dt, double seconds, Device device) {
  std::vector<std::vector<Vec3>> ends;
  for (const Solver solver : {Solver::force, Solver::xpbd}) {
    Simulation simulation(springs_only(solver, dt, device), {&robot, 1});
    simulation.set_state(0, start.positions, start.velocities);
    simulation.step(std::llround(seconds / dt));
    ends.push_back(simulation.positions(0));
  }
  double largest = 0;
  for (std::size_t i = 0; i < ends[0].size(); ++i) largest = std::max(largest, double{length(ends[0][i] - ends[1][i])});
  return largest;
}

// Both solvers are of first order, and XPBD's predicted positions differ from x^n by dt v^n. So halving dt halves the
// distance.
TEST_P(Springs, XpbdConvergesToTheForceSolverWithOrderOne) {
  const Robot robot = bodies::random_voxels({.x = 3, .y = 2, .z = 2}, 7);
  State start = bodies::moving(robot, {});
  for (std::size_t i = 0; i < start.positions.size(); ++i) {
    Vec3& x = start.positions[i];
    x = {1.1f * x.x, x.y, x.z + 0.2f * x.x};
    start.velocities[i] = {0, x.x, 0};
  }
  double coarser = 0;
  for (const double dt : {2e-3, 1e-3, 5e-4, 2.5e-4}) {
    const double distance = distance_of_solvers(robot, start, dt, 0.5, device());
    if (coarser > 0) {
      EXPECT_NEAR(coarser / distance, 2, 0.2) << "dt " << dt;
    }
    coarser = distance;
  }
}

}  // namespace
}  // namespace mercury
