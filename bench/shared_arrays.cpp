// SPDX-License-Identifier: Apache-2.0
// Measures what it costs a program to step robots in its own CUDA stream, to drive their actuators and to read their
// states on the device: bench_shared_arrays [robots [steps per call [seconds per row]]]
//
// The robots are solids of 5 x 5 x 5 voxels of muscle, with 216 masses. All rows step the same robots. They take turns
// of 50 calls, so that a change of the clock rate affects all; the times are medians. "host" is how long the host takes
// to queue a call.
#include <cuda_runtime_api.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <vector>

#include "bench/timing.h"
#include "mercury/cuda_devices.h"
#include "mercury/random_voxel.h"
#include "mercury/simulation.h"
#include "mercury/stopwatch.h"
#include "sim/cuda/launch_configuration.h"
#include "sim/cuda/memory.h"

namespace {

using namespace mercury;

constexpr int calls_per_turn = 50;

struct Mode {
  const char* name;
  bool in_stream, driven, published;
};
constexpr Mode modes[] = {{"step()", false, false, false},
                          {"step_in_stream()", true, false, false},
                          {"  arrays written", true, false, true},
                          {"  actuators driven", true, true, false},
                          {"  both", true, true, true}};

// Steps one batch as a program in one of the modes does.
class Loop {
 public:
  Loop(const Mode& mode, const std::vector<Robot>& robots, std::int64_t steps)
      : mode_(mode), steps_(steps), simulation_({.device = {.kind = DeviceKind::cuda}}, robots) {
    if (mode_.published) {
      positions_ = simulation_.shared_state(StateArray::positions);
      centers_ = simulation_.shared_state(StateArray::centers);
      observed_ = cuda::DeviceArray<float>(3 * robots.size());
    }
    if (!mode_.driven) return;
    drive_ = simulation_.actuation().drive;
    for (cuda::DeviceArray<float>& drives : drives_) {
      std::vector<float> values(drive_.rows * drive_.columns);
      for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = static_cast<float>(i % 101) / 50 - (&drives == &drives_[0] ? 1.f : 1.01f);
      drives = cuda::DeviceArray<float>(values.size());
      drives.write(0, values, stream_.get());
    }
  }

  // Some calls, without and with waiting for the device.
  void take_turn() {
    const double start = wall_now();
    for (int call = 0; call < calls_per_turn; ++call) step();
    queued_.push_back((wall_now() - start) / calls_per_turn);
    stream_.synchronize();
    done_.push_back((wall_now() - start) / calls_per_turn);
  }

  double seconds_per_call() const { return median(done_); }
  double host_seconds_per_call() const { return median(queued_); }
  std::size_t actuators() const { return drive_.columns; }

 private:
  void step() {
    if (!mode_.in_stream) return simulation_.step(steps_);
    if (mode_.driven) copy(drive_.data.get(), drives_[calls_++ % 2]);
    simulation_.step_in_stream(steps_, stream_.get());
    if (mode_.published)
      cuda::check(cudaMemcpyAsync(observed_.data(), centers_.data.get(), observed_.size() * sizeof(float),
                                  cudaMemcpyDeviceToDevice, stream_.get()),
                  "reading");
  }
  void copy(float* to, const cuda::DeviceArray<float>& from) {
    cuda::check(cudaMemcpyAsync(to, from.data(), from.size() * sizeof(float), cudaMemcpyDeviceToDevice, stream_.get()),
                "driving");
  }

  const Mode mode_;
  const std::int64_t steps_;
  Simulation simulation_;
  cuda::Stream stream_;
  SharedArray<float> positions_, centers_, drive_;
  cuda::DeviceArray<float> drives_[2], observed_;
  std::size_t calls_ = 0;
  std::vector<double> queued_, done_;
};

// 32 materials each: what a table needs for the materials that the springs of any one robot have.
std::uint32_t table_chunks(const std::vector<Robot>& robots) {
  std::size_t most = 0;
  for (const Robot& robot : robots) {
    std::vector<bool> used(max_materials);
    for (const Spring& spring : robot.springs) used[spring.material] = true;
    used[air] = true;
    most = std::max(most, static_cast<std::size_t>(std::ranges::count(used, true)));
  }
  return static_cast<std::uint32_t>((most + cuda::lanes - 1) / cuda::lanes);
}

void print_launch(const std::vector<Robot>& robots, bool same_materials) {
  const cuda::BatchView batch{.robot_count = static_cast<std::uint32_t>(robots.size()),
                              .tile_stride = cuda::tiles_for(robots[0].masses.size()),
                              .record_words = 1};
  const cuda::LaunchConfiguration launch = cuda::choose_launch_configuration(
      {.environment = Ocean{}}, batch, same_materials, false, robots.size(), same_materials ? 8 : table_chunks(robots));
  std::printf("%-22s %u robots per block, %u warps per robot, %u copies of %u materials, %zu bytes\n",
              same_materials ? "  one material table" : "  a table per robot", launch.robots_per_block,
              launch.warps_per_robot, 1u << launch.table_copy_bits, 32 * launch.table_chunks, launch.shared_bytes);
}

}  // namespace

int main(int argc, char** argv) try {
  const int count = argc > 1 ? std::atoi(argv[1]) : 1024, steps = argc > 2 ? std::atoi(argv[2]) : 20;
  const double seconds = argc > 3 ? std::atof(argv[3]) : 1;
  if (cuda_device_count() == 0) {
    std::puts("no CUDA device: nothing to measure");
    return 0;
  }
  if (count < 1 || steps < 1) {
    std::fputs("bench_shared_arrays [robots >= 1 [steps per call >= 1 [seconds per row]]]\n", stderr);
    return 2;
  }
  RandomVoxelOptions solid;
  solid.smallest = solid.largest = {5, 5, 5};
  solid.air = solid.tissue = solid.bone = 0;
  solid.mirror = Mirror::none;
  solid.frequencies = 5;
  const std::vector<Robot> robots = random_voxel_robots(solid, 1, static_cast<std::size_t>(count));
  std::vector<std::unique_ptr<Loop>> loops;
  for (const Mode& mode : modes) loops.push_back(std::make_unique<Loop>(mode, robots, steps));
  const double start = wall_now();
  do {
    for (const auto& loop : loops) loop->take_turn();
  } while (wall_now() - start < seconds * static_cast<double>(loops.size()));

  std::printf("%s, %d robots of %zu masses and %zu springs, %zu actuators, %d steps per call\n",
              cuda_device_name(0).c_str(), count, robots[0].masses.size(), robots[0].springs.size(),
              loops.back()->actuators(), steps);
  for (std::size_t i = 0; i < loops.size(); ++i) {
    const double call = loops[i]->seconds_per_call();
    std::printf("%-22s %8.1f us per call, host %7.1f us, %.3e robot steps/s, %6.3f\n", modes[i].name, 1e6 * call,
                1e6 * loops[i]->host_seconds_per_call(), count * steps / call, loops[0]->seconds_per_call() / call);
  }
  for (const bool same : {true, false}) print_launch(robots, same);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "bench_shared_arrays: %s\n", error.what());
  return 1;
}
