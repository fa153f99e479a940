// SPDX-License-Identifier: Apache-2.0
// Telemetry of a robot, computed from the masses in working memory between two steps or after the last one of a launch.
//
//   begin             each thread   zero, for a word of the staged report
//   -- barrier --     also after MaterialTable::write_rates()
//   measure_springs   each lane     energy and power of the springs it owns            -> fields of the masses
//                     each warp     their largest strain, the number of strained ones  -> the staged report
//   -- barrier --
//   reduce            each warp     some of the quantities, summed over all masses     -> the staged report
//   -- barrier --
//   mark_inverted     each warp     which of 32 cells are inside out, if asked for     -> fields of the masses
//   -- barrier --
//   sum_inverted      one warp      their volume                                       -> the staged report
//   -- barrier --
//   write             each thread   one word of the staged report                      -> host memory
//
// 1. The order of every sum of floats depends only on the robot, so telemetry is reproducible too. A maximum and a
//    number of springs are the same in any order.
// 2. The sums of fixed point are done with, so their fields hold the results of these stages. The material table
//    has the rates of the muscles where the steps had the coefficients; stiffnesses are read from device memory.
// 3. The report lies in mapped host memory. Staging it first lets the threads write it in one transaction.
#pragma once

#include <cstddef>

#include "mercury/observables.h"
#include "sim/cuda/block_robot.cuh"
#include "sim/cuda/telemetry.h"
#include "sim/physics/inversion.h"
#include "sim/physics/springs.h"

namespace mercury::cuda {

template <class Robot>
class RobotReporter {
 public:
  // `materials` = the robot's, by id.
  __device__ RobotReporter(const Robot& robot, const Material* materials) : robot_(robot), materials_(materials) {}

  __device__ void begin() const {
    if (robot_.thread() < report_words) staged(4 * robot_.thread()).set_value(field_staged, 0);
  }

  __device__ void measure_springs() const {
    Deformation deformation;
    robot_.template walk_springs<SpringWalk{}>(
        [](std::uint32_t, const Mass<Memory>& mass, const SlotRows&) {
          return Owner{mass.vector(field_x), 0, 0};
        },
        [&](const SpringRecord& record, const Owner& owner) { return load(record, owner); },
        [&](const auto& springs, Owner& owner) { measure(springs, owner, deformation); },
        [](const Mass<Memory>& mass, const Owner& owner) {
          mass.set_value(field_energy, owner.twice_energy);
          mass.set_value(field_power, owner.power);
        });
    // Strains are not negative, and such floats have the order of their bits.
    const std::uint32_t largest = maximum_of_warp(__float_as_uint(deformation.largest_strain));
    const std::uint32_t strained = sum_of_warp(deformation.strained);
    if (robot_.context().lane != 0) return;
    Memory::raise(staged(offsetof(DeviceTelemetry, largest_strain)).at, field_staged * field_bytes, largest);
    Memory::add(staged(offsetof(DeviceTelemetry, strained_share)).at, field_staged * field_bytes,
                static_cast<int>(strained));
  }

  __device__ void reduce() const {
    if (robot_.thread() == 0) {  // this thread stored the status
      const DeviceStatus status = robot_.arguments().batch.statuses[robot_.context().robot];
      stage(offsetof(DeviceTelemetry, bad_mass), static_cast<int>(status.bad_mass));
      stage(offsetof(DeviceTelemetry, exploded_step), status.exploded_step);
      stage(offsetof(DeviceTelemetry, inverted), __float_as_int(nanf("")));
      const float strained = staged(offsetof(DeviceTelemetry, strained_share)).value(field_staged);
      stage(offsetof(DeviceTelemetry, strained_share),
            __float_as_int(mercury::strained_share(__float_as_uint(strained), robot_.header().springs)));
    }
    const double share = 1.0 / robot_.header().mass;
    for (std::uint32_t quantity = robot_.context().warp; quantity < quantities; quantity += robot_.warps()) {
      const double total = sum(quantity);
      if (quantity == kinetic_energy)
        stage(offsetof(DeviceTelemetry, kinetic_energy), __double_as_longlong(total));
      else if (quantity == elastic_energy)
        stage(offsetof(DeviceTelemetry, elastic_energy), __double_as_longlong(0.5 * total));
      else if (quantity == power)
        stage(offsetof(DeviceTelemetry, muscle_power), __float_as_int(static_cast<float>(total)));
      else  // a component of the center of mass or of the velocity, which is also the number of a field
        stage(offsetof(DeviceTelemetry, center_of_mass) + 4 * quantity,
              __float_as_int(static_cast<float>(share * total)));
    }
  }

  __device__ void mark_inverted(const Reports& reports) const {
    const RobotCells of_robot = reports.robots[robot_.context().robot];
    for (std::uint32_t word = robot_.context().warp; word * lanes < of_robot.count; word += robot_.warps()) {
      const std::uint32_t cell = word * lanes + robot_.context().lane;
      bool inverted = false;
      if (cell < of_robot.count) {
        const DeviceCell& own = reports.cells[of_robot.first + cell];
        const auto corner = [&](int k) { return Double3(robot_.mass_at(own.corners[k]).vector(field_x)); };
        inverted =
            own.corners[4] == DeviceCell::no_corner ? is_inverted_tetrahedron(corner) : is_inverted_voxel(corner);
      }
      const std::uint32_t bits = __ballot_sync(0xffffffffu, inverted);
      if (robot_.context().lane == 0) inverted_cells(word).set_value(field_energy, __uint_as_float(bits));
    }
  }

