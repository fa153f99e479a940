// SPDX-License-Identifier: Apache-2.0
// The kernel that steps robots, and step_kernel_for() of an environment. Each environment has a module of its own
// (step_kernels/), because they compile side by side then, and a program loads only the one that it uses: all of them
// take 35 ms.
#pragma once

#include "sim/cuda/material_table.cuh"
#include "sim/cuda/report.cuh"
#include "sim/cuda/step.cuh"
#include "sim/cuda/step.h"
#include "sim/cuda/think.cuh"

namespace mercury::cuda {
namespace {

// The model of one robot, from what a kernel is given.
template <class Given>
struct ModelOfRobot {
  using Model = Given;
  __device__ static const Model& of(const Given& given, std::uint32_t) { return given; }
};
template <>
struct ModelOfRobot<OwnModels> {
  using Model = OwnModel;
  __device__ static const Model& of(const OwnModels& given, std::uint32_t robot) { return given.models[robot]; }
};

// A thread's part in its block.
template <Solver solver, class Given, class Memory_, int record_words>
struct BlockPart {
  using Memory = Memory_;
  using EnvironmentModel = typename ModelOfRobot<Given>::Model;
  using Stepper = RobotStepper<solver, EnvironmentModel, Memory, record_words>;
  using Robot = typename Stepper::Robot;

  BlockContext<solver, Memory> context;
  MaterialTable<solver> materials;
  Stepper stepper;

  __device__ BlockPart(const StepArguments& arguments, const Given& model)
      : context(arguments, Robot::fields, thread_index()), materials(table_of(arguments, context)),
        stepper(arguments, ModelOfRobot<Given>::of(model, context.thread.robot), context) {}

  // Threads without a robot, or with one that exploded before the launch, skip the work but take part in all barriers.
  __device__ bool active() const { return context.has_robot && !context.record->failure.before_launch(); }

