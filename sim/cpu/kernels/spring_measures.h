// SPDX-License-Identifier: Apache-2.0
// Measures springs for telemetry, a row at a time. Sums are in double precision and in the order of the springs, so
// they have the same bits for every instruction set.
#pragma once

#include <algorithm>
#include <bit>
#include <span>

#include "mercury/observables.h"
#include "mercury/robot.h"
#include "sim/cpu/kernels/gather.h"

HWY_BEFORE_NAMESPACE();
namespace mercury::cpu::HWY_NAMESPACE {

inline constexpr hn::Half<decltype(floats)> half_of_row;
inline constexpr hn::Rebind<double, decltype(half_of_row)> doubles;
using Doubles = hn::Vec<decltype(doubles)>;

struct MeasuredEnergies {
  alignas(64) double elastic[lane_count], power[lane_count];

  // Half a row. Stiffness k, stretch |d| - L, rest length and rate of L / L0.
  HWY_INLINE void set(std::size_t first, Doubles stiffness, Doubles stretch, Doubles rest, Doubles rate) {
    const auto force = hn::Mul(stiffness, stretch);                                                // spring_force()
    hn::Store(hn::Mul(hn::Mul(hn::Set(doubles, 0.5), force), stretch), doubles, elastic + first);  // elastic_energy()
    hn::Store(hn::Mul(hn::Mul(hn::Neg(force), rest), rate), doubles, power + first);               // muscle_power()
  }
  HWY_INLINE MeasuredEnergies(Lanes stiffness, Lanes stretch, Lanes rest, Lanes rate) {
    const auto lower = [](Lanes a) HWY_ATTR { return hn::PromoteTo(doubles, hn::LowerHalf(half_of_row, a.v)); };
    const auto upper = [](Lanes a) HWY_ATTR { return hn::PromoteTo(doubles, hn::UpperHalf(half_of_row, a.v)); };
    set(0, lower(stiffness), lower(stretch), lower(rest), lower(rate));
    set(lane_count / 2, upper(stiffness), upper(stretch), upper(rest), upper(rate));
  }
};

// Kernel::measure_springs.
inline SpringMeasures measure_springs(std::span<const Spring> springs, const float* positions, const float* materials) {
  SpringMeasures result;
  Lanes largest_strain = 0.0f;
  alignas(64) std::uint32_t a[lane_count], b[lane_count], material[lane_count];  // four times their numbers
  alignas(64) float rest_length[lane_count];
  Spring last[lane_count];
  for (; !springs.empty(); springs = springs.subspan(std::min(lane_count, springs.size()))) {
    const std::size_t count = std::min(lane_count, springs.size());
    const Spring* row = springs.data();
    if (count < lane_count) {
      std::copy(springs.begin(), springs.end(), last);
      std::fill(last + count, last + lane_count, springs.back());
      row = last;
    }
    for (std::size_t i = 0; i < lane_count; ++i) {
      a[i] = 4u * row[i].a;
      b[i] = 4u * row[i].b;
      material[i] = 4u * row[i].material;
      rest_length[i] = row[i].rest_length;
    }
    const Lanes3 d = components(gather(positions, b) - gather(positions, a));
    const Lanes3 now = components(gather(materials, material));
    const Lanes distance = square_root(d.x * d.x + d.y * d.y + d.z * d.z), rest = load_aligned(rest_length);
    const Lanes strain = absolute((distance - rest) * inverse(rest));          // |strain()|
    largest_strain = select(strain > largest_strain, strain, largest_strain);  // leaves out NaN
    const std::uint32_t of_row = static_cast<std::uint32_t>((1u << count) - 1u);
    result.strained += static_cast<std::uint32_t>(std::popcount(bits_of(strain > strained_limit) & of_row));
    const MeasuredEnergies energies(now.x, fnma(rest, now.y, distance), rest, now.z);  // stretch()
    for (std::size_t i = 0; i < count; ++i) {
      result.elastic_energy += energies.elastic[i];
      result.muscle_power += energies.power[i];
    }
  }
  result.largest_strain = largest(largest_strain);
  return result;
}

}  // namespace mercury::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
