// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/step.h"

#include "sim/cuda/device_limits.h"
#include "sim/cuda/material_table.cuh"
#include "sim/cuda/report.cuh"
#include "sim/cuda/step.cuh"
#include "sim/cuda/stream.h"

namespace mercury::cuda {
namespace {

// Registers are limited so that a multiprocessor holds 28 warps (launch_configuration.cpp).
template <Solver solver, class EnvironmentModel, class Memory, int record_words>
__global__ void __maxnreg__(72)
    step_kernel(const __grid_constant__ StepArguments arguments, const __grid_constant__ EnvironmentModel model) {
  using Stepper = RobotStepper<solver, EnvironmentModel, Memory, record_words>;
  const LaunchConfiguration& launch = arguments.launch;
  const BlockContext<solver, Memory> context(arguments, Stepper::Robot::fields);
  const ThreadContext<Memory>& thread = context.thread;
  // All warps of the block share one table, or those of each robot have their own.
  const bool shared = launch.shared_table;
  MaterialTable<solver> materials(
      arguments, shared ? context.first_robot : thread.robot, shared ? threadIdx.x / lanes : thread.warp,
      shared ? blockDim.x / lanes : launch.warps_per_robot, thread.lane, context.material_table);
  materials.fill(arguments);
  if constexpr (EnvironmentModel::real_bodies)
    if (launch.viscous) materials.fill_relaxation_times(context.relaxation_times);
  Stepper stepper(arguments, model, context);
  // Threads without a robot, or with one that exploded earlier, skip the work but take part in all barriers.
  const bool active = context.has_robot && stepper.alive();
  if (thread.warp == 0 && thread.lane == 0) *context.failure = {active ? Failure::never : 0, Failure::never};
  stepper.load_lengths(context.lengths);
  stepper.load_state();
  stepper.prefetch_environment();
  __syncthreads();
  int list_contacts = 1;

  for (std::uint32_t step = 0; step < arguments.steps; ++step) {
    if constexpr (EnvironmentModel::has_contacts)
      if (launch.contact_buckets > 0 && list_contacts) stepper.list_contacts();
    stepper.add_environment(step);
    if constexpr (solver == Solver::xpbd) {
      if (EnvironmentModel::has_faces || EnvironmentModel::has_contacts || arguments.batch.perturbation_count > 0)
        __syncthreads();
      stepper.predict(step);
      __syncthreads();
    } else if (stepper.sums_apart()) {
      __syncthreads();
      stepper.accelerate(step);
      __syncthreads();
    }
    stepper.add_springs(step);
    stepper.prefetch_end();
    __syncthreads();
    stepper.end(step);
    stepper.prefetch_environment();
    materials.update(arguments, step + 1);
    if constexpr (EnvironmentModel::has_contacts)
      list_contacts = __syncthreads_or(stepper.contacts_stale());
    else
      __syncthreads();
  }
  if (active) stepper.store_status();
  if (arguments.report) {
    materials.write_rates(arguments, arguments.steps);
    const std::uint32_t table = shared ? 0 : thread.robot;
    report<typename Stepper::Robot>(arguments, thread, arguments.batch.materials + std::size_t{table} * max_materials,
                                    context.has_robot ? arguments.report + thread.robot : nullptr);
  }
  if (active) stepper.store_state();
}

// step_model_of() has all others on the chip.
template <Solver solver, class EnvironmentModel, int record_words>
auto kernel_for(const LaunchConfiguration& launch) {
  if constexpr (solver == Solver::xpbd)
    if (launch.on_chip && !launch.valence_on_chip)
      return step_kernel<solver, EnvironmentModel, OnChipWithoutValence, record_words>;
  if constexpr (std::is_same_v<EnvironmentModel, GeneralModel>)
    if (!launch.on_chip) return step_kernel<solver, EnvironmentModel, OffChip, record_words>;
  return step_kernel<solver, EnvironmentModel, OnChip, record_words>;
}

template <Solver solver, class EnvironmentModel>
auto kernel_for(const LaunchConfiguration& launch) {
  return launch.record_words == 1 ? kernel_for<solver, EnvironmentModel, 1>(launch)
                                  : kernel_for<solver, EnvironmentModel, 2>(launch);
}

// Any thread may start this kernel with less shared memory, so it is allowed the most.
template <class Kernel>
void prepare(Kernel kernel) {
  const auto bytes = static_cast<int>(device_limits().shared_per_block);
  check(cudaFuncSetAttribute(kernel, cudaFuncAttributeMaxDynamicSharedMemorySize, bytes), "reserving shared memory");
}

template <Solver solver, class EnvironmentModel>
void start(const EnvironmentModel& model, const StepArguments& arguments, cudaStream_t stream) {
  const LaunchConfiguration& launch = arguments.launch;
  const auto kernel = kernel_for<solver, EnvironmentModel>(launch);
  const std::uint32_t blocks = (arguments.batch.robot_count + launch.robots_per_block - 1) / launch.robots_per_block;
  const std::uint32_t threads = launch.robots_per_block * launch.warps_per_robot * lanes;
  check(cudaFuncSetAttribute(kernel, cudaFuncAttributePreferredSharedMemoryCarveout,
                             static_cast<int>(launch.shared_percent)),
        "dividing memory between blocks and cache");
  kernel<<<blocks, threads, launch.shared_bytes, stream>>>(arguments, model);
  check(cudaGetLastError(), "starting the step kernel");
}

template <class Use>
auto with_kernel(Solver solver, const AnyEnvironmentModel& model, const LaunchConfiguration& launch, const Use& use) {
  return std::visit(
      [&](const auto& kind) {
        using EnvironmentModel = std::decay_t<decltype(kind)>;
        return use(solver == Solver::force ? kernel_for<Solver::force, EnvironmentModel>(launch)
                                           : kernel_for<Solver::xpbd, EnvironmentModel>(launch));
      },
      model);
}

}  // namespace

std::uint32_t robots_in_flight(Solver solver, const AnyEnvironmentModel& model, const LaunchConfiguration& launch) {
  return with_kernel(solver, model, launch, [&](auto kernel) {
    prepare(kernel);
    int blocks = 0;
    const auto threads = static_cast<int>(launch.robots_per_block * launch.warps_per_robot * lanes);
    check(cudaOccupancyMaxActiveBlocksPerMultiprocessor(&blocks, kernel, threads, launch.shared_bytes),
          "querying the occupancy");
    return static_cast<std::uint32_t>(blocks) * launch.robots_per_block * device_limits().multiprocessors;
  });
}

void prepare_steps(Solver solver, const AnyEnvironmentModel& model, const LaunchConfiguration& launch) {
  with_kernel(solver, model, launch, [](auto kernel) { prepare(kernel); });
}

void launch_steps(Solver solver, const AnyEnvironmentModel& model, const StepArguments& arguments,
                  cudaStream_t stream) {
  std::visit(
      [&](const auto& kind) {
        using EnvironmentModel = std::decay_t<decltype(kind)>;
        if (solver == Solver::force)
          start<Solver::force, EnvironmentModel>(kind, arguments, stream);
        else
          start<Solver::xpbd, EnvironmentModel>(kind, arguments, stream);
      },
      model);
}

}  // namespace mercury::cuda
