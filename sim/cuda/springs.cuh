// SPDX-License-Identifier: Apache-2.0
// The springs of a step: forces (Algorithm 1) or corrections (Algorithm 2), summed in fixed point.
//
// Every force and correction is rounded to a whole number of units (sim/physics/fixed_point.h) and summed as an
// integer.
//
//   fma(per_distance, d, 1.5 * 2^23)  =  a float with the bits  | 0x4b400000 + n |    n = the component, in units
//
//   owner's sum, in registers:           rows * 0x4b400000 - bits - bits - ...    one per row
//   reactions to it, in working memory:                      bits + bits + ...    one per entry whose partner it is
//
// 1. Integer sums do not depend on their order, so results are bit for bit the same for any number of warps and in
//    any batch, and action and reaction cancel exactly.
// 2. Rounding by an addition is part of the fma. A conversion instruction would take a slower unit of the chip.
// 3. The bits of the rounding constant are not removed from each term. Their number is known beforehand: a lane
//    subtracts one term per row, and a slot receives Schedule::incoming_counts[slot] terms, padding included. So the
//    owner's sum starts with the opposite of what all these constants add up to. Sums wrap around, which changes
//    nothing in the end.
// 4. The owner's sum is added to working memory once per tile; reactions are atomic additions without a result, which
//    a warp does not wait for.
#pragma once

#include <type_traits>

#include "sim/cuda/block_robot.cuh"
#include "sim/physics/fixed_point.h"
#include "sim/physics/springs.h"

namespace mercury::cuda {

// Which springs have a relaxation time.
enum class Viscosity { none, uniform, by_material };

template <class Robot, class EnvironmentModel>
class SpringPass {
 public:
  __device__ explicit SpringPass(const Robot& robot) : robot_(robot) {}

  // Adds the forces or corrections of all springs of this warp's tiles. Returns the longest |d|^2 that this thread met,
  // padding included [m2].
  template <Viscosity viscosity>
  __device__ float add_all() const {
    if constexpr (Memory::on_chip && !EnvironmentModel::real_bodies && Robot::has_length_table)
      if (robot_.has_three_lengths()) return add_all<viscosity>(robot_.three_lengths());
    return add_all<viscosity>(typename Robot::AnyLengths{robot_});
  }

  // The longest |d|^2 of this lane's springs without padding [m2]. Slow, and not inline, so that it takes no registers
  // from the steps.
  __device__ __noinline__ static float longest_spring(const StepArguments& arguments,
                                                      ThreadContext<typename Robot::Memory> context) {
    const Robot robot(arguments, context);
    float longest = 0;
    for (std::uint32_t tile = robot.first_tile(); tile < robot.last_tile(); ++tile)
      robot.for_each_spring_of(robot.own_slot(tile), [&](const SpringRecord& record) {
        longest = fmaxf(
            longest, squared_length(robot.own_mass(tile).vector(field_x) - robot.partner_of(record).vector(field_x)));
      });
    return longest;
  }

 private:
  static constexpr Solver solver = Robot::solver;
  static constexpr bool has_contacts = EnvironmentModel::has_contacts && Robot::Memory::finds_contacts;
  using Memory = typename Robot::Memory;
  using SpringRecord = typename Robot::SpringRecord;

  // A mass while its springs are visited. The sums are of what the springs add to its partners, negated.
  struct Owner {
    Vec3 x;
    float valence;
    int sum_x, sum_y, sum_z;
    Vec3 v;  // if viscous
  };

  struct LoadedSpring {
    Mass<Memory> partner;
    Vec3 d;  // from the partner to the owner
    SpringParameters<solver> parameters;
    float scaled_rest_length;
    float valence;          // of both masses together, for XPBD
    Vec3 rate;              // the velocity of the owner, seen from the partner, if viscous
    float relaxation_time;  // if that is by material
  };

  struct SpringDamping {
    float scaled_relaxation_time, viscous_factor;  // the factor for XPBD
  };
  struct Damping {
    float highest_rate;     // of length [m/s]
    SpringDamping uniform;  // of all springs
  };
  __device__ SpringDamping damping_of(float relaxation_time) const {
    return {robot_.scale() * relaxation_time, viscous_factor(relaxation_time, robot_.arguments().constants.inverse_dt)};
  }

