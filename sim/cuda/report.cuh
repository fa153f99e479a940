// SPDX-License-Identifier: Apache-2.0
// Telemetry of a robot, computed from the masses in working memory between two steps or after the last one of a launch.
//
//   begin             each thread   zero, for a word of the staged report
//   -- barrier --     also after MaterialTable::write_rates()
//   measure_springs   each lane     energy and power of the springs it owns            -> fields of the masses
//                     each warp     their largest strain, the number of strained ones  -> the staged report
//   add_up_tiles      each warp     masses, energies and power, summed over its tiles   -> fields of the masses
//   -- barrier --
//   add_up_robot      one warp      the sums of all tiles                              -> the staged report
//   -- barrier --
//   mark_inverted     each warp     which of 32 cells are inside out, if asked for     -> fields of the masses
//   -- barrier --
//   sum_inverted      one thread    their volume                                       -> the staged report
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

// Adds up some numbers of each lane over the warp. Each lane returns one of the sums: at each distance, half of the
// lanes go on with half of the numbers.
//
//   distance 16   lanes 0 .. 15   numbers 0 .. 4, their own and those of the lane 16 further on
//                 lanes 16 .. 31  numbers 5 .. 8
//   distance 8    ...
template <std::uint32_t distance, std::uint32_t count>
__device__ double sum_of_one(std::uint32_t lane, const double (&numbers)[count]) {
  if constexpr (distance == 0) {
    return numbers[0];
  } else {
    constexpr std::uint32_t half = divide_up(count, 2);
    const bool is_higher = lane & distance;
    double kept[half];
#pragma unroll
    for (std::uint32_t i = 0; i < half; ++i) {
      const double low = numbers[i], high = numbers[min(i + half, count - 1)];
      const bool has_both = i + half < count;
      kept[i] = (is_higher && has_both ? high : low) +
                __shfl_xor_sync(0xffffffffu, is_higher || !has_both ? low : high, distance);
    }
    return sum_of_one<distance / 2>(lane, kept);
  }
}
// Which one; `count` or more if another lane returns it, too.
template <std::uint32_t distance, std::uint32_t count>
__device__ std::uint32_t number_of_sum(std::uint32_t lane) {
  if constexpr (distance == 0) {
    return 0;
  } else {
    constexpr std::uint32_t half = divide_up(count, 2);
    const std::uint32_t of_half = number_of_sum<distance / 2, half>(lane);
    const std::uint32_t number = of_half + (lane & distance ? half : 0);
    return of_half < half && number < count ? number : ~0u;
  }
}

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

  // The sums of a tile take the place of its energies.
  __device__ void add_up_tiles() const {
    for (std::uint32_t tile = robot_.first_tile(); tile < robot_.last_tile(); ++tile) {
      const Mass<Memory> mass = robot_.own_mass(tile);
      const float kilograms = robot_.point_mass(tile);
      const Vec3 x = mass.vector(field_x), v = mass.vector(field_v);
      const float speed = multiply_add(v.x, v.x, multiply_add(v.y, v.y, v.z * v.z));
      const float values[quantities] = {kilograms * x.x,          kilograms * x.y,          kilograms * x.z,
                                        kilograms * v.x,          kilograms * v.y,          kilograms * v.z,
                                        0.5f * kilograms * speed, mass.value(field_energy), mass.value(field_power)};
      double each[quantities];
#pragma unroll
      for (std::uint32_t i = 0; i < quantities; ++i) each[i] = static_cast<double>(values[i]);
      const double sum = sum_of_one<lanes / 2>(robot_.context().lane, each);
      const std::uint32_t quantity = number_of_sum<lanes / 2, quantities>(robot_.context().lane);
      __syncwarp();  // all lanes have read their energies
      if (quantity < quantities) set_tile_sum(tile, quantity, sum);
    }
  }

  __device__ void add_up_robot() const {
    if (robot_.thread() == 0) {  // this thread stored the status
      const DeviceStatus status = robot_.arguments().batch.statuses[robot_.context().robot];
      stage(offsetof(DeviceTelemetry, bad_mass), static_cast<int>(status.bad_mass));
      stage(offsetof(DeviceTelemetry, exploded_step), status.exploded_step);
      stage(offsetof(DeviceTelemetry, inverted), __float_as_int(nanf("")));
      const float strained = staged(offsetof(DeviceTelemetry, strained_share)).value(field_staged);
      stage(offsetof(DeviceTelemetry, strained_share),
            __float_as_int(mercury::strained_share(__float_as_uint(strained), robot_.header().springs)));
    }
    if (robot_.context().warp != 0) return;
    // Three lanes each add up a third of the tiles.
    constexpr std::uint32_t thirds = 3;
    const std::uint32_t lane = robot_.context().lane, quantity = lane % quantities;
    double total = 0;
    if (lane < thirds * quantities)
      for (std::uint32_t tile = lane / quantities; tile < robot_.header().tiles; tile += thirds)
        total += tile_sum(tile, quantity);
    total += __shfl_down_sync(0xffffffffu, total, quantities) + __shfl_down_sync(0xffffffffu, total, 2 * quantities);
    if (lane >= quantities) return;
    if (quantity == kinetic_energy)
      stage(offsetof(DeviceTelemetry, kinetic_energy), __double_as_longlong(total));
    else if (quantity == elastic_energy)
      stage(offsetof(DeviceTelemetry, elastic_energy), __double_as_longlong(0.5 * total));
    else if (quantity == power)
      stage(offsetof(DeviceTelemetry, muscle_power), __float_as_int(static_cast<float>(total)));
    else  // a component of the center of mass or of the velocity
      stage(offsetof(DeviceTelemetry, center_of_mass) + 4 * quantity,
            __float_as_int(static_cast<float>(total * (1.0 / robot_.header().mass))));
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
    if (robot_.thread() != 0) return;
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

  __device__ void set_tile_sum(std::uint32_t tile, std::uint32_t quantity, double sum) const {
    tile_word(tile, 2 * quantity).set_value(field_energy, __int_as_float(__double2loint(sum)));
    tile_word(tile, 2 * quantity + 1).set_value(field_energy, __int_as_float(__double2hiint(sum)));
  }
  __device__ double tile_sum(std::uint32_t tile, std::uint32_t quantity) const {
    return __hiloint2double(__float_as_int(tile_word(tile, 2 * quantity + 1).value(field_energy)),
                            __float_as_int(tile_word(tile, 2 * quantity).value(field_energy)));
  }
  __device__ Mass<Memory> tile_word(std::uint32_t tile, std::uint32_t i) const {
    return robot_.mass_at(tile * lanes + i);
  }

  // Has the bits of 32 cells in field_energy, when energies have been summed.
  __device__ Mass<Memory> inverted_cells(std::uint32_t word) const { return robot_.mass_at(word); }
  // The word of the staged report at this offset [bytes]: word i lies in field_staged of slot i.
  __device__ Mass<Memory> staged(std::uint32_t offset) const { return {robot_.context().masses + offset}; }
  __device__ void stage(std::uint32_t offset, int word) const {
    staged(offset).set_value(field_staged, __int_as_float(word));
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
  reporter.add_up_tiles();
  __syncthreads();
  reporter.add_up_robot();
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
