// SPDX-License-Identifier: Apache-2.0
#include "mercury/muscle_laws.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>

#include "mercury/error.h"
#include "mercury/random.h"

namespace mercury {
namespace {

constexpr double share = 0.25, own_share = 0.025;  // of the numbers that a mutation moves

bool is_muscle(const Material& material) { return material.amplitude != 0; }

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

std::vector<Material> moved(std::span<const Material> bases, double strength, std::uint64_t seed) {
  Random random(seed);
  const auto step = [&](double chance, double size) {
    const bool moves = random.chance(chance);
    return moves ? strength * size * random.normal() : 0;
  };
  std::vector<Material> laws(bases.begin(), bases.end());
  std::map<float, double> together;  // steps by frequency
  for (Material& law : laws) {
    if (!is_muscle(law)) continue;
    const auto [frequency_step, is_first] = together.try_emplace(law.frequency, 0);
    if (is_first) frequency_step->second = step(share, 0.5);
    const double by_frequency = frequency_step->second + step(own_share, 0.5);
    const double by_amplitude = step(share, 0.04), by_phase = step(share, 0.4);
    const double strongest = std::max(max_muscle_amplitude, std::abs(law.amplitude));
    const double fastest = std::max(max_muscle_frequency, law.frequency), slowest = std::min(0.f, law.frequency);
    if (by_amplitude != 0)
      law.amplitude = static_cast<float>(folded(law.amplitude + by_amplitude, -strongest, strongest));
    if (by_frequency != 0) law.frequency = static_cast<float>(folded(law.frequency + by_frequency, slowest, fastest));
    if (by_phase != 0) law.phase = wrapped_phase(law.phase + by_phase);
  }
  return laws;
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
                                         const std::vector<bool>& in_use) {
  if (!(std::isfinite(strength) && strength >= 0)) throw ParameterError("muscles", "give a strength of 0 or more");
  std::vector<Material> laws(bases.begin(), bases.end());
  const auto counts = [&](std::size_t i) {
    return is_muscle(bases[i]) && (in_use.empty() || (i < in_use.size() && in_use[i]));
  };
  const auto changed = [&] {
    for (std::size_t i = 0; i < laws.size(); ++i)
      if (counts(i) && laws[i] != bases[i]) return true;
    return false;
  };
  std::vector<std::size_t> muscles;
  for (std::size_t i = 0; i < bases.size(); ++i)
    if (counts(i)) muscles.push_back(i);
  if (strength == 0) return laws;
  constexpr int attempts = 100;
  for (int attempt = 0; attempt < attempts; ++attempt) {
    laws = moved(bases, strength, attempt == 0 ? seed : seed_of(seed, static_cast<std::uint64_t>(attempt)));
    if (muscles.empty() || changed()) return laws;
  }
  // Steps below the precision of a float.
  Material& law = laws[muscles[Random(seed).below(muscles.size())]];
  law.amplitude = std::nextafter(law.amplitude, 0.f);
  return laws;
}

std::vector<Material> cross_muscle_laws(std::span<const Material> a, std::span<const Material> b, std::uint64_t seed) {
  if (a.size() != b.size())
    throw InputError("crossover", "two robots with the same number of materials are needed, not " +
                                      std::to_string(a.size()) + " and " + std::to_string(b.size()));
  Random random(seed);
  std::vector<Material> laws(a.begin(), a.end());
  for (std::size_t i = 0; i < laws.size(); ++i)
    if (random.chance(0.5)) laws[i] = b[i];
  return laws;
}

Robot with_mutated_muscles(Robot robot, double strength, std::uint64_t seed) {
  const std::vector<Material> laws =
      mutate_muscle_laws(base_materials_of(robot), strength, seed, base_materials_in_use(robot));
  return with_base_materials(std::move(robot), laws);
}

Robot with_crossed_muscles(Robot a, const Robot& b, std::uint64_t seed) {
  if (!has_base_materials(a) || !has_base_materials(b)) return a;
  const std::vector<Material> laws = cross_muscle_laws(base_materials_of(a), base_materials_of(b), seed);
  return with_base_materials(std::move(a), laws);
}

}  // namespace mercury
