// SPDX-License-Identifier: Apache-2.0
#include "robots/importers/substances.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>

namespace mercury {
namespace {

double wrapped(double phase) { return phase - turn * std::floor(phase / turn); }

}  // namespace

std::complex<double> movement_of(const Substance& substance) {
  return substance.amplitude * std::polar(1.0, substance.phase);
}

Substance substance_of(const Material& material) {
  if (material.amplitude == 0) return {.stiffness = material.stiffness};
  return {.stiffness = material.stiffness,
          .amplitude = material.amplitude,
          .frequency = material.frequency,
          .phase = material.phase,
          .half_wave = material.half_wave};
}

Material material_of(const Substance& substance) {
  Material material{.stiffness = static_cast<float>(substance.stiffness)};
  material.relaxation_time = static_cast<float>(substance.relaxation_time);
  if (!moves(substance)) return material;
  material.amplitude = static_cast<float>(substance.amplitude);
  material.frequency = static_cast<float>(substance.frequency);
  material.phase = static_cast<float>(substance.phase);
  material.half_wave = substance.half_wave;
  return material;
}

Substance mean_substance(std::span<const Substance> substances, std::span<const double> weights) {
  // The mean of equal numbers may differ from them in the last bit.
  if (std::ranges::all_of(substances, [&](const Substance& substance) { return substance == substances.front(); }))
    return substances.front();
  Substance mean{.size = 0};
  std::complex<double> movement, phases;
  double moving = 0;
  const double total =
      weights.empty() ? static_cast<double>(substances.size()) : std::accumulate(weights.begin(), weights.end(), 0.0);
  for (std::size_t i = 0; i < substances.size(); ++i) {
    const Substance& substance = substances[i];
    const double weight = weights.empty() ? 1 : weights[i];
    mean.stiffness += weight * substance.stiffness / total;
    mean.size += weight * substance.size / total;
    mean.relaxation_time += weight * substance.relaxation_time / total;
    if (!moves(substance)) continue;
    ++moving;
    movement += weight * movement_of(substance) / total;
    phases += weight * std::abs(substance.amplitude) * std::polar(1.0, substance.phase);
    mean.frequency += substance.frequency;
    mean.half_wave = mean.half_wave || substance.half_wave;
  }
  constexpr double none = 1e-9;  // opposite movements cancel but for rounding
  if (std::abs(movement) < none)
    return {.stiffness = mean.stiffness, .size = mean.size, .relaxation_time = mean.relaxation_time};
  // With the sign whose phase is closer to those of the parts: half waves act in one half only.
  const bool is_negative = std::real(movement * std::conj(phases)) < 0;
  mean.amplitude = is_negative ? -std::abs(movement) : std::abs(movement);
  mean.phase = wrapped(std::arg(is_negative ? -movement : movement));
  mean.frequency /= moving;
  return mean;
}

std::string text_of(const Rounding& rounding) {
  std::string text = fmt::format("{} distinct materials were rounded to {}", rounding.substances, rounding.groups);
  constexpr double least = 1e-9;  // what arithmetic leaves
  const char* between = ": ";
  const auto add = [&](const char* what, double value, double factor, const char* unit) {
    if (value < least) return;
    text += fmt::format("{}{} by at most {:.2g}{}", between, what, factor * value, unit);
    between = ", ";
  };
  add("stiffness", rounding.stiffness, 100, " %");
  add("amplitude", rounding.amplitude, 1, "");
  add("phase", rounding.phase, 1, " rad");
  add("frequency", rounding.frequency, 100, " %");
  return text;
}

}  // namespace mercury