 private:
  // The compiler takes it for another one each time.
  __device__ static std::uint32_t thread_index() {
    std::uint32_t index = threadIdx.x;
    asm volatile("" : "+r"(index));
    return index;
  }
  // All warps of the block share one table, or those of each robot have their own.
  __device__ static MaterialTable<solver> table_of(const StepArguments& arguments,
                                                   const BlockContext<solver, Memory>& context) {
    const LaunchConfiguration& launch = arguments.launch;
    const ThreadContext<Memory>& thread = context.thread;
    std::uint32_t warp = launch.first_warps_write ? thread.warp : launch.warps_per_robot - 1 - thread.warp,
                  warps = launch.warps_per_robot, robot = thread.robot;
    if (launch.shared_table) {
      warp = warp * launch.robots_per_block + context.number;
      warps *= launch.robots_per_block;
      robot = context.first_robot;
    }
    return {arguments, robot, warp, warps, thread.lane, context.material_table, context.moving, context.table_barriers};
  }
};

// Lets those robots of the block think that do so before this step. Returns the step before which one of them thinks
// next, or the end of the launch.
template <class Part, class Given>
__device__ std::uint32_t think_if_due(const StepArguments& arguments, const Given& model, std::uint32_t step) {
  Part part(arguments, model);
  const auto& thread = part.context.thread;
  // Tables are written, and all robots have read when the next one thinks.
  __syncthreads();
  std::uint32_t& own = part.context.next_thought[part.context.number];
  if (own == step) {
    const std::uint32_t next = think<Part::Robot::solver, typename Part::Memory>(
        arguments, part.context.brain, thread.masses, part.context.material_table, part.context.moving,
        SplitBarrier(shared_address(&part.context.record->thinking)), thread.robot, thread.warp, step);
    if (thread.warp == 0 && thread.lane == 0) own = next;
  }
  __syncthreads();
  std::uint32_t end = arguments.steps;
  for (std::uint32_t i = 0; i < arguments.launch.robots_per_block; ++i) end = min(end, part.context.next_thought[i]);
  return end;
}

// Reports all robots of the block after this number of steps, if that is due.
template <class Part, class Given>
__device__ void report_if_due(const StepArguments& arguments, const Given& model, std::uint32_t steps) {
  if (!arguments.reports.follow(steps)) return;
  Part part(arguments, model);
  const auto& thread = part.context.thread;
  if (part.active()) part.stepper.store_status();
  if (arguments.launch.apart) __syncthreads();  // all robots' springs are done
  const std::uint32_t written =
      part.materials.template write_rates<Part::EnvironmentModel::real_bodies>(arguments, steps);
  const std::uint32_t table = arguments.launch.shared_table ? 0 : thread.robot;
  report<typename Part::Robot>(arguments, thread, arguments.batch.materials + std::size_t{table} * max_materials,
                               part.context.has_robot ? arguments.reports.after(steps) + thread.robot : nullptr);
  if (steps == arguments.steps) return;
  __syncthreads();
  part.stepper.clear_sums();
  part.materials.write_coefficients(arguments, written);
  __syncthreads();
}

// Registers are limited so that a multiprocessor holds 28 warps (launch_configuration.cpp).
template <Solver solver, class Given, class Memory, int record_words>
__global__ void __maxnreg__(72)
    step_kernel(const __grid_constant__ StepArguments arguments, const __grid_constant__ Given model) {
  using Part = BlockPart<solver, Given, Memory, record_words>;
  using EnvironmentModel = typename Part::EnvironmentModel;
  constexpr bool has_contacts = Part::Stepper::has_contacts;
  const LaunchConfiguration& launch = arguments.launch;
  wait_for_kernel_before();
  let_next_kernel_start();
  {
    Part part(arguments, model);
    part.stepper.load_state();
    part.materials.fill(arguments);
    if constexpr (EnvironmentModel::real_bodies)
      if (launch.viscous) part.materials.fill_relaxation_times(part.context.relaxation_times);
    const ThreadContext<Memory>& thread = part.context.thread;
    if (thread.warp == 0 && thread.lane == 0) {
      part.context.record->failure = {part.context.has_robot && part.stepper.alive() ? Failure::never : 0,
                                      Failure::never};
      if (!Memory::in_parts && arguments.thoughts.thinkers) {
        SplitBarrier(shared_address(&part.context.record->thinking)).begin(launch.warps_per_robot);
        part.context.next_thought[part.context.number] =
            part.context.has_robot ? first_thought(arguments, thread.robot) : Thoughts::none;
      }
    }
    const bool has_brain = !Memory::in_parts && arguments.thoughts.thinkers && arguments.steps > 0 &&
                           part.context.has_robot && arguments.thoughts.thinkers[thread.robot] != Thoughts::none;
    if (has_brain) load_brain<Memory>(arguments, part.context.brain, thread.robot, thread.warp);
    part.stepper.load_lengths(part.context.lengths);
    Memory::wait_for_copies();
    if constexpr (has_contacts) part.stepper.begin_contacts();
    robot_barrier<Memory>();
    if (has_brain && thread.warp == 0 && thread.lane == 0)
      complete_brain<Memory>(arguments, part.context.brain, thread.robot);
  }

  for (std::uint32_t step = 0;;) {
    if constexpr (!Memory::in_parts) report_if_due<Part>(arguments, model, step);
    if (step == arguments.steps) break;
    std::uint32_t end = arguments.reports.next(step, arguments.steps);
    if constexpr (!Memory::in_parts)
      if (arguments.thoughts.thinkers) end = min(end, think_if_due<Part>(arguments, model, step));
    float reach = __builtin_huge_valf();
    if constexpr (has_contacts)
      if (launch.contact_buckets > 0) reach = Part(arguments, model).stepper.update_contacts(step);
    // What the inner loop needs is worked out after the calls that a thought and a list of contacts are: kept across
    // them, it would cost the loop an eighth of its speed.
    Part part(arguments, model);
    auto& [context, materials, stepper] = part;
    if constexpr (has_contacts) stepper.use_contacts(reach);
    stepper.prefetch_environment();
    const auto duty = materials.duty(launch);
    for (bool stale = false; step < end && !stale; ++step) {
      stepper.add_environment(step);
      if constexpr (solver == Solver::xpbd) {
        if (EnvironmentModel::has_faces || has_contacts || arguments.batch.perturbation_count > 0)
          robot_barrier<Memory, has_contacts>(launch);
        stepper.predict(step);
        stepper.export_state();
        robot_barrier<Memory, has_contacts>(launch);
      } else if (stepper.sums_apart()) {
        robot_barrier<Memory, has_contacts>(launch);
        stepper.accelerate(step);
        stepper.export_state();
        robot_barrier<Memory, has_contacts>(launch);
      }
      materials.wait_until_written(launch, step, duty);
      stepper.add_springs(step);
      stepper.prefetch_end();
      barrier_after_springs<Memory, has_contacts>(launch);
      materials.springs_end(context.thread.warp == 0 && context.thread.lane == 0, duty);
      stepper.end(step);
      stepper.export_state();
      stepper.prefetch_environment();
      if constexpr (has_contacts)
        stale = stepper.contacts_stale(step);
      else
        robot_barrier<Memory, has_contacts>(launch);
      materials.update(arguments, step, duty);
    }
  }
  Part part(arguments, model);
  if constexpr (has_contacts)
    if (part.context.has_robot && arguments.steps > 0) part.stepper.keep_contacts();
  if (!part.active()) return;
  part.stepper.store_status();
  part.stepper.store_state();
}

// step_model_of() gives all others what is on the chip whole.
template <Solver solver, class EnvironmentModel, int record_words>
StepKernel<EnvironmentModel> kernel_for(const LaunchConfiguration& launch) {
  if constexpr (std::is_same_v<EnvironmentModel, OwnModels>) {
    if (launch.parts > 1)
      return launch.contact_buckets > 0 ? step_kernel<solver, EnvironmentModel, InParts, record_words>
                                        : step_kernel<solver, EnvironmentModel, InPartsWithoutContacts, record_words>;
    if (!launch.on_chip) return step_kernel<solver, EnvironmentModel, OffChip, record_words>;
    if constexpr (solver == Solver::xpbd)
      if (!launch.valence_on_chip) return step_kernel<solver, EnvironmentModel, OnChipWithoutValence, record_words>;
  }
  if constexpr (has_kernel_in_parts<EnvironmentModel>)
    if (launch.parts > 1) return step_kernel<solver, EnvironmentModel, InPartsWithoutContacts, record_words>;
  return step_kernel<solver, EnvironmentModel, OnChip, record_words>;
}

template <Solver solver, class EnvironmentModel>
StepKernel<EnvironmentModel> kernel_for(const LaunchConfiguration& launch) {
  return launch.record_words == 1 ? kernel_for<solver, EnvironmentModel, 1>(launch)
                                  : kernel_for<solver, EnvironmentModel, 2>(launch);
}

}  // namespace

template <class EnvironmentModel>
StepKernel<EnvironmentModel> step_kernel_for(Solver solver, const LaunchConfiguration& launch) {
  return solver == Solver::force ? kernel_for<Solver::force, EnvironmentModel>(launch)
                                 : kernel_for<Solver::xpbd, EnvironmentModel>(launch);
}

}  // namespace mercury::cuda
