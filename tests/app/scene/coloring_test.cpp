// SPDX-License-Identifier: Apache-2.0
// Color quantities, their scales, and arrows.
#include "app/scene/coloring.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include "app/scene/arrows.h"
#include "app/scene/color_scale.h"
#include "app/scene/group_scene.h"
#include "app/scene/group_state.h"
#include "mercury/cuda_devices.h"
#include "mercury/error.h"
#include "mercury/random_voxel.h"

namespace mercury::test {
namespace {

// Two masses 1 m apart, joined by a muscle of 50 N/m that is 10 % longer at t = 0 (phase pi/2).
Robot pair() {
  return {.name = "pair",
          .materials = {{}, {50, 0.1f, 1, static_cast<float>(M_PI / 2)}},
          .masses = {{0, 0, 0}, {1, 0, 0}},
          .springs = {{0, 1, 1, 1}}};
}

// A triangle with an area of 2 m2 that faces +z.
Robot plate() {
  return {.name = "plate",
          .masses = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}},
          .springs = {{0, 1, 21, 2}, {1, 2, 21, 2.828427f}, {2, 0, 21, 2}},
          .faces = {{0, 1, 2}}};
}

GroupState state(std::vector<Vec3> positions, Vec3 velocity) {
  const std::size_t count = positions.size();
  return {.time = 0, .positions = std::move(positions), .velocities = std::vector<Vec3>(count, velocity)};
}

const Configuration cpu{.device = {.kind = DeviceKind::cpu}};

TEST(Coloring, StrainIsTheChangeOfLength) {
  const Simulation simulation(cpu, std::vector<Robot>{pair()});
  const ColorValues values =
      Coloring(simulation, color_quantity("strain")).values(state({{0, 0, 0}, {1.25f, 0, 0}}, {}));
  ASSERT_EQ(values.spring.size(), 1u);
  EXPECT_NEAR(values.spring[0], 25, 1e-4);
  EXPECT_NEAR(values.mass[0], 25, 1e-4);  // the mean of its springs
  EXPECT_TRUE(values.face.empty());
}

TEST(Coloring, ForceFollowsHookesLawFromThePresentRestLength) {
  const Simulation simulation(cpu, std::vector<Robot>{pair()});
  const ColorValues values =
      Coloring(simulation, color_quantity("force")).values(state({{0, 0, 0}, {1.25f, 0, 0}}, {}));
  EXPECT_NEAR(values.spring[0], 50 * (1.25 - 1.1), 1e-4);
}

TEST(Coloring, EnergyIsElastic) {
  const Simulation simulation(cpu, std::vector<Robot>{pair()});
  const ColorValues values =
      Coloring(simulation, color_quantity("energy")).values(state({{0, 0, 0}, {1.25f, 0, 0}}, {}));
  EXPECT_NEAR(values.spring[0], 1000 * 50 * 0.15 * 0.15 / 2, 1e-2);
  EXPECT_EQ(values.mass, (std::vector<float>(2, values.spring[0])));  // the mean of its springs
}

TEST(Coloring, StiffnessIsTheMaterialsTimesTheEnvironmentsScale) {
  const Simulation simulation({.environment = Ocean{.stiffness_scale = 3}, .device = cpu.device},
                              std::vector<Robot>{pair()});
  EXPECT_NEAR(Coloring(simulation, color_quantity("stiffness")).values(state({{0, 0, 0}, {1, 0, 0}}, {})).spring[0],
              150, 1e-4);
}

TEST(Coloring, ActivationIsTheContraction) {
  const Simulation simulation(cpu, std::vector<Robot>{pair()});
  EXPECT_NEAR(Coloring(simulation, color_quantity("activation")).values(state({{0, 0, 0}, {1, 0, 0}}, {})).spring[0],
              -10, 1e-4);
}

TEST(Coloring, SpeedIsTheMagnitudeOfVelocity) {
  const Simulation simulation(cpu, std::vector<Robot>{pair()});
  const ColorValues values =
      Coloring(simulation, color_quantity("speed")).values(state({{0, 0, 0}, {1, 0, 0}}, {0, 3, 4}));
  EXPECT_EQ(values.mass, (std::vector<float>{5, 5}));
}

