// SPDX-License-Identifier: Apache-2.0
// Materials in double precision, and as few of them as a table holds.
#pragma once

#include <complex>
#include <cstddef>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "mercury/material.h"

namespace mercury {

inline constexpr double turn = 2 * std::numbers::pi;  // [rad]

// A material in double precision, and the size of its voxels.
struct Substance {
  double stiffness = 0;  // [N/m]
  double amplitude = 0;  // [1], of either sign
  double frequency = 0;  // [rad/s]; 0 if it does not move
  double phase = 0;      // [rad]
  bool half_wave = false;
  double size = 1;             // factor of the rest length [1]
  double relaxation_time = 0;  // [s]
  friend bool operator==(const Substance&, const Substance&) = default;
};

inline bool moves(const Substance& substance) { return substance.amplitude != 0; }
// The amplitude times exp(i phase).
std::complex<double> movement_of(const Substance& substance);

Substance substance_of(const Material& material);
Material material_of(const Substance& substance);

// The substance of a spring that voxels of these substances share: the means of stiffness, size and movement as
// vectors, so that its rest length is the mean of the rest lengths that each of them would have, at all times. Voxels
// that do not move lower the amplitude and leave the frequency. Where frequencies differ, which no single material can
// keep, it has their mean.
//
// `weights`: how much each counts, one per substance; empty = all alike.
Substance mean_substance(std::span<const Substance> substances, std::span<const double> weights = {});

// How far rounded substances are from the exact ones, at most.
struct Rounding {
  bool is_exact() const { return groups == substances; }
  std::size_t substances = 0;  // distinct ones before
  std::size_t groups = 0;      // and after
  double stiffness = 0;        // relative
  double amplitude = 0;        // [1]
  double phase = 0;            // [rad]
  double frequency = 0;        // relative
};
std::string text_of(const Rounding& rounding);

// Substances in groups, at most `most` of them (at least 8), each with the mean of its members. Equal substances are in
// one group. If there are too many distinct substances, near ones share a group (substance_groups.cpp).
struct SubstanceGroups {
  std::vector<std::size_t> group_of;  // of each substance
  std::vector<Substance> substances;  // of each group
  Rounding rounding;
};
SubstanceGroups grouped(std::span<const Substance> substances, std::size_t most);

}  // namespace mercury
