// SPDX-License-Identifier: Apache-2.0
// All springs of a body, slot by slot (spring_plan.h).
#pragma once

#include "sim/cpu/arrays.h"

HWY_BEFORE_NAMESPACE();
namespace mercury::cpu::HWY_NAMESPACE {

// A slot's springs between owners and partners, by either solver (xpbd_stiffness()).
template <bool checked>
struct SlotLaw {
  const float* factors;
  const float* rest_length;
  const float* hardness;
  const FactorId* factor;
  Lanes longest;

  // The contribution to the partners in units, plus rounding_magic_bits. `d` points from partner to owner.
  HWY_INLINE Integers3 operator()(Lanes3 d) {
    const Lanes squared = squared_length(d);
    const Lanes rest = load_aligned(rest_length);
    const Mask real = rest > 0.0f;
    if constexpr (checked) longest = select((squared > longest) & real, squared, longest);
    const Lanes length = rest * look_up(factors, factor, real);
    const Lanes per_distance = hooke(squared, length, load_aligned(hardness));
    rest_length += lane_count;
    hardness += lane_count;
    factor += lane_count;
    return {to_fixed_plus_magic(per_distance, d.x), to_fixed_plus_magic(per_distance, d.y),
            to_fixed_plus_magic(per_distance, d.z)};
  }
};

// Adds all springs' contributions to the sums. False if one is beyond the stretch limit, which only `checked` finds.
//
// Calls finish(place) for each block of which it has all contributions and needs the positions no more: in order and
// one block behind, so that what was added to it has arrived in the cache. With rows, whose partners stand anywhere,
// that is for all blocks at the end; so it is when the springs must all be checked before anything may move.
template <bool checked, bool spring_rows, class Finish>
bool add_springs(Body& body, const float* factors, const Finish& finish) {
  constexpr bool finish_early = !checked && !spring_rows;
  const Arrays arrays(body);
  const SpringPlan& plan = body.springs;
  SlotLaw<checked> law{factors, plan.rest_length.data(), plan.hardness.data(), plan.factor.data(), 0.0f};
  const Run* run = plan.runs.data();
  const std::uint32_t* partners = plan.partners.data();
  std::size_t place = 0;
  for (const auto& [runs, rows] : plan.blocks) {
    const Lanes3 own = load_aligned(arrays.x, place);
    Integers3 sum{no_integers(), no_integers(), no_integers()};
    for (const Run* const end = run + runs; run != end; ++run) {
      const auto [partner, reaction] = *run;
      const Integers3 f = law(own - load(arrays.x, partner));
      sum = sum - f;
      add(f, arrays.reaction, reaction);
    }
    for (const std::uint32_t* const end = partners + (spring_rows ? rows * lane_count : 0); partners != end;
         partners += lane_count) {
      const Integers3 f = law(own - vectors(collect(arrays.x_rows, partners)));
      sum = sum - f;
      add_to_rows(f, arrays.row_sums, partners);
    }
    store_aligned(sum, arrays.own, place);
    if (finish_early && place > 0) finish(place - lane_count);
    place += lane_count;
  }
  if constexpr (finish_early) {
    finish(place - lane_count);
    return true;
  }
  if (checked && !(largest(law.longest) <= body.measures.squared_stretch_limit())) return false;
  for (std::size_t block = 0; block < place; block += lane_count) finish(block);
  return true;
}

}  // namespace mercury::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
