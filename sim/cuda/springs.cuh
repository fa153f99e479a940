// SPDX-License-Identifier: Apache-2.0
// The springs of a step: forces (Algorithm 1) or corrections (Algorithm 2), summed in fixed point.
//
// Every force and correction is rounded to a whole number of units (sim/physics/fixed_point.h) and summed as an
// integer.
//
//   fma(per_distance, d, 1.5 * 2^23)  =  a float with the bits  | 0x4b400000 + n |    n = the component, in units
//
//   owner's sum, in registers:          rows * 0x4b400000   - bits - bits - ...      one per row
//   a slot's sum, in working memory:  - incoming * 0x4b400000 + bits + bits + ...    one per entry whose partner it is
//
// 1. Integer sums do not depend on their order, so results are bit for bit the same for any number of warps and in
//    any batch, and action and reaction cancel exactly.
// 2. Rounding by an addition is part of the fma. A conversion instruction would take a slower unit of the chip.
// 3. The bits of the rounding constant are not removed from each term. Their number is known beforehand: a lane
//    subtracts one term per row, and a slot receives incoming_counts[slot] terms, padding included. So the sums start
//    with the opposite of what the constants add up to. Sums wrap around, which changes nothing in the end.
// 4. The owner's sum is added to working memory once per tile; reactions are atomic additions without a result, which
//    a warp does not wait for.
#pragma once

#include "sim/cuda/block_robot.cuh"
#include "sim/physics/fixed_point.h"
#include "sim/physics/springs.h"

namespace mercury::cuda {

// Which springs have a relaxation time.
enum class Viscosity { none, uniform, by_material };

template <class Robot>
class SpringPass {
 public:
  __device__ explicit SpringPass(const Robot& robot) : robot_(robot) {}

  // Adds the forces or corrections of all springs of this warp's tiles. Returns the longest |d|^2 that this thread met,
  // padding included [m2].
  template <Viscosity viscosity>
  __device__ float add_all() const {
    float longest = 0;
    Damping damping{};
    if constexpr (viscosity != Viscosity::none) {
      const RobotHeader& header = robot_.stored_header();
      damping = {header.highest_length_rate, damping_of(header.relaxation_time)};
    }
    robot_.walk_springs(
        [&](std::uint32_t tile, const Mass<Memory>& mass, std::uint32_t rows) {
          const int bias = static_cast<int>(rows) * rounding_magic_bits;
          Owner owner{mass.vector(field_x), own_valence(tile, mass), bias, bias, bias, {}};
          if constexpr (viscosity != Viscosity::none) owner.v = mass.vector(field_v);
          return owner;
        },
        [&](auto count, const SpringRecord* records, Owner& owner) {
          add_springs<decltype(count)::value, viscosity>(records, damping, owner, longest);
        },
        [](const Mass<Memory>& mass, const Owner& owner) { mass.add_to_sum(owner.sum_x, owner.sum_y, owner.sum_z); });
    return longest;
  }

  // The longest |d|^2 of this lane's springs without padding [m2]. Slow, and not inline, so that it takes no registers
  // from the steps.
  __device__ __noinline__ static float longest_spring(const StepArguments& arguments,
                                                      ThreadContext<typename Robot::Memory> context) {
    const Robot robot(arguments, context);
    float longest = 0;
    for (std::uint32_t tile = robot.first_tile(); tile < robot.last_tile(); ++tile)
      for (std::uint32_t row = robot.row_start()[tile]; row < robot.row_start()[tile + 1]; ++row) {
        const auto record = robot.springs()[std::size_t{row} * lanes + robot.context().lane];
        if (robot.material_of(record) == air) continue;
        longest = fmaxf(
            longest, squared_length(robot.own_mass(tile).vector(field_x) - robot.partner_of(record).vector(field_x)));
      }
    return longest;
  }

 private:
  static constexpr Solver solver = Robot::solver;
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

  // `count` springs of one owner: first all loads, then the arithmetic and the additions.
  template <int count, Viscosity viscosity>
  __device__ void add_springs(const SpringRecord* records, const Damping& damping, Owner& owner, float& longest) const {
    LoadedSpring springs[count];
#pragma unroll
    for (int i = 0; i < count; ++i) {
      springs[i] = load(records[i], owner);
      if constexpr (viscosity != Viscosity::none) springs[i].rate = owner.v - springs[i].partner.vector(field_v);
      if constexpr (viscosity == Viscosity::by_material)
        springs[i].relaxation_time = robot_.relaxation_time_of(records[i]);
    }
#pragma unroll
    for (int i = 0; i < count; ++i) {
      const LoadedSpring& spring = springs[i];
      const float squared = squared_length(spring.d);
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

  __device__ LoadedSpring load(const SpringRecord& record, const Owner& owner) const {
    LoadedSpring spring;
    spring.partner = robot_.partner_of(record);
    spring.scaled_rest_length = robot_.scaled_rest_length_of(record);
    spring.d = owner.x - spring.partner.vector(field_x);
    spring.parameters = robot_.parameters_of(record);
    if constexpr (solver == Solver::xpbd) spring.valence = owner.valence + partner_valence(record, spring.partner);
    return spring;
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
      return robot_.load_valence(slot_at_offset(record.x >> 16, Robot::fields));
  }

  const Robot& robot_;
};

}  // namespace mercury::cuda
