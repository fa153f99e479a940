// SPDX-License-Identifier: Apache-2.0
// Water: drag and lift on faces (paper, equation 1) and drag on masses.
#include <gtest/gtest.h>

#include <cmath>

#include "backend.h"
#include "bodies.h"
#include "reference.h"

namespace mercury {
namespace {

using reference::Vector;
using reference::vector_of;

constexpr float voxel_edge = 0.1f;  // [m]
constexpr Material stiff{5000, 0, 0, 0}, soft{50, 0, 0, 0};

class Water : public BackendTest {
 protected:
  Configuration water(const Ocean& ocean, double dt = 1e-3, Solver solver = Solver::force) const {
    return {.dt = dt, .damping = 0, .solver = solver, .environment = ocean, .device = device()};
  }
};
INSTANTIATE_TEST_SUITE_P(All, Water, every_device, BackendTest::name);

Robot cube(std::uint64_t orientation, const Material& material = stiff) {
  Robot robot = bodies::voxels({.x = 1, .y = 1, .z = 1, .edge = voxel_edge}, material);
  bodies::rotate(robot, bodies::random_rotation(orientation));
  return robot;
}

// Area of the shadow that a closed convex body casts along a direction [m2]: half of sum A |n.direction|.
double shadow(const Robot& robot, const Vector& direction) {
  double sum = 0;
  for (const Face& face : robot.faces) {
    const Vector a = vector_of(robot.masses[face.a]), b = vector_of(robot.masses[face.b]),
                 c = vector_of(robot.masses[face.c]);
    sum += std::abs((b - a).cross(c - a).dot(direction)) / 2;
  }
  return sum / 2;
}

Vector mean_velocity(const Simulation& simulation, std::size_t robot) {
  Vector sum = Vector::Zero();
  const auto velocities = simulation.state(robot).velocities;
  for (const Vec3 v : velocities) sum += vector_of(v);
  return sum / static_cast<double>(velocities.size());
}

// A triangle of its own on three masses, moving along its normal: F = rho A C_D |v|^2 / 2, a third to each mass.
TEST_P(Water, EachOfManyLooseTrianglesFeelsItsDrag) {
  Robot robot;
  for (int i = 0; i < 500; ++i) {
    const auto first = static_cast<std::uint16_t>(robot.masses.size());
    const float x = 0.5f * static_cast<float>(i % 25), y = 0.5f * static_cast<float>(i / 25);
    for (const Vec3 corner : {Vec3{0, 0, 0}, Vec3{0.4f, 0, 0}, Vec3{0, 0.4f, 0}})
      robot.masses.push_back(corner + Vec3{x, y, 0});
    robot.faces.push_back({first, static_cast<std::uint16_t>(first + 1), static_cast<std::uint16_t>(first + 2)});
  }
  constexpr double dt = 1e-3, area = 0.08;
  Simulation simulation(water({.drag_coefficient = 1, .lift_coefficient = 0}, dt), std::span(&robot, 1));
  const State start = bodies::moving(robot, {0, 0, -2});
  simulation.set_state(0, start.positions, start.velocities);
  simulation.step();
  const double expected = -2 + dt * (1000 * area * 1 * 4 / 2) / 3;
  const std::vector<Vec3> velocities = simulation.state(0).velocities;
  for (std::size_t i = 0; i < velocities.size(); ++i) ASSERT_NEAR(velocities[i].z, expected, 1e-5) << "mass " << i;
}

// Over a body that moves rigidly, the sum of F.u is rho C_D |u|^3 times the shadow. C_L does not matter: lift is
// perpendicular to u.
TEST_P(Water, DragOnATowedCubeTakesThePowerOfItsShadowAtAnyLift) {
  std::vector<Robot> robots;
  for (std::uint64_t orientation = 0; orientation < 60; ++orientation) robots.push_back(cube(orientation, soft));
  const Vec3 velocity{0.6f, -1.1f, 0.8f};
  constexpr double dt = 0.02;  // [s], long, so that the change of velocity is far above float rounding
  const Vector v = vector_of(velocity);
  for (const float lift : {0.0f, 0.2f, 0.7f, 1.0f, 1.5f, 3.0f}) {
    Simulation simulation(water({.drag_coefficient = 1, .lift_coefficient = lift}, dt), robots);
    for (std::size_t i = 0; i < robots.size(); ++i) {
      const State start = bodies::moving(robots[i], velocity);
      simulation.set_state(i, start.positions, start.velocities);
    }
    simulation.step();
    for (std::size_t i = 0; i < robots.size(); ++i) {
      const Vector force = 8 * (mean_velocity(simulation, i) - v) / dt;
      const double power = force.dot(v);
      EXPECT_LT(power, 0) << "lift " << lift << ", orientation " << i;
      const double expected = -1000 * std::pow(v.norm(), 3) * shadow(robots[i], v.normalized());
      EXPECT_NEAR(power, expected, 1e-3 * std::abs(expected)) << "lift " << lift << ", orientation " << i;
    }
  }
}

TEST_P(Water, TowedCubeIsSlowedAndNeverSpedUpAtAnyLift) {
  std::vector<Robot> robots;
  for (std::uint64_t orientation = 0; orientation < 40; ++orientation) robots.push_back(cube(orientation));
  const Vec3 velocity{1.5f, 0, 0};
  for (const float lift : {0.0f, 0.2f, 0.5f, 1.0f, 2.0f}) {
    Simulation simulation(water({.drag_coefficient = 1, .lift_coefficient = lift}), robots);
    std::vector<double> energy;
    for (std::size_t i = 0; i < robots.size(); ++i) {
      const State start = bodies::moving(robots[i], velocity);
      simulation.set_state(i, start.positions, start.velocities);
      energy.push_back(8 * 1.5 * 1.5 / 2);
    }
    const std::vector<double> first = energy;
    for (int look = 0; look < 40; ++look) {
      simulation.step(50);
      const auto telemetry = simulation.telemetry();
      for (std::size_t i = 0; i < robots.size(); ++i) {
        const double now = telemetry[i].kinetic_energy + telemetry[i].elastic_energy;
        ASSERT_LE(now, energy[i] * (1 + 1e-5)) << "lift " << lift << ", orientation " << i << ", look " << look;
        energy[i] = now;
      }
    }
    for (std::size_t i = 0; i < robots.size(); ++i) EXPECT_LT(energy[i], 0.2 * first[i]);
  }
}

// A plate of 3 masses without springs: the force is equation 1 itself.
TEST_P(Water, APlateFeelsDragAcrossAndLiftAlongTheFlow) {
  Robot plate;
  plate.masses = {{0, 0, 0}, {0.2f, 0, 0}, {0, 0.3f, 0}};
  plate.faces = {{0, 1, 2}};
  const double area = 0.03;
  const auto force_at = [&](Vec3 flow, bool reversed) {
    Robot robot = plate;
    if (reversed) std::swap(robot.faces[0].b, robot.faces[0].c);
    Simulation simulation(water({.density = 800, .drag_coefficient = 1.2f, .lift_coefficient = 0.3f, .flow = flow}),
                          {&robot, 1});
    simulation.step();
    return Vector(3 * mean_velocity(simulation, 0) / 1e-3);
  };
  const double scale = 800 * area / 2;
  for (const bool reversed : {false, true}) {
    // Across: both terms point down the flow and C_L cancels.
    EXPECT_LT((force_at({0, 0, 2}, reversed) - Vector(0, 0, scale * 1.2 * 4)).norm(), 1e-2);
    EXPECT_LT((force_at({0, 0, -2}, reversed) - Vector(0, 0, -scale * 1.2 * 4)).norm(), 1e-2);
    // Inclined by 45 degrees: u = (1, 0, 1), n = z, u.n = 1, |u|^2 = 2.
    EXPECT_LT((force_at({1, 0, 1}, reversed) - scale * Vector(0.9, 0, 0.9 + 0.3 * 2)).norm(), 1e-2);
    EXPECT_LT((force_at({-1, 0, -1}, reversed) + scale * Vector(0.9, 0, 0.9 + 0.3 * 2)).norm(), 1e-2);
  }
}

// One plate of 3 masses, no spring, that moves in its own plane: u.n = 0, so with C_L = 0 only tangential drag acts.
TEST_P(Water, APlateThatSlidesInItsPlaneFeelsTangentialDragAgainstItsMotion) {
  Robot plate;
  plate.masses = {{0, 0, 0}, {0.2f, 0, 0}, {0, 0.3f, 0}};
  plate.faces = {{0, 1, 2}};
  const double area = 0.03;
  for (const Solver solver : {Solver::force, Solver::xpbd})
    for (const bool reversed : {false, true})
      for (const Vec3 velocity : {Vec3{2, 0, 0}, Vec3{0, -1.5f, 0}, Vec3{-0.6f, 0.8f, 0}})
        for (const float coefficient : {0.0f, 0.01f, 0.4f, 2.0f}) {
          Robot robot = plate;
          if (reversed) std::swap(robot.faces[0].b, robot.faces[0].c);
          const Ocean ocean{.density = 800, .lift_coefficient = 0, .drag_tangential = coefficient};
          Simulation simulation(water(ocean, 1e-3, solver), {&robot, 1});
          const State start = bodies::moving(robot, velocity);
          simulation.set_state(0, start.positions, start.velocities);
          simulation.step();
          const Vector v = vector_of(velocity), force = 3 * (mean_velocity(simulation, 0) - v) / 1e-3;
          const Vector expected = -800 * area / 2 * double{coefficient} * v.norm() * v;
          if (coefficient == 0)
            EXPECT_EQ(force, Vector(0, 0, 0));
          else
            EXPECT_LT((force - expected).norm(), 1e-3 + 1e-3 * expected.norm()) << coefficient;
        }
}

// Inclined by 45 degrees: u = (1, 0, 1), n = z, so that u_t = (1, 0, 0).
TEST_P(Water, TangentialDragAddsToDragAndLiftOfAnInclinedPlate) {
  Robot plate;
  plate.masses = {{0, 0, 0}, {0.2f, 0, 0}, {0, 0.3f, 0}};
  plate.faces = {{0, 1, 2}};
  const double scale = 800 * 0.03 / 2;
  Simulation simulation(water({.density = 800,
                               .drag_coefficient = 1.2f,
                               .lift_coefficient = 0.3f,
                               .drag_tangential = 0.7f,
                               .flow = {1, 0, 1}}),
                        {&plate, 1});
  simulation.step();
  const Vector force = 3 * mean_velocity(simulation, 0) / 1e-3;
  EXPECT_LT((force - scale * Vector(0.9 + 0.7, 0, 0.9 + 0.3 * 2)).norm(), 1e-2);
}

TEST_P(Water, TangentialDragNeverAddsEnergyAndBrakesMore) {
  std::vector<Robot> robots;
  for (std::uint64_t orientation = 0; orientation < 20; ++orientation) robots.push_back(cube(orientation));
  const Vec3 velocity{1.5f, 0, 0};
  for (const Solver solver : {Solver::force, Solver::xpbd}) {
    std::vector<std::vector<double>> energies;  // [coefficient][robot], after 0.2 s
    for (const float coefficient : {0.0f, 0.5f, 2.0f}) {
      Simulation simulation(water({.lift_coefficient = 0, .drag_tangential = coefficient}, 1e-3, solver), robots);
      std::vector<double> energy(robots.size(), 8 * 1.5 * 1.5 / 2);
      for (std::size_t i = 0; i < robots.size(); ++i) {
        const State start = bodies::moving(robots[i], velocity);
        simulation.set_state(i, start.positions, start.velocities);
      }
      for (int sample = 0; sample < 20; ++sample) {
        simulation.step(10);
        const auto telemetry = simulation.telemetry();
        for (std::size_t i = 0; i < robots.size(); ++i) {
          const double now = telemetry[i].kinetic_energy + telemetry[i].elastic_energy;
          ASSERT_LE(now, energy[i] * (1 + 1e-5)) << "C_T " << coefficient << ", orientation " << i;
          energy[i] = now;
        }
      }
      energies.push_back(energy);
    }
    for (std::size_t i = 0; i < robots.size(); ++i) {
      EXPECT_LT(energies[1][i], energies[0][i]);
      EXPECT_LT(energies[2][i], energies[1][i]);
    }
  }
}

TEST_P(Water, ARobotWithTangentialDragFollowsTheReference) {
  Robot robot = bodies::random_voxels({.x = 3, .y = 4, .z = 5}, 4);
  bodies::rotate(robot, bodies::random_rotation(5));
  const State start = bodies::moving(robot, {0.5f, 0, -0.5f});
  for (const Solver solver : {Solver::force, Solver::xpbd}) {
    const Configuration setting =
        water({.lift_coefficient = 0.5f, .drag_tangential = 0.4f, .flow = {0.3f, -0.2f, 0.1f}}, 1e-3, solver);
    Simulation simulation(setting, {&robot, 1});
    reference::Reference expected(setting, robot);
    simulation.set_state(0, start.positions, start.velocities);
    expected.set_state(start);
    simulation.step(1000);
    expected.step(1000);
    EXPECT_LT(reference::largest_deviation(expected.positions(), simulation.positions(0)), 1e-4);
  }
}

TEST(TangentialDrag, CpuAndCudaAgreeWithinATenthOfAMillimeterAfterASecond) {
  if (cuda_device_count() == 0) GTEST_SKIP() << "no CUDA device on this machine";
  const Robot robot = bodies::random_voxels({}, 6);
  for (const Solver solver : {Solver::force, Solver::xpbd}) {
    Configuration configuration{.solver = solver, .environment = Ocean{.drag_tangential = 0.5f}};
    configuration.device.kind = DeviceKind::cpu;
    Simulation cpu(configuration, {&robot, 1});
    configuration.device.kind = DeviceKind::cuda;
    Simulation cuda(configuration, {&robot, 1});
    cpu.step(1000);
    cuda.step(1000);
    const std::vector<Vec3> on_cpu = cpu.positions(0), on_cuda = cuda.positions(0);
    double largest = 0;
    for (std::size_t i = 0; i < on_cpu.size(); ++i)
      largest = std::max(largest, static_cast<double>(length(on_cpu[i] - on_cuda[i])));
    EXPECT_LT(largest, 1e-4);
  }
}

TEST_P(Water, AFlowCarriesACubeUpToItsOwnVelocity) {
  const Robot robot = cube(3);
  for (const Solver solver : {Solver::force, Solver::xpbd}) {
    Simulation simulation(water({.flow = {0.5f, 0.2f, 0}}, 1e-3, solver), {&robot, 1});
    const Vector flow(0.5f, 0.2f, 0);
    double along = 0;
    for (int look = 0; look < 20; ++look) {
      simulation.step(1000);
      const double now = mean_velocity(simulation, 0).dot(flow) / flow.norm();
      EXPECT_GE(now, along - 1e-4);
      EXPECT_LT(now, flow.norm());
      along = now;
    }
    EXPECT_GT(along, 0.8 * flow.norm());
  }
}

// In a steady fall the power of gravity equals that of drag: M g v = rho C_D |v|^3 times the shadow. A cube that falls
// flat has the shadow A, but only for a while, because turning a little increases its shadow. The test measures before.
TEST_P(Water, TerminalSpeedOfAFallingCubeIsThatOfEquationOne) {
  const double g = 2, density = 1000, drag = 1.1, mass = 8;
  const Robot flat = bodies::voxels({.x = 1, .y = 1, .z = 1, .edge = voxel_edge}, stiff);
  for (const Solver solver : {Solver::force, Solver::xpbd})
    for (const float lift : {0.0f, 0.2f}) {
      Simulation simulation(
          water({.drag_coefficient = 1.1f, .lift_coefficient = lift, .gravity = {0, 0, -2}}, 1e-3, solver),
          std::vector<Robot>{flat, cube(1), cube(2), cube(3)});
      simulation.step(2500);
      const double expected = std::sqrt(mass * g / (density * double{voxel_edge} * double{voxel_edge} * drag));
      EXPECT_NEAR(-mean_velocity(simulation, 0).z(), expected, 0.01 * expected) << name_of(solver) << " lift " << lift;
      simulation.step(2500);
      for (std::size_t i = 0; i < simulation.size(); ++i) {
        Robot now = simulation.robot(i);
        now.masses = simulation.positions(i);
        const Vector v = mean_velocity(simulation, i), direction = v.normalized();
        const double speed = std::sqrt(mass * g * -direction.z() / (density * drag * shadow(now, direction)));
        EXPECT_NEAR(v.norm(), speed, 0.01 * speed) << name_of(solver) << " lift " << lift << " cube " << i;
      }
    }
}

TEST_P(Water, PointDragSlowsExponentially) {
  const Robot robot = bodies::random_voxels({.x = 2, .y = 2, .z = 2}, 3);
  for (const Solver solver : {Solver::force, Solver::xpbd}) {
    Simulation simulation({.damping = 0.1,
                           .solver = solver,
                           .environment = OceanSimple{.point_drag = 0.8f, .flow = {0, 0, 0.5f}},
                           .device = device()},
                          {&robot, 1});
    const State start = bodies::moving(robot, {1, -2, 0.5f});
    simulation.set_state(0, start.positions, start.velocities);
    for (int second = 1; second <= 2; ++second) {
      simulation.step(1000);
      const Vector v = mean_velocity(simulation, 0);
      // dv/dt = (drag + damping) (flow - v)
      const double decay = std::exp(-0.9 * second), limit = 0.5;
      EXPECT_NEAR(v.x(), decay, 1e-3 * decay + 1e-6) << second;
      EXPECT_NEAR(v.y(), -2 * decay, 2e-3 * decay + 1e-6) << second;
      EXPECT_NEAR(v.z(), limit + (0.5 - limit) * decay, 1e-3 * 0.5) << second;
    }
  }
}

}  // namespace
}  // namespace mercury