  template <Viscosity viscosity, class Lengths>
  __device__ float add_all(const Lengths& lengths) const {
    float longest = 0;
    Damping damping{};
    if constexpr (viscosity != Viscosity::none) {
      const RobotHeader& header = robot_.stored_header();
      damping = {header.highest_length_rate, damping_of(header.relaxation_time)};
    }
    // Measured for each (docs/experiments.md).
    constexpr SpringWalk walk{
        .keeps_loads_above = solver == Solver::xpbd || EnvironmentModel::real_bodies || Memory::in_parts ||
                             std::is_same_v<EnvironmentModel, OceanModel> ||
                             std::is_same_v<Lengths, typename Robot::AnyLengths>,
        .groups_per_turn =
            Memory::in_parts || solver == Solver::xpbd || (has_contacts && !EnvironmentModel::real_bodies) ? 2 : 1};
    robot_.template walk_springs<walk>(
        [&](std::uint32_t tile, const Mass<Memory>& mass, const SlotRows& rows) {
          Owner owner{mass.vector(field_x), own_valence(tile, mass), rows.bias, rows.bias, rows.bias, {}};
          if constexpr (viscosity != Viscosity::none) owner.v = mass.vector(field_v);
          return owner;
        },
        [&](const SpringRecord& record, const Owner& owner) { return load<viscosity>(record, lengths, owner); },
        [&](const auto& springs, Owner& owner) { add_springs<viscosity>(springs, damping, owner, longest); },
        [](const Mass<Memory>& mass, const Owner& owner) { mass.add_to_sum(owner.sum_x, owner.sum_y, owner.sum_z); });
    return longest;
  }

  template <Viscosity viscosity, class Lengths>
  __device__ LoadedSpring load(const SpringRecord& record, const Lengths& lengths, const Owner& owner) const {
    LoadedSpring spring;
    spring.partner = robot_.partner_of(record);
    spring.scaled_rest_length = lengths.of(record);
    spring.d = owner.x - spring.partner.vector(field_x);
    spring.parameters = robot_.parameters_of(record);
    if constexpr (solver == Solver::xpbd) spring.valence = owner.valence + partner_valence(record, spring.partner);
    if constexpr (viscosity != Viscosity::none) spring.rate = owner.v - spring.partner.vector(field_v);
    if constexpr (viscosity == Viscosity::by_material) spring.relaxation_time = robot_.relaxation_time_of(record);
    return spring;
  }

  // Springs of one owner.
  template <Viscosity viscosity, int count>
  __device__ void add_springs(const LoadedSpring (&springs)[count], const Damping& damping, Owner& owner,
                              float& longest) const {
    float squares[count];
#pragma unroll
    for (int i = 0; i < count; ++i) {
      const LoadedSpring& spring = springs[i];
      const float squared = squares[i] = squared_length(spring.d);
      if (i % 2 == 1)
        longest = largest_of(longest, squares[i - 1], squared);
      else if (i == count - 1)
        longest = fmaxf(longest, squared);
      const float per_distance = units_per_distance<viscosity>(spring, damping, squared);
      const int x = bits_of(multiply_add(per_distance, spring.d.x, rounding_magic));
      const int y = bits_of(multiply_add(per_distance, spring.d.y, rounding_magic));
      const int z = bits_of(multiply_add(per_distance, spring.d.z, rounding_magic));
      owner.sum_x -= x;
      owner.sum_y -= y;
      owner.sum_z -= z;
      spring.partner.add_to_sum(x, y, z);
    }
  }

  // Of numbers that are not negative, in one instruction: such floats have the order of their bits.
  __device__ static float largest_of(float a, float b, float c) {
    return __int_as_float(__vimax3_s32(__float_as_int(a), __float_as_int(b), __float_as_int(c)));
  }

  // Force or correction on the partner, per meter of d, in units.
  template <Viscosity viscosity>
  __device__ float units_per_distance(const LoadedSpring& spring, const Damping& damping, float squared) const {
    float length = spring.scaled_rest_length * spring.parameters.length_factor;
    float valence = spring.valence;
    if constexpr (viscosity != Viscosity::none) {
      const Vec3 d = spring.d, rate = spring.rate;
      const float approach = multiply_add(d.z, rate.z, multiply_add(d.y, rate.y, d.x * rate.x));
      SpringDamping by = damping.uniform;
      if constexpr (viscosity == Viscosity::by_material) by = damping_of(spring.relaxation_time);
      length = viscous_length(length, by.scaled_relaxation_time, length_rate(squared, approach, damping.highest_rate));
      if constexpr (solver == Solver::xpbd) valence *= by.viscous_factor;
    }
    if constexpr (solver == Solver::force)
      return hooke(squared, length, spring.parameters.stiffness, robot_.scale());
    else
      return xpbd(squared, length, valence, spring.parameters.compliance, robot_.scale());
  }

  __device__ float own_valence(std::uint32_t tile, const Mass<Memory>& mass) const {
    if constexpr (solver == Solver::force)
      return 0;
    else if constexpr (Memory::keeps_valence)
      return mass.value(field_valence);
    else
      return robot_.load_valence(robot_.own_slot(tile));
  }
  __device__ float partner_valence(const SpringRecord& record, const Mass<Memory>& partner) const {
    if constexpr (Memory::keeps_valence)
      return partner.value(field_valence);
    else
      return robot_.load_valence(robot_.partner_slot_of(record));
  }

  const Robot& robot_;
};

}  // namespace mercury::cuda