// A muscle of 50 N/m and 1 m whose rest length is L(t) = 1 + 0.1 sin(2 t), held at |d| = 1.25 m.
TEST(Coloring, PowerOfAMuscleIsItsTensionTimesItsShortening) {
  Robot robot = pair();
  robot.materials[1] = {50, 0.1f, 2, 0};
  const Simulation simulation(cpu, std::vector<Robot>{robot});
  const Coloring coloring(simulation, color_quantity("power"));
  const auto power_at = [&](double time) {
    GroupState now = state({{0, 0, 0}, {1.25f, 0, 0}}, {});
    now.time = time;
    const ColorValues values = coloring.values(now);
    EXPECT_EQ(values.mass, (std::vector<float>(2, values.spring[0])));  // the mean of its springs
    return static_cast<double>(values.spring[0]);
  };
  for (const double time : {0.0, 0.3, 0.7, 1.9, 1e4}) {
    const double rest_length = 1 + 0.1 * std::sin(2 * time), lengthening = 0.2 * std::cos(2 * time);
    EXPECT_NEAR(power_at(time), -50 * (1.25 - rest_length) * lengthening, 1e-4);
  }
  EXPECT_LT(power_at(0), 0);         // it lengthens while it is stretched: the body does work on it
  EXPECT_GT(power_at(M_PI / 2), 0);  // it shortens while it is stretched: it does work
  // With fixed ends no work leaves the spring, so the mean over a period is 0.
  double sum = 0;
  constexpr int samples = 100;
  for (int i = 0; i < samples; ++i) sum += power_at(M_PI * i / samples);
  EXPECT_NEAR(sum / samples, 0, 1e-5);
}

// Kinetic and elastic energy of a group in double precision [J].
double energy_of(const Simulation& simulation, const GroupState& now) {
  double energy = 0;
  for (const Vec3 v : now.velocities) energy += 0.5 * static_cast<double>(dot(v, v));  // masses of 1 kg
  for (const float spring : Coloring(simulation, color_quantity("energy")).values(now).spring)
    energy += 1e-3 * static_cast<double>(spring);
  return energy;
}

// Three masses and two muscles that work against each other, in still water without drag and damping: the muscles are
// the only source of energy.
TEST(Coloring, PowerOfAllMusclesIsTheChangeOfEnergy) {
  const Robot robot{.name = "triplet",
                    .materials = {{}, {50, 0.14f, 5, 0}, {80, 0.1f, 3, 1}},
                    .masses = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}},
                    .springs = {{0, 1, 1, 1}, {1, 2, 2, 1}}};
  double errors[2];
  for (const int run : {0, 1}) {
    const double dt = run == 0 ? 1e-3 : 5e-4;
    Simulation simulation({.dt = dt,
                           .damping = 0,
                           .solver = Solver::force,
                           .environment = OceanSimple{.point_drag = 0},
                           .device = cpu.device},
                          std::vector<Robot>{robot});
    const Coloring coloring(simulation, color_quantity("power"));
    double work = 0, largest_work = 0, error = 0;
    const double begin = energy_of(simulation, read_state(simulation));
    while (simulation.time() < 2) {
      simulation.step(1);
      const GroupState now = read_state(simulation);
      for (const float power : coloring.values(now).spring) work += dt * static_cast<double>(power);
      largest_work = std::max(largest_work, std::abs(work));
      error = std::max(error, std::abs(energy_of(simulation, now) - begin - work));
    }
    EXPECT_GT(largest_work, 0.1);
    EXPECT_LT(error, 0.02 * largest_work);
    errors[run] = error;
  }
  EXPECT_NEAR(errors[1] / errors[0], 0.5, 0.15);  // the integrator is of first order
}

// A plate that moves along its normal: by equation 1, F = rho A / 2 C_D v^2 along the flow.
TEST(Coloring, PressureOfAFaceMovedHeadOn) {
  const Simulation simulation(cpu, std::vector<Robot>{plate()});
  const ColorValues values =
      Coloring(simulation, color_quantity("pressure")).values(state(plate().masses, {0, 0, 0.5f}));
  ASSERT_EQ(values.face.size(), 1u);
  EXPECT_NEAR(values.face[0], 1000.0 / 2 * 1 * 0.25, 0.01);
}

