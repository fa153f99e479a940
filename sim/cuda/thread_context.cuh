// SPDX-License-Identifier: Apache-2.0
// Where a thread finds its robot, its block's tables, and its own masses (block_layout.h), and what a robot's threads
// share.
#pragma once

#include "sim/cuda/block_layout.h"
#include "sim/cuda/mass_memory.cuh"
#include "sim/cuda/step.h"

namespace mercury::cuda {

extern __shared__ char shared_memory[];

__device__ inline std::uint32_t shared_address(const void* pointer) {
  return static_cast<std::uint32_t>(__cvta_generic_to_shared(pointer));
}

// Waits for the warps of one robot of the block, by its number there. Barrier 0 is __syncthreads().
__device__ inline void wait_for_robot(std::uint32_t number, std::uint32_t warps) {
  if (warps == 1) return __syncwarp();
  asm volatile("bar.sync %0, %1;" ::"r"(1 + number), "r"(warps * lanes) : "memory");
}
// The number of this thread's robot in its block. It takes no register from the steps, and is computed where robots
// wait apart.
__device__ inline std::uint32_t number_in_block(const LaunchConfiguration& launch) {
  std::uint32_t thread = threadIdx.x;
  asm volatile("" : "+r"(thread));
  return thread / (launch.warps_per_robot * lanes);
}

// Of all threads of the block, or of those of all parts of a robot.
template <class Memory>
__device__ void robot_barrier() {
#if __CUDA_ARCH__ >= 900
  if constexpr (Memory::in_parts) {
    asm volatile("barrier.cluster.arrive.release.aligned;\nbarrier.cluster.wait.acquire.aligned;" ::: "memory");
    return;
  }
#endif
  __syncthreads();
}
// The same, or of the threads of each robot of the block if these are apart. In kernels with contacts they never are:
// it would take registers from their steps.
template <class Memory, bool has_contacts>
__device__ void robot_barrier(const LaunchConfiguration& launch) {
  if (!has_contacts && !Memory::in_parts && __builtin_expect(launch.apart, 0))
    wait_for_robot(number_in_block(launch), launch.warps_per_robot);
  else
    robot_barrier<Memory>();
}

// The latter between springs and masses: before it, parts write to each other's memory only to report a failure, which
// they wait for themselves, and to add contacts. Without contacts it need not wait for device memory.
template <class Memory, bool has_contacts>
__device__ void barrier_after_springs(const LaunchConfiguration& launch) {
#if __CUDA_ARCH__ >= 900
  if constexpr (Memory::in_parts && !Memory::finds_contacts) {
    __syncthreads();
    asm volatile("barrier.cluster.arrive.relaxed.aligned;\nbarrier.cluster.wait.acquire.aligned;" ::: "memory");
    return;
  }
#endif
  robot_barrier<Memory, has_contacts>(launch);
}

// The phases of a step. A phase is skipped if the robot failed in an earlier one, or in an earlier step.
enum Phase : std::uint32_t { phase_environment = 0, phase_prediction = 1, phase_springs = 2, phase_end = 3 };

// When a robot explodes during a launch. Its warps share one Failure in shared memory; the earliest one counts.
struct Failure {
  static constexpr std::uint32_t never = 0xffffffffu;

  std::uint32_t when;      // 1 + 4 step + phase; 0 = before the launch; or never
  std::uint32_t bad_mass;  // the lowest one, or never

  __device__ bool before(std::uint32_t step, Phase phase) const {
    return *static_cast<const volatile std::uint32_t*>(&when) <= 4 * step + phase;
  }
  // To all parts of the robot, if there are several.
  template <class Memory>
  __device__ void report(const LaunchConfiguration& launch, std::uint32_t step, Phase phase, std::uint32_t mass) {
    if constexpr (Memory::in_parts) {
      for (std::uint32_t part = 0; part < launch.parts; ++part) {
        Memory::lower_there(Memory::of_part(shared_address(&when), part), 1 + 4 * step + phase);
        Memory::lower_there(Memory::of_part(shared_address(&bad_mass), part), mass);
      }
      __threadfence();
    } else {
      atomicMin(&when, 1 + 4 * step + phase);
      atomicMin(&bad_mass, mass);
    }
  }
  __device__ bool happened() const { return when != never; }
  __device__ std::uint32_t step() const { return (when - 1) / 4; }
};

// A thread's part in its robot. The tables are addresses in shared memory.
template <class Memory>
struct ThreadContext {
  std::uint32_t robot, warp, lane;
  typename Memory::Address masses;  // of the robot's slot 0
  std::uint32_t material_table;     // this lane's copy
  std::uint32_t lengths;
  std::uint32_t relaxation_times;  // by material, if the robot is viscous
};

// The parts of shared memory that belong to a thread's robot.
template <Solver solver, class Memory>
struct BlockContext {
  std::uint32_t first_robot;
  bool has_robot;  // the last block may have more room than robots
  SpringParameters<solver>* material_table;
  float* lengths;
  float* relaxation_times;  // [table_chunks][32], if launch.viscous
  Failure* failure;
  std::uint32_t number;         // of the robot in its block
  std::uint32_t* next_thought;  // [robot of the block], the step of the launch before which it thinks
  std::uint32_t* moving;        // [chunk] of the table, see MaterialTable
  std::uint32_t brain;          // where the memory of the robot's brain begins in shared memory, if it is there
  ThreadContext<Memory> thread;

  // `fields` = of a tile in working memory.
  __device__ BlockContext(const StepArguments& arguments, std::uint32_t fields, std::uint32_t thread_index) {
    const LaunchConfiguration& launch = arguments.launch;
    const BatchView& batch = arguments.batch;
    const std::uint32_t block_warp = thread_index / lanes;
    number = block_warp / launch.warps_per_robot;
    const std::uint32_t table_copies = 1u << launch.table_copy_bits;
    const BlockLayout layout = block_layout(launch, batch.tile_stride, fields);
    const std::uint32_t working_bytes = batch.tile_stride * fields * field_bytes;
    first_robot = Memory::in_parts ? blockIdx.x / batch.parts.per_robot : blockIdx.x * launch.robots_per_block;
    has_robot = first_robot + number < batch.robot_count;
    thread.robot = min(first_robot + number, batch.robot_count - 1);
    thread.warp = block_warp % launch.warps_per_robot;
    thread.lane = thread_index % lanes;

    if constexpr (Memory::on_chip)
      thread.masses = shared_address(shared_memory) + layout.brains + number * working_bytes;
    else
      thread.masses = batch.workspace + std::size_t{thread.robot} * batch.workspace_stride;
    const std::uint32_t number_of_table = launch.shared_table ? 0 : number;
    material_table = reinterpret_cast<SpringParameters<solver>*>(shared_memory) +
                     number_of_table * table_copies * launch.table_chunks * lanes;
    thread.material_table = shared_address(material_table + thread.lane % table_copies);
    failure = reinterpret_cast<Failure*>(shared_memory + layout.tables) + number;
    next_thought = reinterpret_cast<std::uint32_t*>(shared_memory + layout.tables) + 2 * launch.robots_per_block;
    moving = next_thought + launch.robots_per_block + number_of_table * max_chunks;
    brain = layout.contacts + number * launch.brain.total();
    lengths = reinterpret_cast<float*>(shared_memory + layout.failures) + number * max_lengths;
    thread.lengths = shared_address(lengths);
    relaxation_times =
        reinterpret_cast<float*>(shared_memory + layout.lengths) + number_of_table * launch.table_chunks * lanes;
    thread.relaxation_times = shared_address(relaxation_times);
  }
};

}  // namespace mercury::cuda
