#include "sim/cuda/memory.h"
#include "sim/cuda/telemetry.h"
#include "sim/springs.h"

namespace mercury::cuda {
namespace {

constexpr std::uint32_t threads = 256;

struct Share {
  double sums[8];  // as in DeviceTelemetry
  float strain;
};

// `places` of which those behind the last mass are zero. Copies the positions, three rows a group, unless there is no room
// for them.
__device__ void add_masses(const float* state, std::uint32_t places, float* copied, Share& share) {
#pragma unroll 3
  for (std::uint32_t mass = threadIdx.x; mass < places; mass += threads) {
    const std::uint32_t group = mass / lanes, lane = mass % lanes;
    const float* at = state + group * state_rows * lanes + lane;
    float x[3], v[3];
    for (int axis = 0; axis < 3; ++axis) {
      x[axis] = at[axis * lanes];
      v[axis] = at[(3 + axis) * lanes];
    }
    for (int axis = 0; axis < 3; ++axis) {
      if (copied) copied[(group * 3 + axis) * lanes + lane] = x[axis];
      share.sums[axis] += static_cast<double>(x[axis]);
      share.sums[3 + axis] += static_cast<double>(v[axis]);
    }
    share.sums[6] += 0.5 * static_cast<double>(multiply_add(v[0], v[0], multiply_add(v[1], v[1], v[2] * v[2])));
  }
}

// What the springs of a robot are measured with, in shared memory. Neighbouring lanes have their own copies of the
// laws, for lanes look up different materials at once.
struct SharedTables {
  static constexpr std::uint32_t copies = 4;
  float2 laws[max_materials * copies];  // L / L0, and half the stiffness
  float2 lengths[max_lengths];          // L0 and 1 / L0
};

__device__ void fill(SharedTables& tables, const BatchView& batch, std::uint32_t robot, std::int64_t steps_since_base,
                     float stiffness_scale) {
  for (std::uint32_t id = threadIdx.x; id < max_materials; id += threads) {
    const std::size_t place = std::size_t{robot} * max_materials + id;
    const Material material = batch.materials[place];
    const float factor = muscle_factor(material.amplitude, phase_at(batch.phases[place], steps_since_base));
    const float2 law{factor, id == air ? 0.0f : 0.5f * stiffness_scale * material.stiffness};
    for (std::uint32_t copy = 0; copy < SharedTables::copies; ++copy) tables.laws[id * SharedTables::copies + copy] = law;
  }
  if (batch.record_words == 1)
    for (std::uint32_t i = threadIdx.x; i < max_lengths; i += threads) {
      const float length = batch.lengths[std::size_t{robot} * max_lengths + i];
      tables.lengths[i] = {length, 1 / length};
    }
}

// Positions as they stand in memory, [group][rows][32], or copied to shared memory with three rows.
template <int rows>
struct Positions {
  const float* at;
  __device__ Vec3 operator[](std::uint32_t mass) const { return load(mass / lanes * rows * lanes + mass % lanes); }
  // Of the mass that a record names by its place among groups of so many rows; 0 = by its number.
  template <int rows_placed>
  __device__ Vec3 at_place(std::uint32_t place) const {
    if constexpr (rows_placed == 0)
      return (*this)[place];
    else
      return load(place - place / (rows_placed * lanes) * ((rows_placed - rows) * lanes));
  }
  __device__ Vec3 load(std::uint32_t offset) const { return {at[offset], at[offset + lanes], at[offset + 2 * lanes]}; }
};

template <int record_words>
struct Springs {
  using Record = std::conditional_t<record_words == 1, uint1, uint2>;
  const Record* records;
  const std::uint32_t* row_start;
  std::uint32_t groups;
};

// `count` rows at once, so that their loads are under way together.
template <int rows_placed, int rows, int record_words, int count>
__device__ void add_rows(const Positions<rows>& positions, const typename Springs<record_words>::Record (&records)[count], Vec3 own,
                         const SharedTables& tables, Share& share) {
  const std::uint32_t copy = threadIdx.x % SharedTables::copies;
  float energy = 0;
#pragma unroll
  for (int i = 0; i < count; ++i) {
    const std::uint32_t key = records[i].x, id = key & 0xff;
    float2 length;
    if constexpr (record_words == 1) {
      length = tables.lengths[key >> 8 & 0xff];
    } else {
      length.x = __uint_as_float(records[i].y);
      length.y = 1 / length.x;
    }
    const float2 law = tables.laws[id * SharedTables::copies + copy];
    const float squared = squared_length(positions.template at_place<rows_placed>(key >> 16) - own);
    const float distance = squared * inverse_sqrt(squared);
    const float stretch = multiply_add(-length.x, law.x, distance);
    energy = multiply_add(law.y * stretch, stretch, energy);
    if (id != air) share.strain = fmaxf(share.strain, fabsf(multiply_add(distance, length.y, -1.0f)));
  }
  share.sums[7] += static_cast<double>(energy);
}

// The rows of one warp: an even share of them, one after the other, the next ones on their way while the present ones are
// measured.
template <int record_words>
class WarpRows {
 public:
  // Begins to read.
  __device__ WarpRows(const Springs<record_words>& springs) : springs_(springs) {
    constexpr std::uint32_t warps = threads / lanes;
    const std::uint32_t warp = threadIdx.x / lanes, all = springs.row_start[springs.groups];
    row_ = all * warp / warps;
    end_ = all * (warp + 1) / warps;
    std::uint32_t begun = 0;
    for (std::uint32_t group = threadIdx.x % lanes; group < springs.groups; group += lanes)
      begun += springs.row_start[group] <= row_;
    group_ = __reduce_add_sync(0xffffffffu, begun) - 1;
    load();
  }

