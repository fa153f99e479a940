// SPDX-License-Identifier: Apache-2.0
// A recording keeps its frames when the device that simulates fails.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>

#include "app/recording/trajectory_reader.h"
#include "mercury/cuda_devices.h"
#include "mercury/error.h"
#include "tests/app/program.h"
#include "tests/app/recording/recording_bodies.h"
#include "tests/same_bits.h"

namespace mercury::test {
namespace {

class RecordingWithoutDevice : public FolderTest {
 protected:
  std::string file() const { return path("a.h5"); }
};

// What a simulation on a failed device does.
TEST_F(RecordingWithoutDevice, AFrameThatIsNotCommittedDoesNotCount) {
  const std::vector<Robot> robots{pair("a"), pair("b")};
  const Robot* const pointers[] = {&robots[0], &robots[1]};
  Simulation simulation(on_cpu(), robots);
  TrajectoryWriter writer(file(), {}, pointers, simulation.materials(), "--record");
  for (const std::int64_t step : {0, 10, 20}) {
    const TrajectoryWriter::Frame frame = writer.add(step, 0.001 * static_cast<double>(step));
    std::ranges::fill(frame.positions, Vec3{static_cast<float>(step), 1, 2});
    std::ranges::fill(frame.velocities, Vec3{});
    writer.commit();
  }
  writer.add(30, 0.03);
  writer.finish({});

  TrajectoryReader reader(file());
  ASSERT_EQ(reader.frames(), 3u);
  EXPECT_EQ(reader.step(2), 20);
  EXPECT_EQ(reader.positions(2)[0], (Vec3{20, 1, 2}));
}

std::vector<Vec3> positions_of(const Simulation& simulation) {
  std::vector<Vec3> all(simulation.mass_count());
  simulation.read_positions(all);
  return all;
}

// In a process of its own, since it can use the GPU no more. Only on request: see tests/sim/cuda_failures_test.cpp.
TEST_F(RecordingWithoutDevice, KeepsItsFramesWhenTheGpuFails) {
  if (cuda_device_count() == 0) GTEST_SKIP() << "no CUDA device on this machine";
  if (!std::getenv("MERCURY_TEST_GPU_FAULT")) GTEST_SKIP() << "set MERCURY_TEST_GPU_FAULT=1 to let the GPU fail";
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const std::string kept = "/tmp/mercury-kept-" + std::to_string(getpid()) + ".h5";
  setenv("MERCURY_TEST_KEPT", kept.c_str(), 0);  // the other process gets the same name
  const std::string name = getenv("MERCURY_TEST_KEPT");
  const Configuration on_gpu{.device = {.kind = DeviceKind::cuda}};
  const auto attempt = [&] {
    Simulation simulation(on_gpu, std::vector<Robot>{small_voxel_robot(0)});
    Recorder recorder(simulation, name, {.every = 10});
    for (int frame = 0; frame < 5; ++frame) {
      simulation.step(10);
      recorder.observe();
    }
    simulation.reset_in_stream(reinterpret_cast<const std::uint8_t*>(8), nullptr);  // reads where no memory is
    try {
      simulation.step(10);
      recorder.observe();
    } catch (const DeviceError&) {
      recorder.finish_without_device();
      std::exit(7);
    }
    std::exit(8);
  };
  EXPECT_EXIT(attempt(), testing::ExitedWithCode(7), "");
  Simulation again(on_gpu, std::vector<Robot>{small_voxel_robot(0)});
  TrajectoryReader reader(name);
  std::filesystem::remove(name);
  ASSERT_EQ(reader.frames(), 6u);
  for (std::size_t frame = 0; frame < 6; ++frame) {
    EXPECT_TRUE(same_bits(reader.positions(frame), positions_of(again))) << frame;
    again.step(10);
  }
}

}  // namespace
}  // namespace mercury::test
