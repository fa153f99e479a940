// SPDX-License-Identifier: Apache-2.0
#include "robots/muscle_fields.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "mercury/error.h"
#include "mercury/muscle_laws.h"
#include "mercury/random.h"
#include "robots/mutation_step.h"
#include "robots/portable_math.h"

namespace mercury {
namespace {

double bounded(double output) { return std::clamp(output, -1., 1.); }

// A value as a point: distances say how unlike two are. A factor of two in stiffness counts as much as half of the
// largest amplitude.
using Point = std::array<double, 3>;

class ValueCloud {
 public:
  explicit ValueCloud(std::span<const FieldValue> values) {
    double largest = 0;
    for (const FieldValue& value : values)
      largest = std::max(largest, std::sqrt(value.cosine * value.cosine + value.sine * value.sine));
    const double scale = largest > 0 ? 1 / largest : 0;
    for (const FieldValue& value : values)
      points_.push_back({scale * value.cosine, scale * value.sine,
                         0.5 * portable_log(std::max(value.stiffness, 1e-300)) / std::numbers::ln2});
  }
  const Point& operator[](std::uint32_t value) const { return points_[value]; }

 private:
  std::vector<Point> points_;
};

// Values that share a material.
struct Part {
  std::vector<std::uint32_t> values;
  double spread = 0;  // sum of squared distances from the mean along the widest axis
  std::size_t axis = 0;
  double mean = 0;  // along that axis

