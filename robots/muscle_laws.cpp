// SPDX-License-Identifier: Apache-2.0
#include "mercury/muscle_laws.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>

#include "mercury/error.h"
#include "mercury/random.h"
#include "robots/mutation_step.h"

namespace mercury {
namespace {

constexpr double share = 0.25, own_share = 0.025;                                // of the numbers that a mutation moves
constexpr double amplitude_step = 0.04, frequency_step = 0.5, phase_step = 0.4;  // [1], [rad/s], [rad]

bool is_muscle(const Material& material) { return material.amplitude != 0; }

// What a search may give a muscle: beyond the limits only where it was from the start.
struct Range {
  double lowest, highest;
};
Range amplitudes_of(const Material& muscle) {
  const double strongest = std::max(max_muscle_amplitude, std::abs(muscle.amplitude));
  return {-strongest, strongest};
}
Range frequencies_of(const Material& muscle) {
  return {std::min(0.f, muscle.frequency), std::max(max_muscle_frequency, muscle.frequency)};
}

// Mirrors a value that left the range at the end that it crossed, so that muscles do not gather there.
double folded(double value, double lowest, double highest) {
  if (value < lowest) value = 2 * lowest - value;
  if (value > highest) value = 2 * highest - value;
  return std::clamp(value, lowest, highest);
}

// In [0, 2 pi) also as a float: that of 2 pi itself is above it.
float wrapped_phase(double phase) {
  constexpr double turn = 2 * std::numbers::pi;
  const auto wrapped = static_cast<float>(phase - turn * std::floor(phase / turn));
  return wrapped >= std::numbers::pi_v<float> * 2 ? 0 : wrapped;
}

std::vector<Material> moved(std::span<const Material> bases, double strength, std::uint64_t seed, int tail) {
  Random random(seed);
  const auto step = [&](double chance, double size) {
    const bool moves = random.chance(chance);
    return moves ? strength * size * step_number(random, tail) : 0;
  };
  const auto within = [&](double value, Range range) {
    return static_cast<float>(tail == 0 ? folded(value, range.lowest, range.highest)
                                        : reflected(value, range.lowest, range.highest));
  };
  std::vector<Material> materials(bases.begin(), bases.end());
  std::map<float, double> together;  // steps by frequency
  for (Material& material : materials) {
    if (!is_muscle(material)) continue;
    const auto [of_frequency, is_first] = together.try_emplace(material.frequency, 0);
    if (is_first) of_frequency->second = step(share, frequency_step);
    const double by_frequency = of_frequency->second + step(own_share, frequency_step);
    const double by_amplitude = step(share, amplitude_step), by_phase = step(share, phase_step);
    const Range amplitudes = amplitudes_of(material), frequencies = frequencies_of(material);
    if (by_amplitude != 0) material.amplitude = within(material.amplitude + by_amplitude, amplitudes);
    if (by_frequency != 0) material.frequency = within(material.frequency + by_frequency, frequencies);
    if (by_phase != 0) material.phase = wrapped_phase(material.phase + by_phase);
  }
  return materials;
}

}  // namespace

bool has_base_materials(const Robot& robot) {
  if (robot.materials.empty()) return true;
  if (robot.materials.size() != default_material_count || robot.materials[air] != Material{}) return false;
  return std::ranges::equal(material_table(std::span(robot.materials).subspan<1, base_material_count>()),
                            robot.materials);
}

std::vector<Material> base_materials_of(const Robot& robot) {
  const std::span<const Material> table = materials_of(robot);
  const std::size_t count = has_base_materials(robot) ? base_material_count : table.size() - 1;
  return {table.begin() + 1, table.begin() + 1 + static_cast<std::ptrdiff_t>(count)};
}

std::vector<bool> base_materials_in_use(const Robot& robot) {
  const bool paired = has_base_materials(robot);
  std::vector<bool> used(materials_of(robot).size(), false);
  for (const Spring& spring : robot.springs) used[spring.material] = true;
  if (paired)
    for (std::size_t id = base_material_count + 1; id < used.size(); ++id) {
      if (!used[id]) continue;
      const auto [first, second] = base_materials_of(static_cast<MaterialId>(id));
      used[first] = used[second] = true;
    }
  used.erase(used.begin());
  if (paired) used.resize(base_material_count);
  return used;
}

Robot with_base_materials(Robot robot, std::span<const Material> bases) {
  const std::size_t expected = base_materials_of(robot).size();
  if (bases.size() != expected)
    throw InputError("robot " + robot.name,
                     "needs " + std::to_string(expected) + " base materials, not " + std::to_string(bases.size()));
  for (std::size_t i = 0; i < bases.size(); ++i) validate(bases[i], "base material " + std::to_string(i + 1));
  if (!has_base_materials(robot)) {
    std::ranges::copy(bases, robot.materials.begin() + 1);
    return robot;
  }
  robot.materials = material_table(bases.first<base_material_count>());
  if (robot.material_names.empty() && std::ranges::equal(robot.materials, default_materials())) robot.materials.clear();
  return robot;
}

std::vector<Material> mutate_muscle_laws(std::span<const Material> bases, double strength, std::uint64_t seed,
                                         const std::vector<bool>& in_use, int tail) {
  if (!(std::isfinite(strength) && strength >= 0)) throw ParameterError("muscles", "give a strength of 0 or more");
  std::vector<Material> materials(bases.begin(), bases.end());
  const auto counts = [&](std::size_t i) {
    return is_muscle(bases[i]) && (in_use.empty() || (i < in_use.size() && in_use[i]));
  };
  const auto changed = [&] {
    for (std::size_t i = 0; i < materials.size(); ++i)
      if (counts(i) && materials[i] != bases[i]) return true;
    return false;
  };
  std::vector<std::size_t> muscles;
  for (std::size_t i = 0; i < bases.size(); ++i)
    if (counts(i)) muscles.push_back(i);
  if (strength == 0) return materials;
  constexpr int attempts = 100;
  for (int attempt = 0; attempt < attempts; ++attempt) {
    materials = moved(bases, strength, attempt == 0 ? seed : seed_of(seed, static_cast<std::uint64_t>(attempt)), tail);
    if (muscles.empty() || changed()) return materials;
  }
  // Steps below the precision of a float.
  Material& material = materials[muscles[Random(seed).below(muscles.size())]];
  material.amplitude = std::nextafter(material.amplitude, 0.f);
  return materials;
}

namespace {

// Muscles in use, and those of them that are the first of their frequency.
struct MuscleList {
  std::vector<std::size_t> muscles, firsts;

