// SPDX-License-Identifier: Apache-2.0
// Environments composed of parts: water, ground and contacts together.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "backend.h"
#include "bodies.h"

namespace mercury {
namespace {

constexpr Material tissue_like{40, 0, 0, 0};

class Parts : public BackendTest {
 protected:
  Configuration in(const Environment& environment, Solver solver = Solver::force, double damping = 0.1) const {
    return {.damping = damping, .solver = solver, .environment = environment, .device = device()};
  }
  std::vector<Vec3> after_a_second(const Environment& environment, Solver solver) const {
    const std::array robots{bodies::random_voxels({}, 6), bodies::random_voxels({}, 7)};
    Simulation simulation(in(environment, solver), robots);
    simulation.step(1000);
    return simulation.positions(1);
  }
};
INSTANTIATE_TEST_SUITE_P(All, Parts, every_device, BackendTest::name);

float lowest(const std::vector<Vec3>& positions) { return std::ranges::min(positions, {}, &Vec3::z).z; }

const Environment ocean{.water = FaceDrag{}};
const Environment ocean_simple{.water = PointDrag{}};
const Environment land{.ground = Plane{}, .contacts = Contacts{}, .gravity = {0, 0, -9.81f}, .stiffness_scale = 200};

TEST_P(Parts, APresetIsItsCompositionBitForBit) {
  for (const Solver solver : {Solver::force, Solver::xpbd}) {
    EXPECT_EQ(after_a_second(Ocean{}, solver), after_a_second(ocean, solver));
    EXPECT_EQ(after_a_second(OceanSimple{}, solver), after_a_second(ocean_simple, solver));
    EXPECT_EQ(after_a_second(Land{}, solver), after_a_second(land, solver));
  }
}

// A part that has no effect makes the solvers use the general model.
TEST_P(Parts, AnotherPartWithoutEffectChangesNothingButRounding) {
  const auto expect_near = [&](const Environment& preset, const Environment& with_part) {
    for (const Solver solver : {Solver::force, Solver::xpbd}) {
      const std::vector<Vec3> expected = after_a_second(preset, solver), actual = after_a_second(with_part, solver);
      float largest = 0;
      for (std::size_t i = 0; i < expected.size(); ++i) largest = std::max(largest, length(expected[i] - actual[i]));
      EXPECT_LT(largest, 1e-4f) << name_of(with_part) << ", " << name_of(solver);
    }
  };
  const Contacts weak{.contact_stiffness = 1e-20f};
  Environment more = ocean;
  more.contacts = weak;
  expect_near(ocean, more);
  const FaceDrag rough{.drag_tangential = 0.3f, .flow = {0.1f, 0, 0.2f}};
  more.water = rough;
  expect_near({.water = rough}, more);
  more = ocean_simple;
  more.contacts = weak;
  expect_near(ocean_simple, more);
  more = land;
  more.water = PointDrag{.point_drag = 0};
  expect_near(land, more);
  more.water = FaceDrag{.density = 0};
  expect_near(land, more);
}

TEST_P(Parts, SwitchesOfContactsThatAreOffKeepTheModelOfThePreset) {
  Environment without = ocean;
  without.contacts = Contacts{.self_collision = false};
  for (const Solver solver : {Solver::force, Solver::xpbd})
    EXPECT_EQ(after_a_second(without, solver), after_a_second(ocean, solver));
}

// Two loose masses swim toward each other. Those of one spring set the contact distance: half its length.
Robot two_that_meet() {
  Robot robot;
  robot.materials = bodies::one_material(tissue_like);
  robot.masses = {{0, 0, 0}, {1.5f, 0, 0}, {0, 10, 0}, {1, 10, 0}};
  robot.springs = {{2, 3, 1, 1}};
  return robot;
}

TEST_P(Parts, ContactsInWaterKeepMassesApartThatWouldCross) {
  constexpr float speed = 1, stiffness = 100;
  const Robot robot = two_that_meet();
  const std::vector<Vec3> velocities{{speed, 0, 0}, {-speed, 0, 0}, {}, {}};
  for (const Solver solver : {Solver::force, Solver::xpbd})
    for (const bool contacts : {true, false}) {
      Environment environment{.water = PointDrag{.point_drag = 0.5f}};
      if (contacts) environment.contacts = Contacts{.contact_stiffness = stiffness};
      Simulation simulation(in(environment, solver, 0), {&robot, 1});
      simulation.set_state(0, robot.masses, velocities);
      float nearest = 10;
      for (int look = 0; look < 300; ++look) {
        simulation.step(10);
        const State now = simulation.state(0);
        nearest = std::min(nearest, now.positions[1].x - now.positions[0].x);
      }
      // They meet with less than the energy that they began with, which is enough for this much of the distance.
      const float most = std::sqrt(2 * speed * speed / stiffness);
      if (contacts)
        EXPECT_GT(nearest, 0.5f - most) << name_of(solver);
      else
        EXPECT_LT(nearest, 0) << name_of(solver) << ": without contacts they cross";
    }
}

TEST_P(Parts, ABodySinksAtTheSpeedThatTheDragAllowsAndRestsOnTheGround) {
  Robot cube = bodies::voxels({.x = 1, .y = 1, .z = 1, .edge = 1}, tissue_like);
  const auto masses = static_cast<float>(cube.masses.size());
  constexpr float gravity = 1, density = 1000, point_drag = 4;
  struct Case {
    Environment environment;
    float speed;  // at which drag and weight are equal [m/s]
  };
  // Top and bottom of the cube each feel rho A C_D v^2 / 2, and the sides nothing.
  const FaceDrag on_faces{.density = density, .drag_coefficient = 1, .lift_coefficient = 0};
  const Case cases[] = {{{.water = on_faces,
                          .ground = Plane{},
                          .contacts = Contacts{},
                          .gravity = {0, 0, -gravity},
                          .stiffness_scale = 20},
                         std::sqrt(masses * gravity / density)},
                        {{.water = PointDrag{.point_drag = point_drag}, .ground = Plane{}, .gravity = {0, 0, -gravity}},
                         gravity / point_drag}};
  for (Solver solver : {Solver::force, Solver::xpbd})
    for (const auto& [environment, speed] : cases) {
      Simulation simulation(in(environment, solver, 0), {&cube, 1});
      EXPECT_EQ(lowest(simulation.positions(0)), 0) << "set down";
      std::vector<Vec3> above = cube.masses;
      for (Vec3& x : above) x.z += 4 * speed - lowest(cube.masses);
      simulation.set_state(0, above, std::vector<Vec3>(above.size()));
      simulation.step(3000);
      EXPECT_NEAR(simulation.telemetry(0).velocity.z, -speed, 0.02f * speed)
          << name_of(environment) << ", " << name_of(solver);
      simulation.step(20000);
      const Telemetry rest = simulation.telemetry(0);
      EXPECT_EQ(lowest(simulation.positions(0)), 0) << name_of(environment) << ", " << name_of(solver);
      const double fall = static_cast<double>(masses * gravity * 4 * speed);  // [J]
      EXPECT_LT(rest.kinetic_energy, 1e-3 * fall) << name_of(environment) << ", " << name_of(solver);
      EXPECT_GT(rest.center_of_mass.z, 0.4f) << "it stands";
    }
}

}  // namespace
}  // namespace mercury
