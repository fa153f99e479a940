// SPDX-License-Identifier: Apache-2.0
// On the CPU, drives change muscles alone. That gives the same bits as writing the materials that they mean.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "kernel_cases.h"
#include "mercury/simulation.h"
#include "mixed_robots.h"
#include "plain_backend.h"
#include "same_telemetry.h"

namespace mercury {
namespace {

using test::KernelCase;

// A simulation whose backend reads the drives, and one whose backend is given materials. The same is done to both.
class Both {
 public:
  Both(const KernelCase& kernel, const std::vector<Robot>& robots)
      : reading_(kernel.configuration(), robots, cpu::make_backend({.threads = 1}, kernel.kernel)),
        written_(kernel.configuration(), robots,
                 std::make_unique<test::PlainBackend>(cpu::make_backend({.threads = 1}, kernel.kernel))) {}

  Simulation& reading() { return reading_; }
  void change(const auto& what) {
    what(reading_);
    what(written_);
  }
  // Settings of all kinds: none, usual, beyond the limits.
  void drive(std::uint32_t seed) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float amplitudes[] = {nan, 0.3f, -0.2f, 0, 7, -infinity}, frequencies[] = {nan, 4, 0, -2, infinity, 1e5f},
                phases[] = {nan, 1, -3, 0, 1e4f, infinity}, drives[] = {nan, nan, 0.25f, -1, 1, -3};
    change([&](Simulation& simulation) {
      const Actuation& actuation = simulation.actuation();
      std::mt19937 random(seed);
      for (std::size_t i = 0; i < actuation.drive.rows * actuation.drive.columns; ++i) {
        actuation.amplitude.data.get()[i] = amplitudes[random() % 6];
        actuation.frequency.data.get()[i] = frequencies[random() % 6];
        actuation.phase.data.get()[i] = phases[random() % 6];
        const float drive = actuation.drive.data.get()[i] = drives[random() % 6];
        actuation.driven.data.get()[i] = !std::isnan(drive);
      }
    });
  }
  void step(std::int64_t steps) {
    change([&](Simulation& simulation) { simulation.step(steps); });
  }
  void expect_equal_bits() {
    EXPECT_EQ(reading_.hashes(), written_.hashes());
    const std::vector<Telemetry> a = reading_.telemetry(), b = written_.telemetry();
    for (std::size_t i = 0; i < a.size(); ++i) expect_equal(a[i], b[i]);
    EXPECT_EQ(reading_.materials(), written_.materials());
  }

