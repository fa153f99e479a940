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

// Over the lanes of a warp. Turing has no instruction for it.
__device__ inline std::uint32_t maximum_of_warp(std::uint32_t value) {
#if __CUDA_ARCH__ >= 800
  return __reduce_max_sync(0xffffffffu, value);
#else
  for (int distance = lanes / 2; distance > 0; distance /= 2)
    value = max(value, __shfl_xor_sync(0xffffffffu, value, distance));
  return value;
#endif
}
__device__ inline std::uint32_t sum_of_warp(std::uint32_t value) {
#if __CUDA_ARCH__ >= 800
  return __reduce_add_sync(0xffffffffu, value);
#else
  for (int distance = lanes / 2; distance > 0; distance /= 2) value += __shfl_xor_sync(0xffffffffu, value, distance);
  return value;
#endif
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
  return (thread / lanes * launch.inverse_warps) >> 16;
}

// A barrier in shared memory at which warps arrive, and which others, or the same ones later, wait for. Its phases are
// numbered from 0. Nobody may arrive in a phase before all have waited for the last but one.
class SplitBarrier {
 public:
  static constexpr std::uint32_t bytes = 8;
  static constexpr bool exists =
#if __CUDA_ARCH__ >= 800
      true;
#else
      false;
#endif
  __device__ explicit SplitBarrier(std::uint32_t address) : address_(address) {}

  // By one thread, before a barrier of all. `count` = calls of arrive() that end a phase.
  __device__ void begin(std::uint32_t count) const {
#if __CUDA_ARCH__ >= 800
    asm volatile("mbarrier.init.shared.b64 [%0], %1;" ::"r"(address_), "r"(count) : "memory");
#endif
  }
  // By one thread, for what came before in those that it has waited for.
  __device__ void arrive() const {
#if __CUDA_ARCH__ >= 800
    asm volatile("{\n.reg .b64 state;\nmbarrier.arrive.shared.b64 state, [%0];\n}" ::"r"(address_) : "memory");
#endif
  }
  // The same, and waits until the phase ends.
  __device__ void arrive_and_wait() const {
#if __CUDA_ARCH__ >= 900
    asm volatile(
        "{\n.reg .b64 state;\n.reg .pred ended;\nmbarrier.arrive.shared.b64 state, [%0];\n"
        "again:\nmbarrier.try_wait.shared.b64 ended, [%0], state;\n@!ended bra again;\n}" ::"r"(address_)
        : "memory");
#elif __CUDA_ARCH__ >= 800
    asm volatile(
        "{\n.reg .b64 state;\n.reg .pred ended;\nmbarrier.arrive.shared.b64 state, [%0];\n"
        "again:\nmbarrier.test_wait.shared.b64 ended, [%0], state;\n@!ended bra again;\n}" ::"r"(address_)
        : "memory");
#endif
  }
  // Phase -1 has ended from the start.
  __device__ void wait_for(std::uint32_t phase) const {
#if __CUDA_ARCH__ >= 900
    asm volatile(
        "{\n.reg .pred ended;\nagain:\nmbarrier.try_wait.parity.shared.b64 ended, [%0], %1;\n@!ended bra again;\n}" ::
            "r"(address_),
        "r"(phase & 1)
        : "memory");
#elif __CUDA_ARCH__ >= 800
    asm volatile(
        "{\n.reg .pred ended;\nagain:\nmbarrier.test_wait.parity.shared.b64 ended, [%0], %1;\n@!ended bra again;\n}" ::
            "r"(address_),
        "r"(phase & 1)
        : "memory");
#endif
  }

 private:
  std::uint32_t address_;
};

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
  if (!has_contacts && !Memory::in_parts && launch.apart)
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
  __device__ bool before_launch() const { return when == 0; }
  __device__ std::uint32_t step() const { return (when - 1) / 4; }
};

// What the threads of a robot share in their block besides its masses.
struct RobotRecord {
  Failure failure;
  std::uint32_t* pairs;      // that may touch (contacts.cuh), in device memory
  std::uint32_t pair_count;  // of which ContactPass::most_pairs() fit
  std::uint32_t votes[2];    // the steps before which a part of the robot last voted, plus 1
  std::uint64_t thinking;    // a SplitBarrier of the robot's warps, for its brain
};
static_assert(sizeof(RobotRecord) == robot_record_bytes);

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
  std::uint32_t table_barriers;  // see MaterialTable
  float* lengths;
  float* relaxation_times;  // [table_chunks][32], if launch.viscous
  RobotRecord* record;
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
    table_barriers = shared_address(shared_memory) + number_of_table * table_barrier_bytes;
    material_table = reinterpret_cast<SpringParameters<solver>*>(shared_memory + layout.barriers) +
                     number_of_table * table_copies * launch.table_chunks * lanes;
    thread.material_table = shared_address(material_table + thread.lane % table_copies);
    record = reinterpret_cast<RobotRecord*>(shared_memory + layout.tables) + number;
    next_thought =
        reinterpret_cast<std::uint32_t*>(shared_memory + layout.tables + launch.robots_per_block * robot_record_bytes);
    moving = next_thought + launch.robots_per_block + number_of_table * max_chunks;
    brain = layout.contacts + number * launch.brain.total();
    lengths = reinterpret_cast<float*>(shared_memory + layout.records) + number * max_lengths;
    thread.lengths = shared_address(lengths);
    relaxation_times =
        reinterpret_cast<float*>(shared_memory + layout.lengths) + number_of_table * launch.table_chunks * lanes;
    thread.relaxation_times = shared_address(relaxation_times);
  }
};

}  // namespace mercury::cuda
