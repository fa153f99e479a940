#include "sim/cuda/memory.h"
#include "sim/cuda/telemetry.h"

namespace mercury::cuda {
namespace {

constexpr std::uint32_t threads = 256;

struct Share {
  double sums[8];  // as the first members of DeviceTelemetry
  float strain;
};

__device__ void add_masses(const float* state, std::uint32_t masses, Share& share) {
  for (std::uint32_t mass = threadIdx.x; mass < masses; mass += threads) {
    const float* at = state + (mass / lanes * state_rows) * lanes + mass % lanes;
    double squared = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double v = static_cast<double>(at[(3 + axis) * lanes]);
      share.sums[axis] += static_cast<double>(at[axis * lanes]);
      share.sums[3 + axis] += v;
      squared += v * v;
    }
    share.sums[6] += 0.5 * squared;
  }
}

// What the springs of a robot are measured with, in shared memory: each mass and material is looked at many times.
struct SharedTables {
  float factor[max_materials], stiffness[max_materials];
  float lengths[max_lengths];
};

__device__ void fill(SharedTables& tables, const BatchView& batch, std::uint32_t robot, std::int64_t steps_since_base,
                     float stiffness_scale) {
  for (std::uint32_t id = threadIdx.x; id < max_materials; id += threads) {
    const std::size_t place = std::size_t{robot} * max_materials + id;
    const Material material = batch.materials[place];
    tables.factor[id] = muscle_factor(material.amplitude, phase_at(batch.phases[place], steps_since_base));
    tables.stiffness[id] = stiffness_scale * material.stiffness;
  }
  if (batch.record_words == 1)
    for (std::uint32_t i = threadIdx.x; i < max_lengths; i += threads)
      tables.lengths[i] = batch.lengths[std::size_t{robot} * max_lengths + i];
}

// Positions as they stand in memory, [group][rows][32], or copied to shared memory with three rows.
struct Positions {
  const float* at;
  std::uint32_t rows;
  __device__ Vec3 operator[](std::uint32_t mass) const {
    const float* x = at + (mass / lanes * rows) * lanes + mass % lanes;
    return {x[0], x[lanes], x[2 * lanes]};
  }
};

struct Springs {
  const std::uint32_t* records;
  const std::uint32_t* row_start;
  std::uint32_t record_words, groups, rows_placed;

  __device__ std::uint32_t partner(std::uint32_t key) const {
    const std::uint32_t place = key >> 16;
    return rows_placed == 0 ? place : place / (rows_placed * lanes) * lanes + place % lanes;
  }
};

__device__ void add_springs(const Positions& positions, const Springs& springs, const SharedTables& tables, Share& share) {
  const std::uint32_t lane = threadIdx.x % lanes;
  for (std::uint32_t group = threadIdx.x / lanes; group < springs.groups; group += threads / lanes) {
    const Vec3 own = positions[group * lanes + lane];
    const std::uint32_t last = springs.row_start[group + 1];
#pragma unroll 4
    for (std::uint32_t row = springs.row_start[group]; row < last; ++row) {
      const std::uint32_t* record = springs.records + (std::size_t{row} * lanes + lane) * springs.record_words;
      const std::uint32_t key = *record, id = key & 0xff;
      if (id == air) continue;
      const float rest_length = springs.record_words == 1 ? tables.lengths[key >> 8 & 0xff] : __uint_as_float(record[1]);
      const Vec3 d = positions[springs.partner(key)] - own;
      const float distance = sqrtf(dot(d, d));
      const auto stretch = static_cast<double>(distance - rest_length * tables.factor[id]);
      share.sums[7] += 0.5 * static_cast<double>(tables.stiffness[id]) * stretch * stretch;
      share.strain = fmaxf(share.strain, fabsf(distance - rest_length) / rest_length);
    }
  }
}

__device__ void reduce(Share (&shares)[threads / lanes], Share share, DeviceTelemetry& out, const DeviceStatus& status) {
  for (std::uint32_t half = lanes / 2; half > 0; half /= 2) {
    for (double& sum : share.sums) sum += __shfl_down_sync(0xffffffffu, sum, half);
    share.strain = fmaxf(share.strain, __shfl_down_sync(0xffffffffu, share.strain, half));
  }
  if (threadIdx.x % lanes == 0) shares[threadIdx.x / lanes] = share;
  __syncthreads();
  if (threadIdx.x > 0) return;
  for (std::uint32_t warp = 1; warp < threads / lanes; ++warp) {
    for (int k = 0; k < 8; ++k) share.sums[k] += shares[warp].sums[k];
    share.strain = fmaxf(share.strain, shares[warp].strain);
  }
  const double* sums = share.sums;
  out = {{sums[0], sums[1], sums[2]}, {sums[3], sums[4], sums[5]}, sums[6], sums[7], share.strain, status.bad_mass,
         status.exploded_step};
}

// `on_chip`: the robots' positions fit into shared memory.
__global__ void telemetry_kernel(BatchView batch, Clock clock, float stiffness_scale, std::uint32_t rows_placed, bool on_chip,
                                 DeviceTelemetry* out) {
  extern __shared__ float copied[];
  __shared__ SharedTables tables;
  __shared__ Share shares[threads / lanes];
  const std::uint32_t robot = blockIdx.x;
  const RobotRecord& record = batch.robots[robot];
  const float* state = batch.state + std::size_t{robot} * batch.group_stride * state_rows * lanes;
  fill(tables, batch, robot, clock.step - clock.base_step, stiffness_scale);
  if (on_chip)
    for (std::uint32_t i = threadIdx.x; i < record.groups * 3 * lanes; i += threads)
      copied[i] = state[(i / (3 * lanes) * state_rows) * lanes + i % (3 * lanes)];
  Share share{};
  add_masses(state, record.masses, share);
  __syncthreads();
  const Springs springs{batch.springs + std::size_t{robot} * batch.row_stride * lanes * batch.record_words,
                        batch.row_start + std::size_t{robot} * (batch.group_stride + 1), batch.record_words, record.groups,
                        rows_placed};
  if (on_chip)
    add_springs({copied, 3}, springs, tables, share);
  else
    add_springs({state, state_rows}, springs, tables, share);
  reduce(shares, share, out[robot], batch.statuses[robot]);
}

}  // namespace

void launch_telemetry(const BatchView& batch, const Clock& clock, float stiffness_scale, std::uint32_t rows,
                      DeviceTelemetry* out) {
  const std::size_t bytes = std::size_t{batch.group_stride} * 3 * row_bytes;
  constexpr std::size_t most_bytes = 40960;  // beside the tables, within what every device grants without being asked
  const bool on_chip = bytes <= most_bytes;
  telemetry_kernel<<<batch.robot_count, threads, on_chip ? bytes : 0>>>(batch, clock, stiffness_scale, rows, on_chip, out);
  check(cudaGetLastError(), "starting the telemetry kernel");
}

}  // namespace mercury::cuda
