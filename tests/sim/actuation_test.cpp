// SPDX-License-Identifier: Apache-2.0
// Actuators that a program drives through shared arrays.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "bodies.h"
#include "mercury/error.h"
#include "plain_backend.h"
#include "shared_batch.h"
#include "sim/physics/actuation.h"

namespace mercury {
namespace {

using test::SharedBatch;

constexpr float nan_value = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

class ActuationOf : public test::SharedBatchTest {};
INSTANTIATE_TEST_SUITE_P(All, ActuationOf, test::every_backend, test::SharedBatchTest::name);

// Of several sizes, so that CUDA puts them into several classes. They have different numbers of actuators, one has
// none.
std::vector<Robot> crowd() {
  std::vector<Robot> robots = {bodies::random_voxels({.x = 2, .y = 2, .z = 2}, 1),
                               bodies::voxels({.x = 3, .y = 1, .z = 1}, {60, 0, 0, 0}),
                               bodies::random_voxels({.x = 5, .y = 4, .z = 3}, 2), bodies::pair({50, 0.3f, 4, 1})};
  Robot halves = bodies::random_voxels({.x = 2, .y = 2, .z = 1}, 4);
  std::vector<std::uint32_t> left, right;
  for (std::uint32_t i = 0; i < halves.springs.size(); ++i) (i % 2 == 0 ? left : right).push_back(i);
  // Springs of one material, so that the table has room for both actuators.
  for (Spring& spring : halves.springs) spring.material = static_cast<MaterialId>(1 + spring.material % 20);
  add_actuator(halves, "left", left);
  add_actuator(halves, "right", right);
  robots.push_back(halves);
  robots.push_back(bodies::with_half_waves(robots[2]));
  return robots;
}

TEST_P(ActuationOf, HasARowPerRobotAndAColumnPerActuator) {
  const std::vector<Robot> robots = crowd();
  SharedBatch batch = this->batch({}, robots);
  std::size_t most = 0;
  for (const Robot& robot : robots) most = std::max(most, actuators_of(robot).size());
  const Actuation& arrays = batch->actuation();
  for (const auto* array : {&arrays.amplitude, &arrays.frequency, &arrays.phase, &arrays.drive}) {
    EXPECT_EQ(array->rows, robots.size());
    EXPECT_EQ(array->columns, most);
    EXPECT_EQ(array->cuda_device, batch->cuda_device());
  }
}

TEST_P(ActuationOf, BeginsWithWhatTheMaterialsHaveInCommon) {
  Robot robot = bodies::pair({50, 0.3f, 4, 1});
  robot.materials.push_back({50, 0.2f, 4, 2});
  robot.springs.push_back({0, 1, 2, 1});
  robot.actuators = {{.name = "both", .materials = {1, 2}}};
  SharedBatch batch = this->batch({}, std::span(&robot, 1));
  const Actuation& arrays = batch->actuation();
  EXPECT_TRUE(std::isnan(batch.read(arrays.amplitude)[0]));
  EXPECT_EQ(batch.read(arrays.frequency)[0], 4);
  EXPECT_TRUE(std::isnan(batch.read(arrays.phase)[0]));
  EXPECT_TRUE(std::isnan(batch.read(arrays.drive)[0]));
}

TEST_P(ActuationOf, ChangesNoBitWhileTheArraysHaveTheirFirstValues) {
  const std::vector<Robot> robots = crowd();
  for (const Solver solver : {Solver::force, Solver::xpbd})
    for (const Environment& environment : {Environment(Ocean{}), Environment(Land{})}) {
      const Configuration configuration{.solver = solver, .environment = environment};
      SharedBatch plain = this->batch(configuration, robots), driven = this->batch(configuration, robots);
      (void)driven->actuation();
      plain->step(60);
      driven->step(60);
      EXPECT_EQ(driven->hashes(), plain->hashes());
      driven->step_in_stream(60, nullptr);
      plain->step(60);
      const auto telemetry = driven->telemetry(), expected = plain->telemetry();
      for (std::size_t i = 0; i < robots.size(); ++i) {
        EXPECT_EQ(telemetry[i].elastic_energy, expected[i].elastic_energy) << i;
        EXPECT_EQ(telemetry[i].muscle_power, expected[i].muscle_power) << i;
      }
      EXPECT_EQ(driven->hashes(), plain->hashes());
    }
}

// In a step of a microsecond the masses hardly move. Forces are at most 15 N, and lengths are within 4e-7 m: roots have
// two units in the last place on a device (host_device.h), L has one.
TEST_P(ActuationOf, IsInTheElasticEnergyAndThePowerOfMuscles) {
  const double k = 50, a = double{0.3f};
  const std::vector<Robot> robots(2, bodies::pair({50, 0.3f, 4, 1}));
  SharedBatch batch = this->batch({.dt = 1e-6, .environment = empty_space()}, robots);
  const Actuation& arrays = batch->actuation();
  batch.write(arrays.drive, {0.5f, nan_value});
  batch.write(arrays.frequency, {4, 7});
  batch.write(arrays.phase, {1, 2});
  batch->step();
  const auto telemetry = batch->telemetry();
  EXPECT_NEAR(telemetry[0].elastic_energy, k / 2 * std::pow(a * 0.5, 2), 15 * 4e-7);
  EXPECT_NEAR(telemetry[0].muscle_power, 0, 1e-9) << "a drive has no rate";
  const double angle = 7e-6 + 2;
  EXPECT_NEAR(telemetry[1].elastic_energy, k / 2 * std::pow(a * std::sin(angle), 2), 15 * 4e-7);
  // The spring pushes with k (L - length), and L changes by a omega cos(angle).
  EXPECT_NEAR(telemetry[1].muscle_power, k * a * std::sin(angle) * a * 7 * std::cos(angle), 1e-4);
}

// In steps of a microsecond the masses hardly move, as above.
TEST_P(ActuationOf, IsHeldByHandUntilItIsReleasedAndMaterialsKeepTheirOwnValues) {
  const double k = 50, a = double{0.3f};
  const std::vector<Robot> robots(2, bodies::pair({50, 0.3f, 4, 1}));
  SharedBatch batch = this->batch({.dt = 1e-6, .environment = empty_space()}, robots);
  const HeldDrive held{.robot = 0, .actuator = 0, .drive = 0.5f};
  batch->hold_drives(std::span(&held, 1));
  batch->step();
  EXPECT_NEAR(batch->telemetry()[0].elastic_energy, k / 2 * std::pow(a * 0.5, 2), 15 * 4e-7);
  EXPECT_NEAR(batch->telemetry()[1].elastic_energy, k / 2 * std::pow(a * std::sin(1.0), 2), 15 * 2e-6);
  batch->hold_drives({});
  const MaterialId id = robots[0].springs[0].material;
  Material weaker = batch->material(1, id);
  weaker.amplitude = 0.1f;
  batch->set_material(1, id, weaker);
  batch->step();
  EXPECT_NEAR(batch->telemetry()[0].elastic_energy, k / 2 * std::pow(a * std::sin(1.0), 2), 15 * 4e-6);
  EXPECT_NEAR(batch->telemetry()[1].elastic_energy, k / 2 * std::pow(0.1 * std::sin(1.0), 2), 15 * 4e-6);
  const HeldDrive missing{.robot = 0, .actuator = 1, .drive = 0};
  EXPECT_THROW(batch->hold_drives(std::span(&missing, 1)), std::out_of_range);
}

TEST_P(ActuationOf, EqualsMaterialsWithTheseValues) {
  const std::vector<Robot> robots = crowd();
  for (const Solver solver : {Solver::force, Solver::xpbd}) {
    SharedBatch driven = this->batch({.solver = solver}, robots);
    const Actuation& arrays = driven->actuation();
    std::vector<Robot> changed = robots;
    for (std::size_t i = 0; i < robots.size(); ++i) {
      const auto materials = materials_of(robots[i]);
      changed[i].materials.assign(materials.begin(), materials.end());
      const auto actuators = actuators_of(robots[i]);
      for (std::size_t a = 0; a < actuators.size(); ++a) {
        const float n = static_cast<float>(7 * i + a), amplitude = 0.2f / (1 + n), frequency = 1 + 0.3f * n;
        driven.write(arrays.amplitude, i, a, amplitude);
        driven.write(arrays.frequency, i, a, frequency);
        driven.write(arrays.phase, i, a, 0.1f * n);
        for (const MaterialId id : actuators[a].materials)
          changed[i].materials[id] = {materials[id].stiffness, amplitude, frequency, 0.1f * n, materials[id].half_wave};
      }
    }
    SharedBatch expected = this->batch({.solver = solver}, changed);
    driven->step(50);
    driven->step_in_stream(50, nullptr);
    expected->step(100);
    EXPECT_EQ(driven->hashes(), expected->hashes());
  }
}

// Half waves are a property of the sine. A drive replaces the sine, so it has both signs.
TEST_P(ActuationOf, ByADriveHasNoHalfWaves) {
  const Material muscle{50, 0.3f, 4, 1};
  const std::vector<Robot> robots = {bodies::pair(muscle), bodies::with_half_waves(bodies::pair(muscle))};
  SharedBatch batch = this->batch({.environment = empty_space()}, robots);
  const Actuation& arrays = batch->actuation();
  for (const float drive : {0.7f, -0.4f}) {
    batch.write(arrays.drive, {drive, drive});
    batch->step(20);
    EXPECT_EQ(batch->hash(1), batch->hash(0)) << drive;
  }
  // Without the drive it moves by half waves again: sin(4 t + 1) > 0 at the first of these times, < 0 at the second.
  for (const std::int64_t first : {100, 800}) {
    batch.write(arrays.drive, {nan_value, nan_value});
    batch.write(arrays.driven, {0, 0});
    batch->step(first - batch->steps());
    const double time = batch->time(), sine = std::sin(4 * time + 1), whole = 1 + double{0.3f} * sine;
    batch->set_state(0, robots[0].masses, std::vector<Vec3>(2));
    batch->set_state(1, robots[1].masses, std::vector<Vec3>(2));
    const auto telemetry = batch->telemetry();
    EXPECT_NEAR(telemetry[0].elastic_energy, 25 * std::pow(whole - 1, 2), 1e-5) << time;
    EXPECT_NEAR(telemetry[1].elastic_energy, sine > 0 ? 0 : 25 * std::pow(whole - 1, 2), 1e-5) << time;
  }
}

// A drive is constant during a step, as the length of a muscle is.
TEST_P(ActuationOf, ByASineIsTheSine) {
  const std::vector<Robot> robots = crowd();
  SharedBatch sine = this->batch({}, robots), driven = this->batch({}, robots);
  const Actuation& arrays = driven->actuation();
  const auto frequency = driven.read(arrays.frequency), phase = driven.read(arrays.phase);
  std::vector<float> drives(phase.size());
  std::vector<double> highest(phase.size(), 1);
  for (std::size_t i = 0; i < robots.size(); ++i) {
    const auto actuators = actuators_of(robots[i]);
    for (std::size_t a = 0; a < actuators.size(); ++a)
      if (materials_of(robots[i])[actuators[a].materials.front()].half_wave) highest[i * arrays.drive.columns + a] = 0;
  }
  for (int step = 0; step < 200; ++step) {
    for (std::size_t i = 0; i < drives.size(); ++i)
      drives[i] =
          static_cast<float>(std::min(std::sin(double{frequency[i]} * driven->time() + double{phase[i]}), highest[i]));
    driven.write(arrays.drive, drives);
    driven->step_in_stream(1, nullptr);
  }
  sine->step(200);
  std::vector<Vec3> x(sine->mass_count()), y(x.size());
  sine->read_positions(x);
  driven->read_positions(y);
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_LT(length(x[i] - y[i]), 1e-5f) << i;
}

TEST_P(ActuationOf, WithAnyBitsBreaksNothing) {
  const std::vector<Robot> robots = crowd();
  SharedBatch batch = this->batch({}, robots);
  const Actuation& arrays = batch->actuation();
  const std::array<float, 8> wild = {nan_value, infinity, -infinity, 3e38f, -3e38f, 1e-45f, -0.f, 1e9f};
  for (std::size_t call = 0; call < 8; ++call) {
    std::vector<float> values(arrays.drive.rows * arrays.drive.columns);
    std::size_t shift = call;
    for (const auto* array : {&arrays.frequency, &arrays.phase, &arrays.drive}) {
      for (std::size_t i = 0; i < values.size(); ++i) values[i] = wild[(i + shift) % wild.size()];
      batch.write(*array, values);
      shift += 3;
    }
    batch.write(arrays.driven, std::vector<std::uint8_t>(values.size()));
    batch->reset();
    batch->step(5);
    for (std::size_t i = 0; i < robots.size(); ++i) {
      const auto drives = std::span(values).subspan(i * arrays.drive.columns, actuators_of(robots[i]).size());
      EXPECT_TRUE(std::isfinite(batch->telemetry(i).kinetic_energy));
      EXPECT_EQ(batch->telemetry(i).exploded, std::ranges::any_of(drives, [](float u) { return std::isinf(u); })) << i;
    }
  }
}

// The length of a muscle whose drive is no number is none, so that nobody takes its robot for a living one.
TEST_P(ActuationOf, ThatFailsExplodesTheRobotAloneBeforeTheStep) {
  const std::vector<Robot> robots(4, bodies::pair({50, 0.3f, 4, 1}));
  SharedBatch batch = this->batch({.environment = empty_space()}, robots);
  const Actuation& arrays = batch->actuation();
  EXPECT_EQ(batch.read(arrays.driven), std::vector<std::uint8_t>(4));
  batch.write(arrays.drive, {0.5f, 0.5f, nan_value, nan_value});
  batch->step(10);
  EXPECT_EQ(batch.read(arrays.driven), (std::vector<std::uint8_t>{1, 1, 0, 0}));
  const auto before = batch->hashes();
  batch.write(arrays.drive, {0.5f, nan_value, nan_value, nan_value});
  batch.write(arrays.driven, {1, 1, 0, 1});
  batch->step(10);
  const auto after = batch->hashes();
  const auto telemetry = batch->telemetry();
  for (const std::size_t i : {1, 3}) {
    EXPECT_TRUE(telemetry[i].exploded) << i;
    EXPECT_DOUBLE_EQ(telemetry[i].exploded_at, 10 * 1e-3) << i;
    EXPECT_EQ(after[i], before[i]) << i;
  }
  for (const std::size_t i : {0, 2}) {
    EXPECT_FALSE(telemetry[i].exploded) << i;
    EXPECT_NE(after[i], before[i]) << i;
  }
}

TEST_P(ActuationOf, KeepsWhatIsDrivenWithItsRobots) {
  const std::vector<Robot> robots(3, bodies::pair({50, 0.3f, 4, 1}));
  SharedBatch batch = this->batch({.environment = empty_space()}, robots);
  batch.write(batch->actuation().drive, {nan_value, 0.5f, nan_value});
  batch->step(1);
  batch->keep(std::vector<std::size_t>{2, 1});
  batch->add(robots[0]);
  EXPECT_EQ(batch.read(batch->actuation().driven), (std::vector<std::uint8_t>{0, 1, 0}));
}

TEST_P(ActuationOf, GoesOnWhenMaterialsChange) {
  const std::vector<Robot> robots(2, bodies::pair({50, 0.3f, 4, 1}));
  SharedBatch batch = this->batch({.environment = empty_space()}, robots);
  const Actuation& arrays = batch->actuation();
  batch.write(arrays.drive, {0.5f, 0.5f});
  batch.write(arrays.amplitude, {0.2f, nan_value});
  batch->step(20);
  const Material changed{80, 0.1f, 1, 0};
  batch->set_material(0, 1, changed);
  batch->set_material(1, 1, changed);
  EXPECT_EQ(batch->material(0, 1), changed);
  batch->step(20);
  // The same with robots that have these materials.
  for (std::size_t i = 0; i < 2; ++i) {
    const auto quarter = arcsine(0.5f);
    const std::array amplitudes = {0.2f, i == 0 ? 0.2f : 0.3f, i == 0 ? 0.2f : 0.1f};
    SharedBatch expected = this->batch({.environment = empty_space()}, std::span(robots).subspan(i, 1));
    expected->set_material(0, 1, {50, amplitudes[1], 0, quarter});
    expected->step(20);
    expected->set_material(0, 1, {80, amplitudes[2], 0, quarter});
    expected->step(20);
    EXPECT_EQ(batch->hash(i), expected->hash(0)) << i;
  }
}

TEST_P(ActuationOf, GoesOnForRobotsThatStay) {
  const std::vector<Robot> robots = crowd();
  SharedBatch all = this->batch({}, robots), changing = this->batch({}, robots);
  const std::size_t columns = all->actuation().drive.columns;
  std::vector<float> drives(robots.size() * columns);
  for (std::size_t i = 0; i < drives.size(); ++i) drives[i] = std::sin(static_cast<float>(i));
  all.write(all->actuation().drive, drives);
  changing.write(changing->actuation().drive, drives);
  changing->step(30);
  changing->add(bodies::random_voxels({.x = 4, .y = 4, .z = 4}, 9));
  changing->step(30);
  changing->keep(std::array<std::size_t, 4>{6, 4, 0, 2});
  changing->step_in_stream(30, nullptr);
  all->step(90);
  EXPECT_EQ(changing->hash(1), all->hash(4));
  EXPECT_EQ(changing->hash(2), all->hash(0));
  EXPECT_EQ(changing->hash(3), all->hash(2));
  const auto now = changing.read(changing->actuation().drive);
  for (std::size_t a = 0; a < actuators_of(robots[2]).size(); ++a)
    EXPECT_EQ(now[3 * changing->actuation().drive.columns + a], drives[2 * columns + a]) << a;
}

TEST_P(ActuationOf, AResetRobotMovesAsANewOne) {
  const std::vector<Robot> robots = crowd();
  SharedBatch batch = this->batch({}, robots), fresh = this->batch({}, robots);
  for (SharedBatch* each : {&batch, &fresh}) {
    const Actuation& arrays = (*each)->actuation();
    std::vector<float> drives(arrays.drive.rows * arrays.drive.columns);
    for (std::size_t i = 0; i < drives.size(); ++i) drives[i] = std::cos(static_cast<float>(i));
    each->write(arrays.drive, drives);
  }
  batch->step(30);
  batch->reset_in_stream(batch.shared({1, 0, 1, 1, 1, 1}).get(), nullptr);
  batch->step(40);
  fresh->step(40);
  for (const std::size_t i : {0u, 2u, 3u, 4u, 5u}) EXPECT_EQ(batch->hash(i), fresh->hash(i)) << i;
}

TEST_P(ActuationOf, NamingActuatorsChangesNoBit) {
  const Robot robot = bodies::random_voxels({.x = 3, .y = 2, .z = 2}, 1);
  Robot named = robot;
  for (Spring& spring : named.springs) spring.material = static_cast<MaterialId>(1 + spring.material % 20);
  Robot plain = named;
  std::vector<std::uint32_t> some;
  for (std::uint32_t i = 0; i < named.springs.size(); i += 3) some.push_back(i);
  add_actuator(named, "some", some);
  SharedBatch batch = this->batch({}, std::array{plain, named});
  batch->step(50);
  EXPECT_EQ(batch->hash(1), batch->hash(0));
  EXPECT_EQ(actuators_of(named).size(), 1u);
}

// A backend that reads the arrays itself and has no room for more robots.
class FullBackend final : public test::PlainBackend {
 public:
  void add(std::span<const Robot* const>, std::size_t) override {
    reads_arrays = false;
    throw DeviceError("no room");
  }
  bool set_actuation(const ActuationSources& sources) override {
    reads_arrays = sources.drive != nullptr;
    return true;
  }
  bool reads_arrays = false;
};

TEST(Actuation, GoesOnAfterRobotsCouldNotBeAdded) {
  const Robot robot = bodies::pair({50, 0.3f, 4, 1});
  auto made = std::make_unique<FullBackend>();
  const FullBackend& backend = *made;
  Simulation simulation({}, std::span(&robot, 1), std::move(made));
  const auto drive = simulation.actuation().drive;
  EXPECT_TRUE(backend.reads_arrays);
  EXPECT_THROW(simulation.add(robot), DeviceError);
  EXPECT_TRUE(backend.reads_arrays);
  EXPECT_EQ(simulation.actuation().drive.data, drive.data);
}

TEST(Actuation, CpuAndCudaAgree) {
  if (cuda_device_count() == 0) GTEST_SKIP() << "no CUDA device on this machine";
  const std::vector<Robot> robots = crowd();
  SharedBatch cpu("cpu", {}, robots), cuda("cuda", {}, robots);
  const std::size_t size = robots.size() * cpu->actuation().drive.columns;
  for (int call = 0; call < 20; ++call) {
    std::vector<float> drives(size);
    for (std::size_t i = 0; i < size; ++i)
      drives[i] = std::sin(0.1f * static_cast<float>(call) + static_cast<float>(i));
    cpu.write(cpu->actuation().drive, drives);
    cuda.write(cuda->actuation().drive, drives);
    cpu->step(10);
    cuda->step_in_stream(10, nullptr);
  }
  std::vector<Vec3> x(cpu->mass_count()), y(x.size());
  cpu->read_positions(x);
  cuda->read_positions(y);
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_LT(length(x[i] - y[i]), 1e-4f) << i;
}

}  // namespace
}  // namespace mercury
