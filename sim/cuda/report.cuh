// SPDX-License-Identifier: Apache-2.0
// Telemetry of a robot, computed from the masses in working memory after the last step of a launch.
//
//   measure_springs   each lane     energy and largest strain of the springs it owns   -> fields of the masses
//   -- barrier --
//   reduce            each warp     some of the quantities, summed over all masses     -> the staged report
//   -- barrier --
//   write             each thread   one word of the staged report                      -> host memory
//
// 1. The order of every sum depends only on the robot, so telemetry is reproducible too.
// 2. The sums of fixed point are done with, so their fields hold the results of the first two stages.
// 3. The report lies in mapped host memory. Staging it first lets the threads write it in one transaction.
#pragma once

#include <cstddef>

#include "mercury/observables.h"
#include "sim/cuda/block_robot.cuh"
#include "sim/cuda/telemetry.h"
#include "sim/physics/springs.h"

namespace mercury::cuda {

template <class Robot>
class RobotReporter {
 public:
  __device__ explicit RobotReporter(const Robot& robot) : robot_(robot) {}

  __device__ void measure_springs() const {
    robot_.walk_springs(
        [](std::uint32_t, const Mass<Memory>& mass, std::uint32_t) {
          return Owner{mass.vector(field_x), 0, 0};
        },
        [&](auto count, const SpringRecord* records, Owner& owner) { measure<decltype(count)::value>(records, owner); },
        [](const Mass<Memory>& mass, const Owner& owner) {
          mass.set_value(field_energy, owner.energy);
          mass.set_value(field_strain, owner.strain);
        });
  }

  __device__ void reduce() const {
    if (robot_.thread() == 0) {  // this thread stored the status
      const DeviceStatus status = robot_.arguments().batch.statuses[robot_.context().robot];
      stage(offsetof(DeviceTelemetry, bad_mass), static_cast<int>(status.bad_mass));
      stage(offsetof(DeviceTelemetry, exploded_step), status.exploded_step);
    }
    const double share = 1.0 / robot_.header().masses;
    for (std::uint32_t quantity = robot_.context().warp; quantity < quantities; quantity += robot_.warps()) {
      if (quantity == largest_strain)
        stage(offsetof(DeviceTelemetry, largest_strain), __float_as_int(largest()));
      else if (quantity == kinetic_energy)
        stage(offsetof(DeviceTelemetry, kinetic_energy), __double_as_longlong(sum(quantity)));
      else if (quantity == elastic_energy)
        stage(offsetof(DeviceTelemetry, elastic_energy), __double_as_longlong(energy_unit() * sum(quantity)));
      else  // a component of the center of mass or of the velocity, which is also the number of a field
        stage(offsetof(DeviceTelemetry, center_of_mass) + 4 * quantity,
              __float_as_int(static_cast<float>(share * sum(quantity))));
    }
  }

  __device__ void write(DeviceTelemetry& out) const {
    if (robot_.thread() < sizeof(DeviceTelemetry) / 4)
      reinterpret_cast<float*>(&out)[robot_.thread()] = staged(4 * robot_.thread()).value(field_staged);
  }

 private:
  static constexpr Solver solver = Robot::solver;
  using Memory = typename Robot::Memory;
  using SpringRecord = typename Robot::SpringRecord;

  static constexpr std::uint32_t field_energy = field_sum, field_strain = field_sum + 1, field_staged = field_sum + 2;
  enum Quantity : std::uint32_t { kinetic_energy = 6, elastic_energy = 7, largest_strain = 8, quantities = 9 };

  // A mass while the springs that it owns are measured.
  struct Owner {
    Vec3 x;
    float energy;  // in units of energy_unit()
    float strain;
  };

  struct LoadedSpring {
    float rest_length;
    Vec3 d;
    SpringParameters<solver> parameters;
  };

  template <int count>
  __device__ void measure(const SpringRecord* records, Owner& owner) const {
    LoadedSpring springs[count];
#pragma unroll
    for (int i = 0; i < count; ++i) {
      springs[i].rest_length = robot_.scaled_rest_length_of(records[i]) * (1 / robot_.scale());
      springs[i].d = owner.x - robot_.partner_of(records[i]).vector(field_x);
      springs[i].parameters = robot_.parameters_of(records[i]);
    }
#pragma unroll
    for (int i = 0; i < count; ++i) {
      const LoadedSpring& spring = springs[i];
      const float squared = squared_length(spring.d);
      const float distance = squared * inverse_sqrt(squared);
      const float too_long = stretch(distance, spring.rest_length, spring.parameters.length_factor);
      owner.energy = multiply_add(spring_force(stiffness_of(spring.parameters), too_long), too_long, owner.energy);
      if (robot_.material_of(records[i]) != air)
        owner.strain = fmaxf(owner.strain, fabsf(strain(distance, spring.rest_length)));
    }
  }

  // In units that make the energy of a spring stiffness * stretch^2 * energy_unit().
  __device__ static float stiffness_of(const SpringParameters<solver>& parameters) {
    if constexpr (solver == Solver::force)
      return parameters.stiffness;
    else
      return inverse(parameters.compliance);
  }
  __device__ double energy_unit() const {
    const double dt = robot_.arguments().clock.dt;
    return solver == Solver::force ? 0.5 : 0.5 / (dt * dt);
  }

  // Over all masses. Each lane has eight loads under way at once.
  __device__ double sum(std::uint32_t quantity) const {
    constexpr int at_once = 8;
    const std::uint32_t tiles = robot_.header().tiles;
    double even = 0, odd = 0;
    for (std::uint32_t tile = 0; tile < tiles; tile += at_once) {
      float value[at_once];
#pragma unroll
      for (int i = 0; i < at_once; ++i) value[i] = tile + i < tiles ? value_of(robot_.own_mass(tile + i), quantity) : 0;
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
  __device__ static float value_of(const Mass<Memory>& mass, std::uint32_t quantity) {
    if (quantity != kinetic_energy) return mass.value(quantity == elastic_energy ? field_energy : quantity);
    const Vec3 v = mass.vector(field_v);
    return 0.5f * multiply_add(v.x, v.x, multiply_add(v.y, v.y, v.z * v.z));
  }
  __device__ float largest() const {
    float strain = 0;
#pragma unroll 8
    for (std::uint32_t tile = 0; tile < robot_.header().tiles; ++tile)
      strain = fmaxf(strain, robot_.own_mass(tile).value(field_strain));
    return __uint_as_float(__reduce_max_sync(0xffffffffu, __float_as_uint(strain)));
  }

  // The word of the staged report at this offset [bytes]: word i lies in field_staged of slot i.
  __device__ Mass<Memory> staged(std::uint32_t offset) const { return {robot_.context().masses + offset}; }
  __device__ void stage(std::uint32_t offset, int word) const {
    if (robot_.context().lane == 0) staged(offset).set_value(field_staged, __int_as_float(word));
  }
  __device__ void stage(std::uint32_t offset, long long words) const {
    stage(offset, static_cast<int>(words));
    stage(offset + 4, static_cast<int>(words >> 32));
  }

  const Robot& robot_;
};

// All threads of the block must call this, since it has barriers. `out` = null: writes nothing.
template <class Robot>
__device__ void report(const Robot& robot, DeviceTelemetry* out) {
  const RobotReporter<Robot> reporter(robot);
  reporter.measure_springs();
  __syncthreads();
  reporter.reduce();
  __syncthreads();
  if (out) reporter.write(*out);
}

}  // namespace mercury::cuda
