// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/step.h"

#include "sim/cuda/device_limits.h"
#include "sim/cuda/early_start.cuh"
#include "sim/cuda/stream.h"

namespace mercury::cuda {
namespace {

// Any thread may start this kernel with less shared memory, so it is allowed the most.
template <class Kernel>
void prepare(Kernel kernel, const LaunchConfiguration& launch) {
  const auto bytes = static_cast<int>(device_limits().shared_per_block);
  check(cudaFuncSetAttribute(kernel, cudaFuncAttributeMaxDynamicSharedMemorySize, bytes), "reserving shared memory");
  if (launch.parts > 1)
    check(cudaFuncSetAttribute(kernel, cudaFuncAttributeNonPortableClusterSizeAllowed, 1), "allowing clusters");
}

// How a kernel is started whose blocks each step `launch.robots_per_block` robots or one part of one.
class Start {
 public:
  Start(const LaunchConfiguration& launch, std::uint32_t robots, cudaStream_t stream) {
    configuration_.gridDim = divide_up(robots * launch.parts, launch.robots_per_block);
    configuration_.blockDim = launch.robots_per_block * launch.warps_per_robot * lanes;
    configuration_.dynamicSmemBytes = launch.shared_bytes;
    configuration_.stream = stream;
    configuration_.attrs = attributes_;
    if (launch.parts > 1) {
      cudaLaunchAttribute& cluster = attributes_[configuration_.numAttrs++];
      cluster.id = cudaLaunchAttributeClusterDimension;
      cluster.val.clusterDim = {launch.parts, 1, 1};
    }
  }
  Start(const Start&) = delete;
  Start& operator=(const Start&) = delete;

  void early() {
    if (kernels_can_start_early()) attributes_[configuration_.numAttrs++] = early_start();
  }
  const cudaLaunchConfig_t& configuration() const { return configuration_; }

 private:
  cudaLaunchConfig_t configuration_{};
  cudaLaunchAttribute attributes_[2]{};
};

template <class EnvironmentModel>
void start(Solver solver, const EnvironmentModel& model, const StepArguments& arguments, bool early,
           cudaStream_t stream) {
  const LaunchConfiguration& launch = arguments.launch;
  const auto kernel = step_kernel_for<EnvironmentModel>(solver, launch);
  check(cudaFuncSetAttribute(kernel, cudaFuncAttributePreferredSharedMemoryCarveout,
                             static_cast<int>(launch.shared_percent)),
        "dividing memory between blocks and cache");
  Start how(launch, arguments.batch.robot_count, stream);
  if (early) how.early();
  check(cudaLaunchKernelEx(&how.configuration(), kernel, arguments, model), "starting the step kernel");
}

template <class Use>
auto with_kernel(Solver solver, const StepModel& model, const LaunchConfiguration& launch, const Use& use) {
  return std::visit(
      [&](const auto& kind) { return use(step_kernel_for<std::decay_t<decltype(kind)>>(solver, launch)); }, model);
}

}  // namespace

std::uint32_t robots_in_flight(Solver solver, const StepModel& model, const LaunchConfiguration& launch) {
  return with_kernel(solver, model, launch, [&](auto kernel) {
    prepare(kernel, launch);
    int blocks = 0;
    if (launch.parts > 1) {
      const Start how(launch, 1, nullptr);
      if (cudaOccupancyMaxActiveClusters(&blocks, kernel, &how.configuration()) == cudaSuccess)
        return static_cast<std::uint32_t>(blocks);
      (void)cudaGetLastError();  // the device has no clusters of this size
      return 0u;
    }
    const auto threads = static_cast<int>(launch.robots_per_block * launch.warps_per_robot * lanes);
    check(cudaOccupancyMaxActiveBlocksPerMultiprocessor(&blocks, kernel, threads, launch.shared_bytes),
          "querying the occupancy");
    return static_cast<std::uint32_t>(blocks) * launch.robots_per_block * device_limits().multiprocessors;
  });
}

void prepare_steps(Solver solver, const StepModel& model, const LaunchConfiguration& launch) {
  with_kernel(solver, model, launch, [&](auto kernel) { prepare(kernel, launch); });
}

void launch_steps(Solver solver, const StepModel& model, const StepArguments& arguments, bool early,
                  cudaStream_t stream) {
  std::visit([&](const auto& kind) { start(solver, kind, arguments, early, stream); }, model);
}

}  // namespace mercury::cuda
