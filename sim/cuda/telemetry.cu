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

__device__ Vec3 position(const float* state, std::uint32_t mass) {
  const float* at = state + (mass / lanes * state_rows) * lanes + mass % lanes;
  return {at[0], at[lanes], at[2 * lanes]};
}

struct Springs {
  const std::uint32_t* records;
  const float* lengths;
  const std::uint32_t* row_start;
  std::uint32_t record_words, groups, rows_placed;

  __device__ std::uint32_t partner(std::uint32_t key) const {
    const std::uint32_t place = key >> 16;
    return rows_placed == 0 ? place : place / (rows_placed * lanes) * lanes + place % lanes;
  }
  __device__ float rest_length(const std::uint32_t* record) const {
    return record_words == 1 ? lengths[*record >> 8 & 0xff] : __uint_as_float(record[1]);
  }
};

__device__ void add_springs(const float* state, const Springs& springs, const Material* materials,
                            const MusclePhase* phases, std::int64_t steps_since_base, float stiffness_scale, Share& share) {
  const std::uint32_t lane = threadIdx.x % lanes;
  for (std::uint32_t group = threadIdx.x / lanes; group < springs.groups; group += threads / lanes) {
    const Vec3 own = position(state, group * lanes + lane);
    for (std::uint32_t row = springs.row_start[group]; row < springs.row_start[group + 1]; ++row) {
      const std::uint32_t* record = springs.records + (std::size_t{row} * lanes + lane) * springs.record_words;
      const std::uint32_t id = *record & 0xff;
      if (id == air) continue;
      const float rest_length = springs.rest_length(record);
      const Vec3 d = position(state, springs.partner(*record)) - own;
      const float distance = sqrtf(dot(d, d));
      const float factor = muscle_factor(materials[id].amplitude, phase_at(phases[id], steps_since_base));
      const auto stretch = static_cast<double>(distance - rest_length * factor);
      share.sums[7] += 0.5 * static_cast<double>(stiffness_scale * materials[id].stiffness) * stretch * stretch;
      share.strain = fmaxf(share.strain, fabsf(distance - rest_length) / rest_length);
    }
  }
}

__global__ void telemetry_kernel(BatchView batch, Clock clock, float stiffness_scale, std::uint32_t rows, DeviceTelemetry* out) {
  __shared__ Share shares[threads];
  const std::uint32_t robot = blockIdx.x;
  const RobotRecord& record = batch.robots[robot];
  const float* state = batch.state + std::size_t{robot} * batch.group_stride * state_rows * lanes;
  Share share{};
  add_masses(state, record.masses, share);
  const Springs springs{batch.springs + std::size_t{robot} * batch.row_stride * lanes * batch.record_words,
                        batch.lengths + std::size_t{robot} * max_lengths,
                        batch.row_start + std::size_t{robot} * (batch.group_stride + 1), batch.record_words, record.groups, rows};
  add_springs(state, springs, batch.materials + std::size_t{robot} * max_materials,
              batch.phases + std::size_t{robot} * max_materials, clock.step - clock.base_step, stiffness_scale, share);
  shares[threadIdx.x] = share;
  for (std::uint32_t half = threads / 2; half > 0; half /= 2) {
    __syncthreads();
    if (threadIdx.x >= half) continue;
    for (int k = 0; k < 8; ++k) shares[threadIdx.x].sums[k] += shares[threadIdx.x + half].sums[k];
    shares[threadIdx.x].strain = fmaxf(shares[threadIdx.x].strain, shares[threadIdx.x + half].strain);
  }
  if (threadIdx.x > 0) return;
  const double* sums = shares[0].sums;
  const DeviceStatus status = batch.statuses[robot];
  out[robot] = {{sums[0], sums[1], sums[2]}, {sums[3], sums[4], sums[5]}, sums[6], sums[7], shares[0].strain, status.bad_mass, status.exploded_step};
}

}  // namespace

void launch_telemetry(const BatchView& batch, const Clock& clock, float stiffness_scale, std::uint32_t rows,
                      DeviceTelemetry* out) {
  telemetry_kernel<<<batch.robot_count, threads>>>(batch, clock, stiffness_scale, rows, out);
  check(cudaGetLastError(), "starting the telemetry kernel");
}

}  // namespace mercury::cuda