  MuscleList(std::span<const Material> bases, const std::vector<bool>& in_use) {
    for (std::size_t i = 0; i < bases.size(); ++i) {
      if (!is_muscle(bases[i]) || !(in_use.empty() || (i < in_use.size() && in_use[i]))) continue;
      muscles.push_back(i);
      const auto same = [&](std::size_t first) { return bases[first].frequency == bases[i].frequency; };
      if (std::ranges::none_of(firsts, same)) firsts.push_back(i);
    }
  }
};

}  // namespace

std::vector<double> muscle_numbers(std::span<const Material> bases, const std::vector<bool>& in_use,
                                   std::span<const Material> like) {
  const MuscleList list(bases, in_use);
  std::vector<double> numbers;
  for (const std::size_t i : list.firsts) {
    const Range range = frequencies_of(bases[i]);
    numbers.push_back(unbounded(like[i].frequency, range.lowest, range.highest) / frequency_step);
  }
  for (const std::size_t i : list.muscles) {
    const Range range = amplitudes_of(bases[i]);
    numbers.push_back(unbounded(like[i].amplitude, range.lowest, range.highest) / amplitude_step);
    numbers.push_back(like[i].phase / phase_step);
  }
  return numbers;
}

std::vector<Material> with_muscle_numbers(std::span<const Material> bases, const std::vector<bool>& in_use,
                                          std::span<const double> numbers) {
  const MuscleList list(bases, in_use);
  if (numbers.size() != list.firsts.size() + 2 * list.muscles.size())
    throw InputError("muscles", std::to_string(numbers.size()) + " numbers do not fit");
  std::vector<Material> materials(bases.begin(), bases.end());
  const auto value = [](double number, double step, Range range) {
    return static_cast<float>(bounded(number * step, range.lowest, range.highest));
  };
  std::map<float, float> frequencies;
  const double* number = numbers.data();
  for (const std::size_t i : list.firsts)
    frequencies[bases[i].frequency] = value(*number++, frequency_step, frequencies_of(bases[i]));
  for (const std::size_t i : list.muscles) {
    materials[i].frequency = frequencies.at(bases[i].frequency);
    materials[i].amplitude = value(*number++, amplitude_step, amplitudes_of(bases[i]));
    materials[i].phase = std::max(0.f, wrapped_phase(*number++ * phase_step));  // rounding of huge numbers
  }
  return materials;
}

std::vector<Material> cross_muscle_laws(std::span<const Material> a, std::span<const Material> b, std::uint64_t seed) {
  if (a.size() != b.size())
    throw InputError("crossover", "two robots with the same number of materials are needed, not " +
                                      std::to_string(a.size()) + " and " + std::to_string(b.size()));
  Random random(seed);
  std::vector<Material> materials(a.begin(), a.end());
  for (std::size_t i = 0; i < materials.size(); ++i)
    if (random.chance(0.5)) materials[i] = b[i];
  return materials;
}

Robot with_mutated_muscles(Robot robot, double strength, std::uint64_t seed) {
  const std::vector<Material> materials =
      mutate_muscle_laws(base_materials_of(robot), strength, seed, base_materials_in_use(robot));
  return with_base_materials(std::move(robot), materials);
}

Robot with_crossed_muscles(Robot a, const Robot& b, std::uint64_t seed) {
  if (!has_base_materials(a) || !has_base_materials(b)) return a;
  const std::vector<Material> materials = cross_muscle_laws(base_materials_of(a), base_materials_of(b), seed);
  return with_base_materials(std::move(a), materials);
}

}  // namespace mercury