  // Volumes are added in the order of the cells, as on the host.
  __device__ void sum_inverted(const Reports& reports) const {
    if (robot_.context().warp != 0) return;
    const RobotCells of_robot = reports.robots[robot_.context().robot];
    double inverted = 0;
    for (std::uint32_t word = 0; word * lanes < of_robot.count; ++word)
      for (std::uint32_t left = __float_as_uint(inverted_cells(word).value(field_energy)); left != 0;
           left &= left - 1) {
        const std::uint32_t cell = word * lanes + static_cast<std::uint32_t>(__ffs(static_cast<int>(left)) - 1);
        inverted += static_cast<double>(reports.cells[of_robot.first + cell].volume);
      }
    stage(offsetof(DeviceTelemetry, inverted), __float_as_int(static_cast<float>(inverted / of_robot.volume)));
  }

  __device__ void write(DeviceTelemetry& out) const {
    if (robot_.thread() < report_words)
      reinterpret_cast<float*>(&out)[robot_.thread()] = staged(4 * robot_.thread()).value(field_staged);
  }

 private:
  using Memory = typename Robot::Memory;
  using SpringRecord = typename Robot::SpringRecord;

  static constexpr std::uint32_t report_words = sizeof(DeviceTelemetry) / 4;
  static constexpr std::uint32_t field_energy = field_sum, field_power = field_sum + 1, field_staged = field_sum + 2;
  enum Quantity : std::uint32_t { kinetic_energy = 6, elastic_energy = 7, power = 8, quantities = 9 };

  // A mass while the springs that it owns are measured.
  struct Owner {
    Vec3 x;
    float twice_energy, power;  // [J], [W]
  };
  // Of all springs that a thread measures.
  struct Deformation {
    float largest_strain = 0;
    std::uint32_t strained = 0;  // springs
  };

  struct LoadedSpring {
    SpringRecord record;
    float rest_length;
    Vec3 d;
    float stiffness;
  };
  __device__ LoadedSpring load(const SpringRecord& record, const Owner& owner) const {
    return {record, robot_.rest_length_of(record), owner.x - robot_.partner_of(record).vector(field_x),
            robot_.arguments().stiffness_scale * __ldg(&materials_[robot_.material_of(record)].stiffness)};
  }

  template <int count>
  __device__ void measure(const LoadedSpring (&springs)[count], Owner& owner, Deformation& deformation) const {
#pragma unroll
    for (const auto& [record, rest_length, d, stiffness] : springs) {
      // Loaded here, since all registers are in use.
      const auto [length_rate, length_factor] = robot_.rate_and_length_factor_of(record);
      const float squared = squared_length(d);
      const float distance = squared * inverse_sqrt(squared);
      const float too_long = stretch(distance, rest_length, length_factor);
      owner.twice_energy = multiply_add(spring_force(stiffness, too_long), too_long, owner.twice_energy);
      owner.power += muscle_power(stiffness, too_long, rest_length, length_rate);
      if (robot_.material_of(record) == air) continue;  // padding
      const float relative = strain(distance, rest_length);
      deformation.largest_strain = fmaxf(deformation.largest_strain, fabsf(relative));
      deformation.strained += is_strained(relative) ? 1 : 0;
    }
  }

  // Over all masses. Each lane has eight loads under way at once.
  __device__ double sum(std::uint32_t quantity) const {
    constexpr int at_once = 8;
    const std::uint32_t tiles = robot_.header().tiles;
    double even = 0, odd = 0;
    for (std::uint32_t tile = 0; tile < tiles; tile += at_once) {
      float value[at_once];
#pragma unroll
      for (int i = 0; i < at_once; ++i) value[i] = tile + i < tiles ? value_of(tile + i, quantity) : 0;
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
  __device__ float value_of(std::uint32_t tile, std::uint32_t quantity) const {
    const Mass<Memory> mass = robot_.own_mass(tile);
    if (quantity == elastic_energy) return mass.value(field_energy);
    if (quantity == power) return mass.value(field_power);
    const float kilograms = robot_.point_mass(tile);
    if (quantity != kinetic_energy) return kilograms * mass.value(quantity);
    const Vec3 v = mass.vector(field_v);
    return 0.5f * kilograms * multiply_add(v.x, v.x, multiply_add(v.y, v.y, v.z * v.z));
  }

  // Has the bits of 32 cells in field_energy, when energies have been summed.
  __device__ Mass<Memory> inverted_cells(std::uint32_t word) const { return robot_.mass_at(word); }
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
  const Material* const materials_;
};

// Needs a barrier before it. All threads of the block must call this, since it has barriers. `materials` = the robot's,
// by id. `out` = null: writes nothing. Not inline, so that it takes no registers from the steps.
template <class Robot>
__device__ __noinline__ void report(const StepArguments& arguments, ThreadContext<typename Robot::Memory> context,
                                    const Material* materials, DeviceTelemetry* out) {
  const Robot robot(arguments, context);
  const RobotReporter<Robot> reporter(robot, materials);
  reporter.begin();
  __syncthreads();
  reporter.measure_springs();
  __syncthreads();
  reporter.reduce();
  __syncthreads();
  if (arguments.reports.robots) {
    reporter.mark_inverted(arguments.reports);
    __syncthreads();
    reporter.sum_inverted(arguments.reports);
    __syncthreads();
  }
  if (out) reporter.write(*out);
}

}  // namespace mercury::cuda