  template <int rows_placed, int rows>
  __device__ void measure(const Positions<rows>& positions, const SharedTables& tables, Share& share) {
    for (; row_ < end_; ++group_) {
      const Vec3 own = positions[group_ * lanes + threadIdx.x % lanes];
      const std::uint32_t last = min(springs_.row_start[group_ + 1], end_);
      while (row_ < last) {
        Record present[rows_at_once];
#pragma unroll
        for (int i = 0; i < rows_at_once; ++i) present[i] = next_[i];
        const std::uint32_t left = min(last - row_, static_cast<std::uint32_t>(rows_at_once));
        row_ += left;
        load();
        if (left == rows_at_once) {
          add_rows<rows_placed, rows, record_words>(positions, present, own, tables, share);
        } else {
          const Record pair[2] = {present[0], present[1]};
          if (left >= 2) add_rows<rows_placed, rows, record_words>(positions, pair, own, tables, share);
          const Record one[1] = {left == 3 ? present[2] : present[0]};
          if (left != 2) add_rows<rows_placed, rows, record_words>(positions, one, own, tables, share);
        }
      }
    }
  }

 private:
  using Record = typename Springs<record_words>::Record;
  __device__ void load() {
    const Record* from = springs_.records + std::size_t{row_} * lanes + threadIdx.x % lanes;
#pragma unroll
    for (int i = 0; i < rows_at_once; ++i) next_[i] = from[i * lanes];
  }

  const Springs<record_words>& springs_;
  std::uint32_t row_, end_, group_;
  Record next_[rows_at_once];
};

__device__ void reduce(Share (&shares)[threads / lanes], Share share, DeviceTelemetry& out, const DeviceStatus& status) {
  for (std::uint32_t half = lanes / 2; half > 0; half /= 2) {
    for (double& sum : share.sums) sum += __shfl_down_sync(0xffffffffu, sum, half);
    share.strain = fmaxf(share.strain, __shfl_down_sync(0xffffffffu, share.strain, half));
  }
  if (threadIdx.x % lanes == 0) shares[threadIdx.x / lanes] = share;
  __syncthreads();
  if (threadIdx.x < 8) {
    double sum = 0;
    for (const Share& of_warp : shares) sum += of_warp.sums[threadIdx.x];
    out.sums[threadIdx.x] = sum;
  } else if (threadIdx.x == lanes) {
    for (const Share& of_warp : shares) share.strain = fmaxf(share.strain, of_warp.strain);
    out.largest_strain = share.strain;
    out.bad_mass = status.bad_mass;
    out.exploded_step = status.exploded_step;
  }
}

// `on_chip`: the robots' positions fit into shared memory.
template <int rows_placed, int record_words>
__global__ void __launch_bounds__(threads)
    telemetry_kernel(BatchView batch, Clock clock, float stiffness_scale, bool on_chip, DeviceTelemetry* out) {
  extern __shared__ float copied[];
  __shared__ SharedTables tables;
  __shared__ Share shares[threads / lanes];
  const std::uint32_t robot = blockIdx.x;
  const RobotRecord& record = batch.robots[robot];
  const float* state = batch.state + std::size_t{robot} * batch.group_stride * state_rows * lanes;
  using Record = typename Springs<record_words>::Record;
  const Springs<record_words> springs{
      reinterpret_cast<const Record*>(batch.springs) + std::size_t{robot} * batch.row_stride * lanes,
      batch.row_start + std::size_t{robot} * (batch.group_stride + 1), record.groups};
  WarpRows<record_words> springs_of_warp(springs);
  fill(tables, batch, robot, clock.step - clock.base_step, stiffness_scale);
  Share share{};
  add_masses(state, record.groups * lanes, on_chip ? copied : nullptr, share);
  __syncthreads();
  if (on_chip)
    springs_of_warp.template measure<rows_placed>(Positions<3>{copied}, tables, share);
  else
    springs_of_warp.template measure<rows_placed>(Positions<state_rows>{state}, tables, share);
  reduce(shares, share, out[robot], batch.statuses[robot]);
}

template <int record_words>
auto kernel_for(std::uint32_t rows) {
  if (rows == 0) return telemetry_kernel<0, record_words>;
  constexpr int with_splits = working_rows(Solver::xpbd, true), without = working_rows(Solver::force, true);
  return rows == with_splits ? telemetry_kernel<with_splits, record_words> : telemetry_kernel<without, record_words>;
}

}  // namespace

void launch_telemetry(const BatchView& batch, const Clock& clock, float stiffness_scale, std::uint32_t rows,
                      DeviceTelemetry* out) {
  const std::size_t bytes = std::size_t{batch.group_stride} * 3 * row_bytes;
  constexpr std::size_t most_bytes = 28672;  // beside the tables, within what every device grants without being asked
  const bool on_chip = bytes <= most_bytes;
  const auto kernel = batch.record_words == 1 ? kernel_for<1>(rows) : kernel_for<2>(rows);
  kernel<<<batch.robot_count, threads, on_chip ? bytes : 0>>>(batch, clock, stiffness_scale, on_chip, out);
  check(cudaGetLastError(), "starting the telemetry kernel");
}

}  // namespace mercury::cuda
