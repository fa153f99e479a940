// SPDX-License-Identifier: Apache-2.0
#include "robots/importers/substances.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <complex>
#include <limits>
#include <numeric>
#include <optional>
#include <unordered_map>
#include <utility>

#include "mercury/fnv.h"

namespace mercury {
namespace {

bool moves(const Substance& substance) { return substance.amplitude != 0; }

// The amplitude times exp(i phase).
std::complex<double> movement_of(const Substance& substance) {
  return substance.amplitude * std::polar(1.0, substance.phase);
}

double wrapped(double phase) { return phase - turn * std::floor(phase / turn); }

using Key = std::array<std::int64_t, 7>;

struct KeyHash {
  std::size_t operator()(const Key& key) const {
    Fnv1a hash;
    for (const std::int64_t part : key) hash.step(static_cast<std::uint64_t>(part));
    return static_cast<std::size_t>(hash.value() ^ hash.value() >> 32);
  }
};

// Divides a range into steps. Of a range without extent all values are in one step.
class Steps {
 public:
  void include(double value) {
    lowest_ = std::min(lowest_, value);
    highest_ = std::max(highest_, value);
  }
  std::int64_t step(double value, int steps) const {
    const double range = highest_ - lowest_;
    return range > 0 ? std::llround((value - lowest_) / range * steps) : 0;
  }

 private:
  double lowest_ = std::numeric_limits<double>::infinity(), highest_ = -lowest_;
};

std::int64_t bits(double value) {
  return static_cast<std::int64_t>(std::bit_cast<std::uint32_t>(static_cast<float>(value)));
}

double log_of(double value) { return std::log(std::max(value, 1e-30)); }

class Grouping {
 public:
  explicit Grouping(std::span<const Substance> substances) : substances_(substances) {
    for (const Substance& substance : substances) {
      stiffness_.include(log_of(substance.stiffness));
      size_.include(substance.size);
      if (!moves(substance)) continue;
      amplitude_.include(std::abs(substance.amplitude));
      frequency_.include(log_of(substance.frequency));
    }
  }

  SubstanceGroups exact() const {
    return *groups(substances_.size() + 1, [](const Substance& substance) {
      const Material material = material_of(substance);
      return Key{bits(material.stiffness),      bits(material.amplitude), bits(material.frequency),
                 bits(material.phase),          substance.half_wave,      bits(substance.size),
                 bits(material.relaxation_time)};
    });
  }

  // The phase has twice as many steps, around the turn, and the stiffness four times as many: robots have few
  // stiffnesses, by kind of spring and number of voxels that share it, and these lie far apart.
  std::optional<SubstanceGroups> rounded(int steps, std::size_t most) const {
    std::optional<SubstanceGroups> found = groups(most, [&](const Substance& substance) {
      const bool is_muscle = moves(substance);
      const std::int64_t around = std::max(1, 2 * steps);
      // A negative amplitude is a positive one half a turn later, except that a half wave acts in the other half.
      const double half_turn = substance.amplitude < 0 && !substance.half_wave ? turn / 2 : 0;
      const std::int64_t phase =
          std::llround(wrapped(substance.phase + half_turn) / turn * static_cast<double>(around)) % around;
      return Key{stiffness_.step(log_of(substance.stiffness), 4 * steps),
                 is_muscle ? 1 + amplitude_.step(std::abs(substance.amplitude), steps) : 0,
                 is_muscle ? frequency_.step(log_of(substance.frequency), steps) : 0,
                 is_muscle ? phase : 0,
                 substance.half_wave ? (substance.amplitude < 0 ? 2 : 1) : 0,
                 size_.step(substance.size, steps),
                 bits(substance.relaxation_time)};
    });
    if (!found) return found;
    found->rounding.steps = std::max(1, steps);
    measure(*found);
    return found;
  }

 private:
  // Nothing if there are more than `most` groups.
  template <class KeyOf>
  std::optional<SubstanceGroups> groups(std::size_t most, const KeyOf& key_of) const {
    SubstanceGroups found;
    std::unordered_map<Key, std::size_t, KeyHash> known;
    std::vector<std::vector<Substance>> members;
    for (const Substance& substance : substances_) {
      const auto [place, is_new] = known.try_emplace(key_of(substance), members.size());
      if (is_new && members.size() == most) return std::nullopt;
      if (is_new) members.emplace_back();
      members[place->second].push_back(substance);
      found.group_of.push_back(place->second);
    }
    for (const std::vector<Substance>& group : members) found.substances.push_back(mean_substance(group));
    return found;
  }

  void measure(SubstanceGroups& found) const {
    Rounding& rounding = found.rounding;
    const auto raise = [](double& most, double value) { most = std::max(most, std::abs(value)); };
    for (std::size_t i = 0; i < substances_.size(); ++i) {
      const Substance &exact = substances_[i], &used = found.substances[found.group_of[i]];
      raise(rounding.stiffness, used.stiffness / std::max(exact.stiffness, 1e-30) - 1);
      raise(rounding.amplitude, std::abs(used.amplitude) - std::abs(exact.amplitude));
      if (!moves(exact) || !moves(used)) continue;
      raise(rounding.phase, std::arg(movement_of(used) * std::conj(movement_of(exact))));
      raise(rounding.frequency, used.frequency / exact.frequency - 1);
    }
  }

  std::span<const Substance> substances_;
  Steps stiffness_, amplitude_, frequency_, size_;
};

}  // namespace

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

SubstanceGroups grouped(std::span<const Substance> substances, std::size_t most) {
  const Grouping grouping(substances);
  SubstanceGroups found = grouping.exact();
  const std::size_t distinct = found.substances.size();
  std::optional<SubstanceGroups> rounded;
  for (double steps = 1024; distinct > most && !rounded; steps *= 0.9)
    rounded = grouping.rounded(static_cast<int>(steps), steps < 1 ? distinct : most);
  if (rounded) found = *std::move(rounded);
  found.rounding.substances = distinct;
  found.rounding.groups = found.substances.size();
  return found;
}

}  // namespace mercury