 private:
  Simulation reading_, written_;
};

// Actuators by name for some, those that actuators_of() finds for the others.
std::vector<Robot> robots_for(std::size_t lanes) {
  std::vector<Robot> robots = test::mixed_robots(lanes);
  for (std::size_t i = 0; i < robots.size(); i += 3) {
    robots[i].actuators = {{"some", {}}, {"more", {}}};  // and some have none
    for (std::size_t id = 1; id < materials_of(robots[i]).size(); ++id)
      if (id % 4 < 2) robots[i].actuators[id % 4].materials.push_back(static_cast<MaterialId>(id));
  }
  for (std::size_t i = 0; i < lanes; ++i) robots.push_back(robots[0]);  // a group of one topology
  return robots;
}

class CpuActuation : public testing::TestWithParam<KernelCase> {
 protected:
  std::vector<Robot> robots_ = robots_for(GetParam().kernel.lanes);
};
INSTANTIATE_TEST_SUITE_P(Kernels, CpuActuation, testing::ValuesIn(test::every_kernel_case()),
                         test::name_of_kernel_case);

TEST_P(CpuActuation, GivesTheBitsOfWrittenMaterials) {
  Both both(GetParam(), robots_);
  both.step(3);
  for (const std::uint32_t seed : {1, 2, 2, 3}) {
    both.drive(seed);
    both.step(1 + 13 * static_cast<std::int64_t>(seed));
    both.expect_equal_bits();
    both.step(5);  // nothing has changed
    both.expect_equal_bits();
  }
  const std::vector<Telemetry> telemetry = both.reading().telemetry();
  EXPECT_LT(std::ranges::count(telemetry, true, &Telemetry::exploded), std::ssize(telemetry) / 2);
}

TEST_P(CpuActuation, ChangesNothingWithItsInitialValues) {
  Simulation plain(GetParam().configuration(), robots_, cpu::make_backend({.threads = 1}, GetParam().kernel));
  Simulation actuated(GetParam().configuration(), robots_, cpu::make_backend({.threads = 1}, GetParam().kernel));
  plain.step(10);
  actuated.step(10);
  actuated.actuation();
  plain.step(40);
  actuated.step(40);
  EXPECT_EQ(actuated.hashes(), plain.hashes());
}

TEST_P(CpuActuation, FollowsChangesOfMaterialsTimeAndConfiguration) {
  Both both(GetParam(), robots_);
  both.drive(1);
  both.step(10);
  both.change([](Simulation& simulation) {
    const Material own = simulation.material(0, 1);
    simulation.set_material(0, 1, {2 * own.stiffness, 0.1f, 3, 0.5f});
  });
  both.expect_equal_bits();  // drives act from the next step on
  both.step(10);
  both.expect_equal_bits();
  both.change([](Simulation& simulation) {
    Configuration changed = simulation.configuration();
    changed.dt = 5e-4;
    simulation.configure(changed);
  });
  both.drive(2);
  both.step(10);
  both.change(
      [](Simulation& simulation) { simulation.set_clock({.dt = 5e-4, .base_time = 100, .base_step = 7, .step = 12}); });
  both.step(10);
  both.change([](Simulation& simulation) { simulation.set_materials(simulation.materials()); });
  both.step(10);
  both.expect_equal_bits();
  both.change([](Simulation& simulation) { simulation.reset(); });
  both.step(10);
  both.expect_equal_bits();
}

TEST_P(CpuActuation, FollowsRobotsThatExplodeComeAndGo) {
  Both both(GetParam(), robots_);
  both.drive(1);
  both.step(10);
  both.change([](Simulation& simulation) {  // breaks up a group
    State state = simulation.state(1);
    state.velocities[0] = {std::numeric_limits<float>::infinity(), 0, 0};
    simulation.set_state(1, state.positions, state.velocities);
  });
  both.drive(2);
  both.step(10);
  EXPECT_TRUE(both.reading().telemetry(1).exploded);
  both.drive(3);
  both.step(40);
  both.expect_equal_bits();
  both.change([&](Simulation& simulation) { simulation.add(robots_[0]); });
  both.step(5);  // what was driven stays driven
  both.expect_equal_bits();
  both.drive(4);
  both.step(5);
  both.change([](Simulation& simulation) { simulation.keep(std::vector<std::size_t>{5, 1, 0, 3}); });
  both.step(5);
  both.expect_equal_bits();
  both.drive(5);
  both.step(5);
  both.expect_equal_bits();
}

// A star of as many springs as a table has materials, each an actuator of its own.
Robot star() {
  Robot robot{.name = "star", .materials = {{}}, .masses = {{0, 0, 0}}};
  for (int i = 1; i < max_materials; ++i) {
    const auto angle = static_cast<float>(i);
    robot.masses.push_back({std::cos(angle), std::sin(angle), 0.1f * std::cos(5 * angle)});
    robot.materials.push_back({50, 0.1f, 1, angle});
    robot.springs.push_back({0, static_cast<std::uint16_t>(i), static_cast<MaterialId>(i), 1});
    robot.actuators.push_back({.name = std::to_string(i), .materials = {static_cast<MaterialId>(i)}});
  }
  return robot;
}

TEST_P(CpuActuation, DrivesAsManyActuatorsAsRobotsCanHave) {
  Both both(GetParam(), std::vector<Robot>(2 * GetParam().kernel.lanes + 1, star()));
  EXPECT_EQ(both.reading().actuation().drive.columns, 255u);
  for (const std::uint32_t seed : {1, 2}) {
    both.drive(seed);
    both.step(10);
    both.expect_equal_bits();
  }
}

}  // namespace
}  // namespace mercury
