// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/kernels.h"

#include <algorithm>

#include "sim/cuda/early_start.cuh"
#include "sim/physics/actuation.h"

namespace mercury::cuda {
namespace {

constexpr unsigned threads = 128, warps = threads / lanes;  // of kernels with a block per robot
constexpr unsigned many_threads = 256;                      // of the others

unsigned blocks_for(std::size_t count) { return static_cast<unsigned>((count + many_threads - 1) / many_threads); }

__device__ double sum_of_warp(double value) {
  for (unsigned distance = lanes / 2; distance > 0; distance /= 2)
    value += __shfl_down_sync(0xffffffffu, value, distance);
  return value;
}

__device__ void prefetch(const void* from) { asm volatile("prefetch.global.L1 [%0];" ::"l"(from)); }

// The vectors of one robot that begin at this field: per mass, and their mean by mass. All threads of the block call
// this.
__device__ void publish_field(const RobotView& robot, Field first_field, float* per_mass, float* mean) {
  // Masses stand in the order of slots. Brought into their own on the chip, neighbors are written together.
  constexpr std::uint32_t most_staged = 1024;
  __shared__ float staged[3 * most_staged];
  __shared__ double sums[3][warps];
  const bool stages = per_mass && robot.masses <= most_staged;
  float* const to_all = stages ? staged : per_mass + 3 * robot.first_mass;
  double sum[3] = {};
  for (std::uint32_t slot = threadIdx.x; slot < robot.masses; slot += threads) {
    const float* from = robot.state + offset_of_slot(slot, state_fields) + first_field * lanes;
    const std::uint32_t to = 3u * robot.order[slot];
    const double mass = robot.point_masses ? static_cast<double>(robot.point_masses[slot]) : 1.0;
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
      const float value = from[axis * lanes];
      if (per_mass) to_all[to + axis] = value;
      sum[axis] += mass * static_cast<double>(value);
    }
  }
  if (stages) {
    __syncthreads();
    float* const out = per_mass + 3 * robot.first_mass;
    for (std::uint32_t i = threadIdx.x; i < 3 * robot.masses; i += threads) out[i] = staged[i];
    __syncthreads();
  }
  if (!mean) return;
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    const double of_warp = sum_of_warp(sum[axis]);
    if (threadIdx.x % lanes == 0) sums[axis][threadIdx.x / lanes] = of_warp;
  }
  __syncthreads();
  if (threadIdx.x < 3) {
    double total = 0;
    for (const double of_warp : sums[threadIdx.x]) total += of_warp;
    mean[threadIdx.x] = static_cast<float>(total * (1.0 / robot.mass));
  }
  __syncthreads();
}

// One block per robot.
__global__ void __launch_bounds__(threads) publish_kernel(const RobotView* robots, PublishedArrays arrays) {
  const std::size_t i = blockIdx.x;
  const RobotView robot = robots[i];
  for (std::uint32_t slot = threadIdx.x; slot < robot.masses; slot += threads) prefetch(robot.order + slot);
  wait_for_kernel_before();
  const auto of_robot = [&](float* centers) { return centers ? centers + 3 * i : nullptr; };
  if (arrays.positions || arrays.centers) publish_field(robot, field_x, arrays.positions, of_robot(arrays.centers));
  if (arrays.velocities || arrays.center_velocities)
    publish_field(robot, field_v, arrays.velocities, of_robot(arrays.center_velocities));
  if (arrays.exploded && threadIdx.x == 0) arrays.exploded[i] = robot.status->exploded_step >= 0;
}

// One block per robot.
__global__ void __launch_bounds__(threads)
    rest_kernel(const RobotView* robots, const float* start, const std::uint8_t* mask) {
  if (!mask[blockIdx.x]) return;
  const RobotView robot = robots[blockIdx.x];
  for (std::uint32_t slot = threadIdx.x; slot < robot.masses; slot += threads) {
    const float* from = start + 6 * (robot.first_mass + robot.order[slot]);
    float* const to = robot.state + offset_of_slot(slot, state_fields);
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
      to[(field_x + axis) * lanes] = from[axis];
      to[(field_v + axis) * lanes] = from[3 + axis];
    }
  }
  if (threadIdx.x == 0) *robot.status = {-1, no_mass};
}

__global__ void readdress_kernel(std::uint32_t* records, std::size_t count, std::uint32_t record_words,
                                 std::uint32_t old_fields, std::uint32_t new_fields) {
  for (std::size_t i = blockIdx.x * std::size_t{blockDim.x} + threadIdx.x; i < count;
       i += std::size_t{gridDim.x} * blockDim.x) {
    std::uint32_t& key = records[i * record_words];
    const std::uint32_t slot = slot_at_offset(key >> 16, old_fields);
    key = offset_of_slot(slot, new_fields) << 16 | (key & 0xffff);
  }
}

__global__ void readdress_corners_kernel(std::uint16_t* corners, std::size_t count, std::uint32_t old_fields,
                                         std::uint32_t new_fields) {
  for (std::size_t i = blockIdx.x * std::size_t{blockDim.x} + threadIdx.x; i < count;
       i += std::size_t{gridDim.x} * blockDim.x)
    corners[i] = static_cast<std::uint16_t>(offset_of_slot(slot_at_offset(corners[i], old_fields), new_fields));
}

// One block per part.
__global__ void points_kernel(BatchView batch, const PointProperties* from, PointProperties* to) {
  const std::size_t slots = std::size_t{batch.tile_stride} * lanes, first = blockIdx.x * slots;
  const std::size_t robot = blockIdx.x / batch.parts.per_robot * std::size_t{batch.parts.robot_tile_stride} * lanes;
  for (std::size_t slot = threadIdx.x; slot < slots; slot += blockDim.x)
    to[first + slot] = from[robot + batch.parts.slots[first + slot]];
}

