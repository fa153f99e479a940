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

// A law as a point: distances say how unlike two are. A factor of two in stiffness counts as much as half of the
// largest amplitude.
using Point = std::array<double, 3>;

class LawCloud {
 public:
  explicit LawCloud(std::span<const MuscleLaw> laws) {
    double largest = 0;
    for (const MuscleLaw& law : laws)
      largest = std::max(largest, std::sqrt(law.cosine * law.cosine + law.sine * law.sine));
    const double scale = largest > 0 ? 1 / largest : 0;
    for (const MuscleLaw& law : laws)
      points_.push_back({scale * law.cosine, scale * law.sine,
                         0.5 * portable_log(std::max(law.stiffness, 1e-300)) / std::numbers::ln2});
  }
  const Point& operator[](std::uint32_t law) const { return points_[law]; }

 private:
  std::vector<Point> points_;
};

// Laws that share a material.
struct Part {
  std::vector<std::uint32_t> laws;
  double spread = 0;  // sum of squared distances from the mean along the widest axis
  std::size_t axis = 0;
  double mean = 0;  // along that axis

  Part(std::vector<std::uint32_t> members, const LawCloud& cloud) : laws(std::move(members)) {
    for (std::size_t along = 0; along < 3; ++along) {
      double sum = 0, squares = 0, low = cloud[laws.front()][along], high = low;
      for (const std::uint32_t law : laws) {
        sum += cloud[law][along];
        low = std::min(low, cloud[law][along]);
        high = std::max(high, cloud[law][along]);
      }
      const double middle = sum / static_cast<double>(laws.size());
      for (const std::uint32_t law : laws) squares += (cloud[law][along] - middle) * (cloud[law][along] - middle);
      if (!(low < high) || !(squares > spread)) continue;
      spread = squares;
      axis = along;
      mean = std::clamp(middle, std::nextafter(low, high), high);  // some are below, some are not
    }
  }
};

MuscleLaw mean_of(const std::vector<std::uint32_t>& members, std::span<const MuscleLaw> laws) {
  MuscleLaw mean{.frequency = laws[members.front()].frequency};
  if (std::ranges::all_of(members, [&](std::uint32_t law) { return laws[law] == laws[members.front()]; }))
    return laws[members.front()];
  for (const std::uint32_t law : members) {
    mean.stiffness += laws[law].stiffness;
    mean.cosine += laws[law].cosine;
    mean.sine += laws[law].sine;
  }
  const auto count = static_cast<double>(members.size());
  mean.stiffness /= count;
  mean.cosine /= count;
  mean.sine /= count;
  return mean;
}

}  // namespace

MuscleLaw law_of(MaterialId kind, const FieldOutputs& outputs, const FieldMuscles& muscles) {
  const Material& base = default_materials()[kind];
  MuscleLaw law{.stiffness =
                    static_cast<double>(base.stiffness) * portable_exp(bounded(outputs.stiffness) * std::numbers::ln2)};
  if (kind > muscle_count) return law;
  const double amplitude = static_cast<double>(muscles.amplitude) * (bounded(outputs.amplitude) + 1) / 2;
  const SineCosine direction = wave(outputs.phase - std::floor(outputs.phase));
  law.cosine = amplitude * direction.cosine;
  law.sine = amplitude * direction.sine;
  if (law.moves() && muscles.frequencies > 1 && outputs.frequency >= 0) law.frequency = 1;
  return law;
}

MuscleLaw mean_law(std::span<const MuscleLaw> laws) {
  std::array<MuscleLaw, max_field_frequencies> waves{};
  double stiffness = 0;
  for (const MuscleLaw& law : laws) {
    stiffness += law.stiffness;
    MuscleLaw& wave = waves[static_cast<std::size_t>(law.frequency)];
    wave.cosine += law.cosine;
    wave.sine += law.sine;
  }
  const auto size = [](const MuscleLaw& law) { return law.cosine * law.cosine + law.sine * law.sine; };
  const int chosen = size(waves[1]) > size(waves[0]) ? 1 : 0;
  const MuscleLaw& wave = waves[static_cast<std::size_t>(chosen)];
  const auto count = static_cast<double>(laws.size());
  return {.stiffness = stiffness / count,
          .cosine = wave.cosine / count,
          .sine = wave.sine / count,
          .frequency = wave.moves() ? chosen : 0};
}

LawPalette palette_of(std::span<const MuscleLaw> laws, std::size_t most) {
  const LawCloud cloud(laws);
  // Laws at rest and those of each frequency never share one.
  std::array<std::vector<std::uint32_t>, 1 + max_field_frequencies> groups;
  for (std::uint32_t law = 0; law < laws.size(); ++law)
    groups[laws[law].moves() ? 1 + static_cast<std::size_t>(laws[law].frequency) : 0].push_back(law);
  std::vector<Part> parts;
  for (std::vector<std::uint32_t>& group : groups)
    if (!group.empty()) parts.emplace_back(std::move(group), cloud);
  while (!parts.empty() && parts.size() < most) {
    const auto widest = std::ranges::max_element(parts, {}, &Part::spread);
    if (widest->spread == 0) break;
    std::vector<std::uint32_t> low, high;
    for (const std::uint32_t law : widest->laws) (cloud[law][widest->axis] < widest->mean ? low : high).push_back(law);
    *widest = Part(std::move(low), cloud);
    parts.emplace_back(std::move(high), cloud);
  }
  LawPalette palette{.laws = {}, .of = std::vector<std::uint8_t>(laws.size())};
  for (const Part& part : parts) {
    for (const std::uint32_t law : part.laws) palette.of[law] = static_cast<std::uint8_t>(palette.laws.size());
    palette.laws.push_back(mean_of(part.laws, laws));
  }
  return palette;
}

FieldTable table_of(std::span<const MuscleLaw> laws, const FieldMuscles& muscles) {
  FieldTable table{.materials = {Material{}}, .names = {"air"}};
  int moving = 0, resting = 0;
  for (const MuscleLaw& law : laws) {
    Material material{.stiffness = static_cast<float>(law.stiffness)};
    if (law.moves()) {
      const int of = muscles.frequencies - law.frequency;  // 1 for the highest
      material.amplitude = static_cast<float>(std::sqrt(law.cosine * law.cosine + law.sine * law.sine));
      material.frequency = muscles.frequency / static_cast<float>(of);
      material.phase = static_cast<float>(2 * std::numbers::pi * turns_of({law.sine, law.cosine}));
    }
    table.materials.push_back(material);
    table.names.push_back(law.moves() ? "muscle " + std::to_string(++moving) : "tissue " + std::to_string(++resting));
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
