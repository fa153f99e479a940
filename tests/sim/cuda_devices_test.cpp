// SPDX-License-Identifier: Apache-2.0
// How much shared memory a robot needs, and whether it fits on the CUDA device of this machine.
#include "mercury/cuda_devices.h"

#include <gtest/gtest.h>

#include "mercury/error.h"
#include "mercury/simulation.h"

namespace mercury {
namespace {

// Masses in a row, each joined to the next.
Robot chain(std::size_t masses) {
  Robot robot;
  robot.name = "chain";
  for (std::size_t i = 0; i < masses; ++i) robot.masses.push_back({static_cast<float>(i), 0, 0});
  for (std::size_t i = 0; i + 1 < masses; ++i)
    robot.springs.push_back({static_cast<std::uint16_t>(i), static_cast<std::uint16_t>(i + 1), 1, 1});
  return robot;
}

TEST(Chip, AMassTakesThe36BytesOfThePaper) {
  const Configuration water;
  const auto bytes = [&](std::size_t masses) { return chip_bytes(chain(masses), water); };
  EXPECT_EQ(bytes(1280) - bytes(64), 1216u * 36);
  EXPECT_EQ(bytes(33), bytes(64));  // tiles of 32
  EXPECT_LT(bytes(1), 5 * 1024u);   // the tables
  EXPECT_LE(bytes(1248), 48 * 1024u);
}

TEST(Chip, XpbdNeedsNoMore) {
  const Robot robot = chain(640);
  EXPECT_EQ(chip_bytes(robot, {.solver = Solver::xpbd}), chip_bytes(robot, {}));
}

TEST(Chip, LandNeedsMoreOnlyForContacts) {
  const Robot robot = chain(640);
  EXPECT_GT(chip_bytes(robot, {.environment = Land{}}), chip_bytes(robot, {}));
  EXPECT_EQ(chip_bytes(robot, {.environment = Land{.self_collision = false}}), chip_bytes(robot, {}));
}

TEST(Chip, AMissingDeviceIsAnError) {
  EXPECT_THROW(chip_fit(chain(10), {}, cuda_device_count()), DeviceError);
  EXPECT_THROW(chip_fit(chain(10), {}, -1), DeviceError);
}

TEST(Chip, AgreesWithABatchOnTheDevice) {
  if (cuda_device_count() == 0) GTEST_SKIP() << "no CUDA device";
  for (const Environment& environment : {Environment(Ocean{}), Environment(Land{})})
    for (const Solver solver : {Solver::force, Solver::xpbd})
      for (const std::size_t masses : {27, 216, 1331, 3000, 20000}) {
        const Configuration configuration{
            .solver = solver, .environment = environment, .device = {.kind = DeviceKind::cuda}};
        const Robot robot = chain(masses);
        const ChipFit fit = chip_fit(robot, configuration, 0);
        const Simulation batch(configuration, std::vector<Robot>(masses > 10000 ? 200 : 600, robot));
        EXPECT_EQ(fit.on_chip, batch.notes().empty()) << masses;
        EXPECT_EQ(fit.robots_at_once, batch.robots_at_once()) << masses;
        EXPECT_EQ(chip_bytes(robot, configuration) <= fit.most_bytes, fit.contacts_on_chip) << masses;
      }
}

}  // namespace
}  // namespace mercury