// One block per move.
__global__ void move_kernel(std::uint32_t* words, std::size_t words_per_chunk, const uint2* moves) {
  const uint2 move = moves[blockIdx.x];
  const std::uint32_t* from = words + move.x * words_per_chunk;
  std::uint32_t* to = words + move.y * words_per_chunk;
  for (std::size_t i = threadIdx.x; i < words_per_chunk; i += blockDim.x) to[i] = from[i];
}

__global__ void phase_kernel(const Material* materials, MusclePhase* phases, MuscleSwing* swings, std::size_t count,
                             Clock clock) {
  const std::size_t i = blockIdx.x * std::size_t{blockDim.x} + threadIdx.x;
  if (i >= count) return;
  phases[i] = muscle_phase(materials[i], clock);
  swings[i] = MuscleSwing::of(materials[i]);
}

// One block per robot.
__global__ void rename_kernel(std::uint32_t* records, std::size_t records_per_robot, std::uint32_t record_words,
                              const MaterialId* ids) {
  const std::size_t robot = blockIdx.x;
  for (std::size_t i = threadIdx.x; i < records_per_robot; i += blockDim.x) {
    std::uint32_t& key = records[(robot * records_per_robot + i) * record_words];
    key = (key & ~0xffu) | ids[robot * max_materials + (key & 0xff)];
  }
}

__global__ void actuate_kernel(const DrivenMaterial* driven, std::size_t count, ActuationSources sources, Clock clock,
                               bool before_step) {
  wait_for_kernel_before();
  let_next_kernel_start();
  const std::size_t i = blockIdx.x * std::size_t{blockDim.x} + threadIdx.x;
  if (i >= count) return;
  const DrivenMaterial to = driven[i];
  const float drive = sources.drive[to.setting];
  const ActuatorSetting setting{sources.amplitude[to.setting], sources.frequency[to.setting], sources.phase[to.setting],
                                drive, is_driven(sources.driven[to.setting], drive)};
  const Material now = actuated(*to.own, setting);
  *to.now = now;
  *to.phase = muscle_phase(now, clock);
  *to.swing = MuscleSwing::of(now);
  // Several threads may write the same step.
  if (has_failed(setting) && before_step && to.status->exploded_step < 0) to.status->exploded_step = clock.step;
}

}  // namespace

void publish_states(const RobotView* robots, std::size_t count, const PublishedArrays& arrays, cudaStream_t stream) {
  if (count == 0 || arrays.empty()) return;
  start_early(publish_kernel, static_cast<unsigned>(count), threads, stream, robots, arrays);
}

void put_masked_at_rest(const RobotView* robots, std::size_t count, const float* start, const std::uint8_t* mask,
                        cudaStream_t stream) {
  if (count == 0) return;
  rest_kernel<<<static_cast<unsigned>(count), threads, 0, stream>>>(robots, start, mask);
  check(cudaGetLastError(), "putting robots at rest");
}

void readdress_partners(std::uint32_t* records, std::size_t count, std::uint32_t record_words, std::uint32_t old_fields,
                        std::uint32_t new_fields, cudaStream_t stream) {
  const unsigned blocks = std::min(blocks_for(count), 65536u);
  readdress_kernel<<<blocks, many_threads, 0, stream>>>(records, count, record_words, old_fields, new_fields);
  check(cudaGetLastError(), "addressing the partners of springs");
}

void readdress_corners(std::span<FacePair> pairs, std::uint32_t old_fields, std::uint32_t new_fields,
                       cudaStream_t stream) {
  const std::size_t count = 4 * pairs.size();
  const unsigned blocks = std::min(blocks_for(count), 65536u);
  readdress_corners_kernel<<<blocks, many_threads, 0, stream>>>(&pairs.data()->a, count, old_fields, new_fields);
  check(cudaGetLastError(), "addressing the corners of faces");
}

void copy_points_to_parts(const BatchView& parts, const PointProperties* from, PointProperties* to,
                          cudaStream_t stream) {
  points_kernel<<<parts.robot_count * parts.parts.per_robot, many_threads, 0, stream>>>(parts, from, to);
  check(cudaGetLastError(), "copying the properties of masses");
}

void move_chunks(std::uint32_t* words, std::size_t words_per_chunk, const uint2* moves, std::size_t count,
                 cudaStream_t stream) {
  move_kernel<<<static_cast<unsigned>(count), many_threads, 0, stream>>>(words, words_per_chunk, moves);
  check(cudaGetLastError(), "moving robots");
}

void compute_phases(const Material* materials, MusclePhase* phases, MuscleSwing* swings, std::size_t count,
                    const Clock& clock, cudaStream_t stream) {
  phase_kernel<<<blocks_for(count), many_threads, 0, stream>>>(materials, phases, swings, count, clock);
  check(cudaGetLastError(), "computing muscle phases");
}

void rename_materials(std::uint32_t* records, std::size_t robots, std::size_t records_per_robot,
                      std::uint32_t record_words, const MaterialId* ids, cudaStream_t stream) {
  rename_kernel<<<static_cast<unsigned>(robots), many_threads, 0, stream>>>(records, records_per_robot, record_words,
                                                                            ids);
  check(cudaGetLastError(), "renaming the materials of springs");
}

void actuate(const DrivenMaterial* driven, std::size_t count, const ActuationSources& sources, const Clock& clock,
             bool before_step, cudaStream_t stream) {
  start_early(actuate_kernel, blocks_for(count), many_threads, stream, driven, count, sources, clock, before_step);
}

}  // namespace mercury::cuda
