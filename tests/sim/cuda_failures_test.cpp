// SPDX-License-Identifier: Apache-2.0
// A GPU without room or one that fails: one line says so, and what helps.
#include "sim/cuda/failures.h"

#include <gmock/gmock.h>

#include <cstdlib>

#include "mercury/cuda_devices.h"
#include "mercury/simulation.h"
#include "sim/cuda/memory.h"
#include "tests/sim/bodies.h"

namespace mercury {
namespace {

using testing::HasSubstr;
using testing::MatchesRegex;

TEST(CudaFailures, SayWhatHappenedAndWhatHelps) {
  EXPECT_THAT(cuda::failure_text(cudaErrorIllegalAddress, "stepping"),
              MatchesRegex("the GPU failed while stepping \\(.+\\): start the program again.*"));
  EXPECT_THAT(cuda::failure_text(cudaErrorECCUncorrectable, "stepping"), HasSubstr("start the program again"));
  EXPECT_THAT(cuda::failure_text(cudaErrorDevicesUnavailable, "choosing the device"), HasSubstr("another program"));
  EXPECT_THAT(cuda::failure_text(cudaErrorMemoryAllocation, "choosing the device"), HasSubstr("other programs use it"));
  EXPECT_THAT(cuda::failure_text(cudaErrorInvalidValue, "stepping"), MatchesRegex("CUDA: stepping: .+"));
}

class OnGpu : public testing::Test {
 protected:
  void SetUp() override {
    if (cuda_device_count() == 0) GTEST_SKIP() << "no CUDA device on this machine";
  }
  static Configuration configuration() { return {.device = {.kind = DeviceKind::cuda}}; }
  static Robot body() { return bodies::voxels({10, 10, 10}, {.stiffness = 50}); }
};

// Takes memory until little more than `left` bytes are free. Other programs may take and free some meanwhile.
void take_all_but(std::size_t left, std::vector<std::shared_ptr<void>>& taken) {
  for (std::size_t piece = std::size_t{8} << 30; piece >= left / 4; piece /= 2)
    while (free_cuda_memory(0) > left + piece) {
      try {
        taken.push_back(cuda::allocate_to_share(piece));
      } catch (const DeviceError&) {
        break;  // another program was faster
      }
    }
}

// As if another program held the rest.
TEST_F(OnGpu, WithoutRoomSaysWhatIsNeededAndWhatIsFreeAndGoesOnAfterwards) {
  constexpr std::size_t left = std::size_t{256} << 20;
  const std::vector<Robot> few(2, body()), many(20000, body());
  Simulation before(configuration(), few);  // takes what a first use takes
  std::vector<std::shared_ptr<void>> taken;
  std::string refusal;
  constexpr int attempts = 10;  // other programs may have freed so much that the batch fits
  for (int attempt = 0; attempt < attempts && refusal.empty(); ++attempt) {
    take_all_but(left, taken);
    try {
      const Simulation batch(configuration(), many);
    } catch (const DeviceError& error) {
      refusal = error.what();
    }
  }
  EXPECT_THAT(refusal, MatchesRegex("the GPU has no room for [0-9.]+ [MG]B more; [0-9.]+ [MG]B of its "
                                    "[0-9.]+ GB are free: give it fewer or smaller robots, or end other "
                                    "programs that use it"));
  // What was there goes on, and once there is room, the batch is accepted.
  before.step(10);
  taken.clear();
  // Of what was refused at most `left` could have stayed, which is no obstacle: what is missing now, others have.
  try {
    Simulation after(configuration(), few), batch(configuration(), many);
    after.step(10);
    batch.step(10);
    EXPECT_EQ(before.hash(0), after.hash(0));
    EXPECT_EQ(batch.hash(0), after.hash(0));
  } catch (const DeviceError& error) {
    GTEST_SKIP() << "other programs have taken the memory meanwhile: " << error.what();
  }
}

// Reads a mask from where no memory is: all that the process still wants from the GPU fails.
void lose(Simulation& simulation) { simulation.reset_in_stream(reinterpret_cast<const std::uint8_t*>(8), nullptr); }

// In a process of its own, since it can use the GPU no more. Only on request: after such a fault OpenGL drew nothing
// but black on a headless H100, in every later process.
TEST_F(OnGpu, ThatFailsEndsInADeviceError) {
  if (!std::getenv("MERCURY_TEST_GPU_FAULT")) GTEST_SKIP() << "set MERCURY_TEST_GPU_FAULT=1 to let the GPU fail";
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto attempt = [] {
    Simulation simulation(configuration(), std::vector<Robot>{body()});
    simulation.step(10);
    lose(simulation);
    try {
      simulation.step(10);
      simulation.hash(0);
    } catch (const DeviceError& error) {
      std::fprintf(stderr, "%s", error.what());
      std::exit(7);
    }
    std::exit(8);
  };
  EXPECT_EXIT(attempt(), testing::ExitedWithCode(7), "^the GPU failed while .*: start the program again");
}

}  // namespace
}  // namespace mercury