TEST(Coloring, QuantityThatTheEnvironmentLacksThrows) {
  const Simulation simulation({.environment = Land{}, .device = cpu.device}, std::vector<Robot>{plate()});
  EXPECT_THROW(Coloring(simulation, color_quantity("pressure")), InputError);
  EXPECT_THROW(Arrows(simulation, {.drag = true}), InputError);
  EXPECT_NO_THROW(Coloring(simulation, color_quantity("speed")));
}

// "| force | N | force of the springs: ... |"
std::string docs_row(const ColorQuantity& quantity) {
  const std::string unit = quantity.unit.empty() ? " " : fmt::format(" {} ", quantity.unit);
  const std::string environments = environments_of(quantity);
  return fmt::format("| {} |{}| {}{} |\n", quantity.key, unit, quantity.help,
                     environments.empty() ? "" : fmt::format(" ({})", environments));
}

TEST(ColorQuantities, AreListedInTheDocs) {
  std::ifstream file(MERCURY_DOCS "/rendering.md");
  const std::string docs(std::istreambuf_iterator<char>(file), {});
  std::string rows;
  for (const ColorQuantity& quantity : color_quantities()) rows += docs_row(quantity);
  EXPECT_NE(docs.find("| `--color` | unit | shows |\n|---|---|---|\n" + rows + "\n"), std::string::npos) << rows;
}

TEST(ColorQuantities, AreFoundByTheirKeys) {
  for (const ColorQuantity& quantity : color_quantities()) EXPECT_EQ(&color_quantity(quantity.key), &quantity);
  EXPECT_EQ(material_color().key, "material");
  EXPECT_THROW(color_quantity("mood"), InputError);
}

TEST(FaceForce, DragOpposesMotionAndLiftLiesAcrossIt) {
  const std::vector<Vec3> velocities(3, {0.3f, 0, 0.4f});
  const FaceForce force = face_force(Ocean{}, plate().faces[0], plate().masses, velocities);
  EXPECT_NEAR(force.area, 2, 1e-6);
  EXPECT_LT(dot(force.drag, velocities[0]), 0);
  EXPECT_NEAR(dot(force.lift, velocities[0]), 0, 1e-3);
  // Equation 1 by hand: u = -v, u.n = -0.4, n flipped to (0,0,-1), so u.n = 0.4;
  // F = 1000 * 2 / 2 * (0.8 * 0.4 * (-0.3, 0, -0.4) + 0.2 * 0.25 * (0, 0, -1)).
  const Vec3 sum = force.drag + force.lift;
  EXPECT_NEAR(sum.x, -96, 0.01);
  EXPECT_NEAR(sum.y, 0, 0.01);
  EXPECT_NEAR(sum.z, -178, 0.01);
}

// With springs at rest, the floor carries the weight of each mass.
TEST(FloorForces, MassesAtRestAreCarried) {
  Robot flat = plate();
  for (Vec3& mass : flat.masses) mass.z = 0;
  const Simulation simulation({.environment = Land{}, .device = cpu.device}, std::vector<Robot>{flat});
  const auto forces = floor_forces(simulation, 0, state(flat.masses, {0, 0, 0}));
  ASSERT_EQ(forces.size(), flat.masses.size());
  for (const FloorForce& contact : forces) {
    EXPECT_NEAR(contact.force.z, 9.81, 1e-3);
    EXPECT_NEAR(contact.force.x, 0, 1e-3);
  }
}

// Coulomb's law: friction of a sliding mass is mu N against its motion.
TEST(FloorForces, FrictionOfASlidingMassIsProportionalToTheNormalForce) {
  Robot flat = plate();
  for (Vec3& mass : flat.masses) mass.z = 0;
  const Simulation simulation({.environment = Land{.friction = 0.5f}, .device = cpu.device}, std::vector<Robot>{flat});
  for (const FloorForce& contact : floor_forces(simulation, 0, state(flat.masses, {2, 0, 0}))) {
    EXPECT_NEAR(contact.force.x, -0.5 * 9.81, 1e-3);
    EXPECT_NEAR(contact.force.z, 9.81, 1e-3);
  }
}

