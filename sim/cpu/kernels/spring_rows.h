// SPDX-License-Identifier: Apache-2.0
// Evaluates the springs of a body, row by row (layout/spring_schedule.h).
#pragma once

#include "sim/cpu/kernels/body_arrays.h"
#include "sim/cpu/kernels/factor_table.h"

HWY_BEFORE_NAMESPACE();
namespace mercury::cpu::HWY_NAMESPACE {

// Reads the springs of one row after the other. The same equation serves both solvers: XPBD's stiffness is
// xpbd_stiffness().
template <bool checked, bool viscous>
struct SpringRow {
  FactorTable factors;
  const float* rest_length;
  const float* stiffness;
  const float* relaxation_time;  // if `viscous`
  const FactorId* factor;
  Lanes highest_rate;     // of length [m/s], if `viscous`
  Lanes longest_squared;  // of all springs so far, if `checked`

  // What the next row's springs add to their partners, in units, plus rounding_magic_bits. `d` points from partner to
  // owner; `rate()` is the difference of their velocities in the same sense, if `viscous`. Moves on to the row after
  // it.
  template <class Rate>
  HWY_INLINE Integers3 operator()(Lanes3 d, const Rate& rate) {
    const Lanes squared = squared_length(d);
    const Lanes rest = load_aligned(rest_length);
    const Mask is_spring = rest > 0.0f;
    if constexpr (checked) longest_squared = select((squared > longest_squared) & is_spring, squared, longest_squared);
    Lanes length = rest * factors.look_up(factor, is_spring);
    if constexpr (viscous) {
      const Lanes length_rate = mercury::length_rate(squared, inner(d, rate()), highest_rate);
      length = viscous_length(length, load_aligned(relaxation_time), length_rate);
      relaxation_time += lane_count;
    }
    const Lanes per_distance = hooke(squared, length, load_aligned(stiffness));
    rest_length += lane_count;
    stiffness += lane_count;
    factor += lane_count;
    return {to_fixed_plus_magic(per_distance, d.x), to_fixed_plus_magic(per_distance, d.y),
            to_fixed_plus_magic(per_distance, d.z)};
  }
};

// Adds all springs' contributions to the sums. If `checked`, returns false if a spring is beyond the stretch limit.
//
// Calls finish(first slot) once for each tile whose sums are complete and whose positions no spring reads any more.
// That is one tile after the springs, so that the sums have left the store buffer when they are read. With gathered
// rows, whose partners are in any tile, it is after all springs; so it is if `checked`, since no mass may move before
// all springs have passed.
template <bool checked, bool gathered_springs, bool viscous, class Finish>
bool add_springs(Body& body, StepFactors factors, const Finish& finish) {
  constexpr bool finish_early = !checked && !gathered_springs;
  const BodyArrays arrays(body);
  const SpringSchedule& schedule = body.springs;
  SpringRow<checked, viscous> next_row{FactorTable(factors),
                                       schedule.rest_length.data(),
                                       schedule.stiffness.data(),
                                       schedule.relaxation_time.data(),
                                       schedule.factor.data(),
                                       highest_length_rate(body.measures, body.materials),
                                       0.0f};
  const Run* run = schedule.runs.data();
  const std::uint32_t* partners = schedule.partners.data();
  std::size_t slot = 0;
  for (const auto& [runs, gathered_rows] : schedule.tiles) {
    const Lanes3 own = load_aligned(arrays.x, slot);
    Lanes3 velocity = own;
    if constexpr (viscous) velocity = load_aligned(arrays.v, slot);
    Integers3 sum{zeros(), zeros(), zeros()};
    for (const Run* const end = run + runs; run != end; ++run) {
      const std::uint32_t partner = run->partner;  // clang captures no structured bindings before version 16
      const Integers3 f =
          next_row(own - load(arrays.x, partner), [&]() HWY_ATTR { return velocity - load(arrays.v, partner); });
      sum = sum - f;
      add(f, arrays.reaction, run->reaction);
    }
    for (const std::uint32_t* const end = partners + (gathered_springs ? gathered_rows * lane_count : 0);
         partners != end; partners += lane_count) {
      const Integers3 f = next_row(own - components(gather(arrays.x_aos, partners)),
                                   [&]() HWY_ATTR { return velocity - components(gather(arrays.v_aos, partners)); });
      sum = sum - f;
      scatter_add(f, arrays.scattered, partners);
    }
    store_aligned(sum, arrays.own, slot);
    if (finish_early && slot > 0) finish(slot - lane_count);
    slot += lane_count;
  }
  if constexpr (finish_early) {
    finish(slot - lane_count);
    return true;
  }
  if (checked && !(largest(next_row.longest_squared) <= body.measures.squared_stretch_limit())) return false;
  for (std::size_t first = 0; first < slot; first += lane_count) finish(first);
  return true;
}

}  // namespace mercury::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
