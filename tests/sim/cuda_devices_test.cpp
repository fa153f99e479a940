// SPDX-License-Identifier: Apache-2.0
// How much shared memory a robot needs, whether it fits on the CUDA device of this machine, and what is asked of
// devices.
#include "mercury/cuda_devices.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

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

TEST(CudaDevices, OneThatIsNotThereIsRefused) {
  const int count = cuda_device_count();
  EXPECT_THROW(require_cuda_device(count), DeviceError);
  if (count == 0) {
    EXPECT_THROW(require_cuda_device(Device::all_devices), DeviceError);
  } else {
    EXPECT_NO_THROW(require_cuda_device(count - 1));
    EXPECT_NO_THROW(require_cuda_device(Device::all_devices));
  }
}

// The number for one amount of work is a choice, but more work never has fewer.
TEST(CudaDevices, MoreWorkHasMoreQueuesUnlessTheUserSaysHowMany) {
  if (!built_with_cuda()) GTEST_SKIP() << "a build without CUDA";
  constexpr const char* variable = "CUDA_DEVICE_MAX_CONNECTIONS";
  const char* const before = std::getenv(variable);
  const std::string user = before ? before : "";
  std::vector<int> queues;
  for (const double steps : {0.0, 1e5, 1e7, 1e8, 1e9, 1e12}) {
    unsetenv(variable);
    prepare_cuda_for(steps);
    queues.push_back(std::stoi(std::getenv(variable)));
  }
  EXPECT_TRUE(std::ranges::is_sorted(queues));
  EXPECT_EQ(queues.front(), 1);
  EXPECT_GT(queues.back(), 8);   // more than CUDA makes by itself
  EXPECT_LE(queues.back(), 32);  // and no more than it can
  setenv(variable, "5", 1);
  prepare_cuda_for(1e12);
  EXPECT_STREQ(std::getenv(variable), "5");
  unsetenv(variable);
  if (before) setenv(variable, user.c_str(), 1);
}

}  // namespace
}  // namespace mercury