// At rest, the floor carries the weight of all masses of the robot.
TEST(FloorForces, CarryTheWholeWeightOfARobotAtRest) {
  Robot tower{.name = "tower"};
  for (int i = 0; i < 3; ++i) tower.masses.push_back({0, 0, static_cast<float>(i)});
  for (std::uint16_t i = 0; i < 2; ++i)
    tower.springs.push_back({.a = i, .b = static_cast<std::uint16_t>(i + 1), .material = 22, .rest_length = 1});
  Simulation simulation({.damping = 20, .environment = Land{}, .device = cpu.device}, std::vector<Robot>{tower});
  simulation.step(20000);
  const auto forces = floor_forces(simulation, 0, read_state(simulation));
  ASSERT_EQ(forces.size(), 1u);
  EXPECT_NEAR(forces[0].force.z, 3 * 9.81, 0.1);  // the last digit of the positions is 0.005 N in these springs
}

TEST(FloorForces, WaterHasNone) {
  const Simulation simulation(cpu, std::vector<Robot>{plate()});
  EXPECT_TRUE(floor_forces(simulation, 0, state(plate().masses, {0, 0, -1})).empty());
  EXPECT_THROW(Arrows(simulation, {.contact = true}), InputError);
}

TEST(Arrows, LongestIsHalfARobotAndKeepsItsScale) {
  const Simulation simulation(cpu, std::vector<Robot>{plate()});
  Arrows arrows(simulation, {.drag = true});
  const std::vector<Telemetry> telemetry = simulation.telemetry();
  const auto fast = arrows.at(state(plate().masses, {0, 0, -1}), telemetry);
  ASSERT_EQ(fast.size(), 1u);
  // 1000 N, a round number; the diagonal of the plate is sqrt(8) m.
  EXPECT_NEAR(fast[0].vector.norm(), 0.5 * std::sqrt(8.0), 1e-3);
  EXPECT_GT(fast[0].vector.z, 0);
  const auto slow = arrows.at(state(plate().masses, {0, 0, -0.5f}), telemetry);
  EXPECT_NEAR(slow[0].vector.norm() / fast[0].vector.norm(), 0.25, 1e-4);
  EXPECT_EQ(arrows.key(), "drag: 1.4 m = 1000 N");
}

// Drag grows with the square of speed: that of the third plate is 100 times that of the others.
TEST(Arrows, OneStrongRobotDoesNotMakeTheOthersInvisible) {
  const Simulation simulation(cpu, std::vector<Robot>(3, plate()));
  Arrows arrows(simulation, {.drag = true});
  GroupState group;
  for (const float speed : {1.0f, 1.0f, 10.0f})
    for (const Vec3 x : plate().masses) {
      group.positions.push_back(x);
      group.velocities.push_back({0, 0, -speed});
    }
  const auto all = arrows.at(group, simulation.telemetry());
  ASSERT_EQ(all.size(), 3u);
  const double half_a_robot = 0.5 * std::sqrt(8.0);
  EXPECT_NEAR(all[0].vector.norm(), half_a_robot, 1e-3);
  EXPECT_NEAR(all[1].vector.norm(), half_a_robot, 1e-3);
  EXPECT_NEAR(all[2].vector.norm(), 2 * half_a_robot, 2e-3);
}

