// SPDX-License-Identifier: Apache-2.0
// Telemetry of a robot from the masses on the chip, where its last step left it.
#pragma once

#include <cstddef>

#include "sim/cuda/block_robot.cuh"
#include "sim/cuda/telemetry.h"
#include "sim/physics/springs.h"

namespace mercury::cuda {

// The order of every sum is fixed by the robot alone.
template <Solver solver, class Memory, int record_words>
class RobotReporter : public BlockRobot<solver, Memory, record_words> {
  using Robot = BlockRobot<solver, Memory, record_words>;
  using typename Robot::Record, Robot::arguments_, Robot::record_, Robot::seat_, Robot::warps, Robot::thread,
      Robot::own, Robot::partner_of, Robot::rest_length_of, Robot::material_of, Robot::unit, Robot::law_of,
      Robot::for_each_rows;

 public:
  __device__ explicit RobotReporter(const Robot& robot) : Robot(robot) {}

  // Measures the springs of this warp's masses. What each mass owns stands behind its state from then on.
  __device__ void measure_springs() const {
    for_each_rows(
        [](std::uint32_t, const Mass<Memory>& mass, std::uint32_t) {
          return Owned{mass.vector(row_x), 0, 0};
        },
        [&](auto count, const Record* records, Owned& owned) { measure<decltype(count)::value>(records, owned); },
        [](const Mass<Memory>& mass, const Owned& owned) {
          mass.set_value(row_energy, owned.energy);
          mass.set_value(row_strain, owned.strain);
        });
  }

  // Behind a barrier: the sums over all masses, each by one warp, which lays it ready at the robot's first group.
  __device__ void reduce() const {
    if (thread() == 0) {  // who stored the status
      const DeviceStatus status = arguments_.batch.statuses[seat_.robot];
      lay(offsetof(DeviceTelemetry, bad_mass), static_cast<int>(status.bad_mass));
      lay(offsetof(DeviceTelemetry, exploded_step), status.exploded_step);
    }
    const double share = 1.0 / record_.masses;
    for (std::uint32_t which = seat_.warp; which < quantities; which += warps()) {
      if (which == largest_strain)
        lay(offsetof(DeviceTelemetry, largest_strain), __float_as_int(largest()));
      else if (which == kinetic_energy)
        lay(offsetof(DeviceTelemetry, kinetic_energy), __double_as_longlong(sum(which)));
      else if (which == elastic_energy)
        lay(offsetof(DeviceTelemetry, elastic_energy), __double_as_longlong(energy_of_unit() * sum(which)));
      else  // the components of two vectors, as they stand at a mass
        lay(offsetof(DeviceTelemetry, center_of_mass) + 4 * which,
            __float_as_int(static_cast<float>(share * sum(which))));
    }
  }

  // Behind another barrier.
  __device__ void write(DeviceTelemetry& out) const {
    if (thread() < sizeof(DeviceTelemetry) / 4)
      reinterpret_cast<float*>(&out)[thread()] = ready(4 * thread()).value(row_ready);
  }

 private:
  static constexpr std::uint32_t row_energy = row_sum, row_strain = row_sum + 1, row_ready = row_sum + 2;
  enum Quantity : std::uint32_t { kinetic_energy = 6, elastic_energy = 7, largest_strain = 8, quantities = 9 };

  // Of the springs that a mass owns; energies in units of energy_of_unit().
  struct Owned {
    Vec3 x;
    float energy, strain;
  };

  template <int count>
  __device__ void measure(const Record* records, Owned& owned) const {
    Vec3 d[count];
    float2 law[count];
    float rest_length[count];
#pragma unroll
    for (int i = 0; i < count; ++i) {
      rest_length[i] = rest_length_of(records[i]) * (1 / unit());
      d[i] = owned.x - partner_of(records[i]).vector(row_x);
      law[i] = law_of(records[i]);
    }
#pragma unroll
    for (int i = 0; i < count; ++i) {
      const float squared = squared_length(d[i]);
      const float distance = squared * inverse_sqrt(squared);
      const float stretch = multiply_add(-rest_length[i], law[i].y, distance);
      if constexpr (solver == Solver::force)
        owned.energy = multiply_add(law[i].x * stretch, stretch, owned.energy);
      else
        owned.energy = multiply_add(inverse(law[i].x) * stretch, stretch, owned.energy);  // .x is the compliance
      const float strain = fabsf(multiply_add(distance, inverse(rest_length[i]), -1.0f));
      if (material_of(records[i]) != air) owned.strain = fmaxf(owned.strain, strain);
    }
  }
  __device__ double energy_of_unit() const {
    return solver == Solver::force ? 0.5 : 0.5 / (arguments_.clock.dt * arguments_.clock.dt);
  }

  // Of all masses; eight loads a lane are under way together.
  __device__ double sum(std::uint32_t which) const {
    constexpr int at_once = 8;
    double even = 0, odd = 0;
    for (std::uint32_t g = 0; g < record_.groups; g += at_once) {
      float value[at_once];
#pragma unroll
      for (int i = 0; i < at_once; ++i) value[i] = g + i < record_.groups ? value_of(own(g + i), which) : 0;
#pragma unroll
      for (int i = 0; i < at_once; i += 2) {
        even += static_cast<double>(value[i]);
        odd += static_cast<double>(value[i + 1]);
      }
    }
    double sum = even + odd;
    for (std::uint32_t half = lanes / 2; half > 0; half /= 2) sum += __shfl_down_sync(0xffffffffu, sum, half);
    return sum;
  }
  __device__ static float value_of(const Mass<Memory>& mass, std::uint32_t which) {
    if (which != kinetic_energy) return mass.value(which == elastic_energy ? row_energy : which);
    const Vec3 v = mass.vector(row_v);
    return 0.5f * multiply_add(v.x, v.x, multiply_add(v.y, v.y, v.z * v.z));
  }
  __device__ float largest() const {
    float strain = 0;
#pragma unroll 8
    for (std::uint32_t g = 0; g < record_.groups; ++g) strain = fmaxf(strain, own(g).value(row_strain));
    return __uint_as_float(__reduce_max_sync(0xffffffffu, __float_as_uint(strain)));
  }

  // What begins so many bytes behind the report's first.
  __device__ Mass<Memory> ready(std::uint32_t offset) const { return {seat_.masses + offset}; }
  __device__ void lay(std::uint32_t offset, int word) const {
    if (seat_.lane == 0) ready(offset).set_value(row_ready, __int_as_float(word));
  }
  __device__ void lay(std::uint32_t offset, long long words) const {
    lay(offset, static_cast<int>(words));
    lay(offset + 4, static_cast<int>(words >> 32));
  }
};

// After the last step; holds barriers of the block.
template <Solver solver, class Memory, int record_words>
__device__ void report(const BlockRobot<solver, Memory, record_words>& robot, DeviceTelemetry* out) {
  const RobotReporter<solver, Memory, record_words> reporter(robot);
  reporter.measure_springs();
  __syncthreads();
  reporter.reduce();
  __syncthreads();
  if (out) reporter.write(*out);
}

}  // namespace mercury::cuda
