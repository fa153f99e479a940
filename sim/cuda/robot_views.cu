// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/robot_views.h"

#include "sim/cuda/stream.h"

namespace mercury::cuda {
namespace {

constexpr unsigned threads = 128, warps = threads / lanes;

__device__ double sum_of_warp(double value) {
  for (unsigned distance = lanes / 2; distance > 0; distance /= 2)
    value += __shfl_down_sync(0xffffffffu, value, distance);
  return value;
}

// The vectors of one robot that begin at this field: per mass, and their mean by mass. All threads of the block call
// this.
__device__ void publish_field(const RobotView& robot, Field first_field, float* per_mass, float* mean) {
  __shared__ double sums[3][warps];
  double sum[3] = {};
  for (std::uint32_t slot = threadIdx.x; slot < robot.masses; slot += threads) {
    const float* from = robot.state + offset_of_slot(slot, state_fields) + first_field * lanes;
    const std::size_t to = 3 * (robot.first_mass + robot.order[slot]);
    const double mass = robot.point_masses ? static_cast<double>(robot.point_masses[slot]) : 1.0;
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
      const float value = from[axis * lanes];
      if (per_mass) per_mass[to + axis] = value;
      sum[axis] += mass * static_cast<double>(value);
    }
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

}  // namespace

void publish_states(const RobotView* robots, std::size_t count, const PublishedArrays& arrays, cudaStream_t stream) {
  if (count == 0 || arrays.empty()) return;
  publish_kernel<<<static_cast<unsigned>(count), threads, 0, stream>>>(robots, arrays);
  check(cudaGetLastError(), "writing shared arrays");
}

void put_masked_at_rest(const RobotView* robots, std::size_t count, const float* start, const std::uint8_t* mask,
                        cudaStream_t stream) {
  if (count == 0) return;
  rest_kernel<<<static_cast<unsigned>(count), threads, 0, stream>>>(robots, start, mask);
  check(cudaGetLastError(), "putting robots at rest");
}

}  // namespace mercury::cuda