  Part(std::vector<std::uint32_t> members, const ValueCloud& cloud) : values(std::move(members)) {
    for (std::size_t along = 0; along < 3; ++along) {
      double sum = 0, squares = 0, low = cloud[values.front()][along], high = low;
      for (const std::uint32_t value : values) {
        sum += cloud[value][along];
        low = std::min(low, cloud[value][along]);
        high = std::max(high, cloud[value][along]);
      }
      const double middle = sum / static_cast<double>(values.size());
      for (const std::uint32_t value : values)
        squares += (cloud[value][along] - middle) * (cloud[value][along] - middle);
      if (!(low < high) || !(squares > spread)) continue;
      spread = squares;
      axis = along;
      mean = std::clamp(middle, std::nextafter(low, high), high);  // some are below, some are not
    }
  }
};

FieldValue mean_of(const std::vector<std::uint32_t>& members, std::span<const FieldValue> values) {
  FieldValue mean{.frequency = values[members.front()].frequency};
  if (std::ranges::all_of(members, [&](std::uint32_t value) { return values[value] == values[members.front()]; }))
    return values[members.front()];
  for (const std::uint32_t value : members) {
    mean.stiffness += values[value].stiffness;
    mean.cosine += values[value].cosine;
    mean.sine += values[value].sine;
  }
  const auto count = static_cast<double>(members.size());
  mean.stiffness /= count;
  mean.cosine /= count;
  mean.sine /= count;
  return mean;
}

}  // namespace

FieldValue field_value(MaterialId kind, const FieldOutputs& outputs, const FieldMuscles& muscles) {
  const Material& base = default_materials()[kind];
  FieldValue value{.stiffness = static_cast<double>(base.stiffness) *
                                portable_exp(bounded(outputs.stiffness) * std::numbers::ln2)};
  if (kind > muscle_count) return value;
  const double amplitude = static_cast<double>(muscles.amplitude) * (bounded(outputs.amplitude) + 1) / 2;
  const SineCosine direction = wave(outputs.phase - std::floor(outputs.phase));
  value.cosine = amplitude * direction.cosine;
  value.sine = amplitude * direction.sine;
  if (value.moves() && muscles.frequencies > 1 && outputs.frequency >= 0) value.frequency = 1;
  return value;
}

FieldValue mean_value(std::span<const FieldValue> values) {
  std::array<FieldValue, max_field_frequencies> waves{};
  double stiffness = 0;
  for (const FieldValue& value : values) {
    stiffness += value.stiffness;
    FieldValue& wave = waves[static_cast<std::size_t>(value.frequency)];
    wave.cosine += value.cosine;
    wave.sine += value.sine;
  }
  const auto size = [](const FieldValue& value) { return value.cosine * value.cosine + value.sine * value.sine; };
  const int chosen = size(waves[1]) > size(waves[0]) ? 1 : 0;
  const FieldValue& wave = waves[static_cast<std::size_t>(chosen)];
  const auto count = static_cast<double>(values.size());
  return {.stiffness = stiffness / count,
          .cosine = wave.cosine / count,
          .sine = wave.sine / count,
          .frequency = wave.moves() ? chosen : 0};
}

FieldPalette palette_of(std::span<const FieldValue> values, std::size_t most) {
  const ValueCloud cloud(values);
  // Values at rest and those of each frequency never share one.
  std::array<std::vector<std::uint32_t>, 1 + max_field_frequencies> groups;
  for (std::uint32_t value = 0; value < values.size(); ++value)
    groups[values[value].moves() ? 1 + static_cast<std::size_t>(values[value].frequency) : 0].push_back(value);
  std::vector<Part> parts;
  for (std::vector<std::uint32_t>& group : groups)
    if (!group.empty()) parts.emplace_back(std::move(group), cloud);
  while (!parts.empty() && parts.size() < most) {
    const auto widest = std::ranges::max_element(parts, {}, &Part::spread);
    if (widest->spread == 0) break;
    std::vector<std::uint32_t> low, high;
    for (const std::uint32_t value : widest->values)
      (cloud[value][widest->axis] < widest->mean ? low : high).push_back(value);
    *widest = Part(std::move(low), cloud);
    parts.emplace_back(std::move(high), cloud);
  }
  FieldPalette palette{.values = {}, .of = std::vector<std::uint8_t>(values.size())};
  for (const Part& part : parts) {
    for (const std::uint32_t value : part.values) palette.of[value] = static_cast<std::uint8_t>(palette.values.size());
    palette.values.push_back(mean_of(part.values, values));
  }
  return palette;
}

FieldTable table_of(std::span<const FieldValue> values, const FieldMuscles& muscles) {
  FieldTable table{.materials = {Material{}}, .names = {"air"}};
  int moving = 0, resting = 0;
  for (const FieldValue& value : values) {
    Material material{.stiffness = static_cast<float>(value.stiffness)};
    if (value.moves()) {
      const int of = muscles.frequencies - value.frequency;  // 1 for the highest
      material.amplitude = static_cast<float>(std::sqrt(value.cosine * value.cosine + value.sine * value.sine));
      material.frequency = muscles.frequency / static_cast<float>(of);
      material.phase = static_cast<float>(2 * std::numbers::pi * turns_of({value.sine, value.cosine}));
    }
    table.materials.push_back(material);
    table.names.push_back(value.moves() ? "muscle " + std::to_string(++moving) : "tissue " + std::to_string(++resting));
  }
  return table;
}

void move_muscles(float& frequency, float& amplitude, double strength, std::uint64_t seed, int tail) {
  if (!(std::isfinite(strength) && strength >= 0)) throw ParameterError("strength", "give a number of at least 0");
  if (strength == 0) return;
  Random random(seed);
  const std::pair before(frequency, amplitude);
  const auto move = [&](float& value, double size, float highest) {
    const double moved = value + std::min(strength, 1e6) * size * step_number(random, tail);
    value = static_cast<float>(tail == 0 ? std::clamp(std::abs(moved), 0., static_cast<double>(highest))
                                         : reflected(moved, 0, static_cast<double>(highest)));
  };
  const std::uint64_t choice = random.below(3);
  if (choice != 0) move(frequency, 0.5, max_muscle_frequency);
  if (choice != 1) move(amplitude, 0.02, max_muscle_amplitude);
  if (std::pair(frequency, amplitude) == before) amplitude = std::nextafter(amplitude, max_muscle_amplitude / 2);
}

}  // namespace mercury