TEST(Arrows, AreAsLongAndDenseAsTheUserWants) {
  const Simulation simulation(cpu, std::vector<Robot>{random_voxel_robot({}, 1)});
  GroupState moving = read_state(simulation);
  for (std::size_t i = 0; i < moving.velocities.size(); ++i)
    moving.velocities[i] = {0.1f * static_cast<float>(i % 7), 0.2f, -0.1f};
  const auto arrows = [&](ArrowKinds kinds) { return Arrows(simulation, kinds).at(moving, simulation.telemetry()); };
  const auto all = arrows({.drag = true}), longer = arrows({.drag = true, .length = 3});
  ASSERT_EQ(all.size(), simulation.robot(0).faces.size());
  ASSERT_EQ(longer.size(), all.size());
  for (std::size_t i = 0; i < all.size(); ++i)
    EXPECT_LT((longer[i].vector - 3 * all[i].vector).norm(), 1e-4f * (1 + longer[i].vector.norm()));

  const auto from = [](const std::vector<render::Arrow>& list) {
    std::vector<std::array<float, 3>> points;
    for (const render::Arrow& arrow : list) points.push_back({arrow.from.x, arrow.from.y, arrow.from.z});
    std::ranges::sort(points);
    return points;
  };
  const auto half = arrows({.drag = true, .density = 0.5f}), few = arrows({.drag = true, .density = 0.1f});
  EXPECT_NEAR(static_cast<double>(half.size()), 0.5 * static_cast<double>(all.size()),
              0.08 * static_cast<double>(all.size()));
  EXPECT_NEAR(static_cast<double>(few.size()), 0.1 * static_cast<double>(all.size()),
              0.05 * static_cast<double>(all.size()));
  EXPECT_TRUE(std::ranges::includes(from(half), from(few))) << "fewer of the same";

  const auto strong = arrows({.drag = true, .threshold = 0.3f});
  float longest_left_out = 0;
  std::size_t kept = 0;
  for (const render::Arrow& arrow : all) {
    const bool is_kept = std::ranges::binary_search(from(strong), std::array{arrow.from.x, arrow.from.y, arrow.from.z});
    kept += is_kept;
    if (!is_kept) longest_left_out = std::max(longest_left_out, arrow.vector.norm());
  }
  EXPECT_EQ(kept, strong.size());
  EXPECT_LT(kept, all.size());
  for (const render::Arrow& arrow : strong) EXPECT_GE(arrow.vector.norm(), longest_left_out);
}

// The default muscles are red, yellow, teal and violet; none has the hue of a strong arrow. A weak arrow is paler.
TEST(Arrows, TakeTheirColorFromTheirValue) {
  const Simulation simulation(cpu, std::vector<Robot>{plate()});
  Arrows arrows(simulation, {.drag = true});
  const auto strong = arrows.at(state(plate().masses, {0, 0, -1}), simulation.telemetry());
  const auto weak = arrows.at(state(plate().masses, {0, 0, -0.1f}), simulation.telemetry());
  ASSERT_EQ(strong.size(), 1u);
  ASSERT_EQ(weak.size(), 1u);
  const auto chroma = [](render::Color c) { return std::max({c.r, c.g, c.b}) - std::min({c.r, c.g, c.b}); };
  EXPECT_GT(chroma(strong[0].color), chroma(weak[0].color) + 80);
  for (int quarter = 0; quarter < 4; ++quarter) {
    const float phase = static_cast<float>(quarter) * std::numbers::pi_v<float> / 2;
    const render::Color muscle = render::muscle_color(phase, 0.5f), arrow = strong[0].color;
    EXPECT_GT(std::abs(muscle.r - arrow.r) + std::abs(muscle.g - arrow.g) + std::abs(muscle.b - arrow.b), 150) << phase;
  }
}

// A muscle that is driven by u instead of its sine: L = L0 (1 + amplitude u).
class DrivenOn : public testing::TestWithParam<DeviceKind> {
 protected:
  void SetUp() override {
    if (GetParam() == DeviceKind::cuda && cuda_device_count() == 0) GTEST_SKIP() << "no CUDA device on this machine";
    simulation_.emplace(
        Configuration{.dt = 1e-6, .environment = OceanSimple{.point_drag = 0}, .device = {.kind = GetParam()}},
        std::vector<Robot>(2, pair()));
    const HeldDrive held{.robot = 1, .actuator = 0, .drive = -0.5f};
    simulation_->hold_drives(std::span(&held, 1));
    simulation_->step();  // so short that the masses hardly move
  }
  std::optional<Simulation> simulation_;
};
INSTANTIATE_TEST_SUITE_P(All, DrivenOn, testing::Values(DeviceKind::cpu, DeviceKind::cuda),
                         [](const auto& test) { return std::string(name_of(Device{.kind = test.param})); });

TEST_P(DrivenOn, ForcesFollowTheDrive) {
  const GroupState now = read_state(*simulation_);
  const ColorValues values = Coloring(*simulation_, color_quantity("force")).values(now);
  EXPECT_NEAR(values.spring[0], 50 * -0.1f, 1e-3);        // sin(pi/2) = 1: 10 % longer, it pushes
  EXPECT_NEAR(values.spring[1], 50 * 0.1f * 0.5f, 1e-3);  // 5 % shorter, it pulls
  const std::vector<Vec3> forces = net_forces(*simulation_, 1, now);
  EXPECT_NEAR(forces[0].x, 2.5f, 1e-3);
  EXPECT_NEAR(forces[1].x, -2.5f, 1e-3);
}

TEST_P(DrivenOn, MusclesGlowAsTheyAreDriven) {
  GroupScene scene(group_of(*simulation_), {{0, 0, 0}, {5, 0, 0}}, {});
  DetailObserver observer(*simulation_, {});
  const auto telemetry = simulation_->telemetry();
  const auto glow = [&](std::size_t robot) {
    const render::Scene& drawn = scene.scene();
    return drawn.materials[drawn.placements[robot].first_material + 1].activation;
  };
  scene.update(simulation_->time(), telemetry, observer.observe(telemetry));
  EXPECT_NEAR(glow(0), -1, 1e-5);
  EXPECT_NEAR(glow(1), 0.5, 1e-5);
  simulation_->hold_drives({});
  simulation_->step();
  scene.update(simulation_->time(), telemetry, observer.observe(telemetry));
  EXPECT_NEAR(glow(1), -1, 1e-5);
}

// Circles around what is sensed, and a line from beside the robot toward it, in the robot's own coordinates.
TEST(Senses, TargetAndLightAreMarked) {
  Robot seeker = pair();
  seeker.sensors = {{.kind = SensorKind::target_direction}, {.kind = SensorKind::light}};
  Configuration configuration = cpu;
  configuration.environment.target = {40, 0, 0};
  configuration.environment.light = {0, -30, 0};
  const Simulation simulation(configuration, std::vector<Robot>{pair(), seeker});
  for (const Layout layout : {Layout::grid, Layout::cells}) {
    GroupScene scene(group_of(simulation), {{0, 0, 0}, {90, 0, 0}}, {.layout = layout});
    scene.update(0, simulation.telemetry(), {});
    const render::Vector3 center(0.5f, 0, 0);
    std::size_t around_target = 0, around_light = 0, needles = 0;
    for (const render::Path& path : scene.scene().paths) {
      EXPECT_EQ(path.body, 1u) << "the other one senses nothing";
      const render::Vector3 first(path.points.data()), last(path.points.data() + path.points.size() - 3);
      around_target += (first - render::Vector3(40, 0, 0)).norm() < 3;
      around_light += (first - render::Vector3(0, -30, 0)).norm() < 3;
      for (const render::Vector3 goal : {render::Vector3(40, 0, 0), render::Vector3(0, -30, 0)}) {
        const render::Vector3 ahead = (goal - center).normalized();
        needles += (first - center).norm() < 5 && ((first - center).normalized() - ahead).norm() < 1e-4f &&
                   ((last - first).normalized() - ahead).norm() < 1e-4f;
      }
    }
    EXPECT_EQ(needles, 2u);
    EXPECT_EQ(around_target, layout == Layout::grid ? 3u : 0u);
    EXPECT_EQ(around_light, layout == Layout::grid ? 9u : 0u);
    if (layout == Layout::grid) {
      EXPECT_GE(scene.camera_boxes()[1].high.x, 130);
      EXPECT_LE(scene.camera_boxes()[1].low.y, -30);
    }
  }
}

TEST(Plants, AreLeftOutOfLargeGroups) {
  for (const std::size_t count : {most_with_extras, most_with_extras + 1}) {
    const Simulation simulation(cpu, std::vector<Robot>(count, pair()));
    GroupScene scene(group_of(simulation), std::vector<render::Vector3>(count), {});
    scene.update(0, simulation.telemetry(), {});
    const bool many = count > most_with_extras;
    EXPECT_EQ(scene.scene().ground_cover->height > 0, !many);
    EXPECT_EQ(scene.scene().movers.size(), many ? 0 : count);
  }
}

TEST(RoundUp, GivesOneTwoFive) {
  EXPECT_FLOAT_EQ(round_up(1), 1);
  EXPECT_FLOAT_EQ(round_up(1.1f), 2);
  EXPECT_FLOAT_EQ(round_up(0.03f), 0.05f);
  EXPECT_FLOAT_EQ(round_up(700), 1000);
}

}  // namespace
}  // namespace mercury::test
