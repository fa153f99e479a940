// SPDX-License-Identifier: Apache-2.0
#include "robots/shell_evolution.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <variant>

#include "mercury/error.h"
#include "mercury/random.h"

namespace mercury {
namespace {

const std::vector<std::string> form_names{"bell", "tube", "ring", "pod"};

// The genome with the chosen numbers moved. Every number draws, so that its step does not depend on the choice.
template <class Chosen>
ShellGenome moved(const ShellGenome& genome, double strength, std::uint64_t seed, Chosen chosen) {
  Random random(seed);
  ShellGenome child = genome;
  for (const auto& row : shell_genome_table()) {
    const double drawn = random.normal();
    if (!row.description.highest || !chosen(row.description.name)) continue;
    const double low = row.description.lowest, high = *row.description.highest;
    const double step = 0.04 * strength * (high - low) * drawn;
    ParameterValue value = row.get(child);
    if (auto* number = std::get_if<double>(&value)) *number = std::clamp(*number + step, low, high);
    if (auto* whole = std::get_if<std::int64_t>(&value))
      *whole = static_cast<std::int64_t>(std::clamp(std::round(static_cast<double>(*whole) + step), low, high));
    row.set(child, value);
  }
  return child;
}

// moved(), drawn again where it changes nothing; at last the number `nudged` moves by a millionth of its range, towards
// the middle.
template <class Chosen>
ShellGenome surely_moved(const ShellGenome& genome, double strength, std::uint64_t seed, Chosen chosen,
                         double ShellGenome::*nudged, double lowest, double highest) {
  if (strength == 0) return genome;
  constexpr std::uint64_t attempts = 30;
  for (std::uint64_t attempt = 0; attempt < attempts; ++attempt) {
    ShellGenome child = moved(genome, strength, attempt == 0 ? seed : seed_of(seed, attempt), chosen);
    if (child != genome) return child;
  }
  ShellGenome child = genome;
  child.*nudged += (child.*nudged > (lowest + highest) / 2 ? -1e-6 : 1e-6) * (highest - lowest);
  return child;
}

}  // namespace

const ParameterTable<ShellGenome>& shell_genome_table() {
  using G = ShellGenome;
  const auto number = [](auto member, const char* name, double lowest, double highest) {
    return parameter(member, {.name = name, .lowest = lowest, .highest = highest});
  };
  static const ParameterTable<G> rows{parameter(&G::form, {.name = "form", .words = form_names}),
                                      number(&G::segments, "segments", 12, 128),
                                      number(&G::lobes, "lobes", 3, 16),
                                      number(&G::waves_around, "waves_around", -4, 4),
                                      number(&G::diameter, "diameter", 0.2, 20),
                                      number(&G::thickness, "thickness", 0.01, 5),
                                      number(&G::height, "height", 0.2, 3),
                                      number(&G::opening, "opening", 0, 1),
                                      number(&G::squareness, "squareness", -0.1, 0.15),
                                      number(&G::flare, "flare", 0, 0.5),
                                      number(&G::lobe_depth, "lobe_depth", 0, 0.3),
                                      number(&G::lappets, "lappets", 0, 0.4),
                                      number(&G::twist, "twist", -0.5, 0.5),
                                      number(&G::active, "active", 0, 1),
                                      number(&G::contraction, "contraction", -0.4, 0.4),
                                      number(&G::bending, "bending", -0.4, 0.4),
                                      number(&G::frequency, "frequency", 0, 20),
                                      number(&G::waves_along, "waves_along", -3, 3)};
  return rows;
}

ShellGenome shell_genome_in(const Robot& robot) {
  std::optional<ShellGenome> genome = shell_genome_of(robot);
  if (!genome) throw InputError("/origin", "holds no shell");
  return *std::move(genome);
}

ShellGenome mutate(const ShellGenome& genome, double strength, std::uint64_t seed) {
  const auto chosen = [](const std::string& name) {
    return name != "diameter" && name != "thickness" && name != "segments";
  };
  return surely_moved(genome, strength, seed, chosen, &ShellGenome::height, 0.2, 3);
}

ShellGenome mutate_muscles(const ShellGenome& genome, double strength, std::uint64_t seed) {
  const auto chosen = [](const std::string& name) {
    return name == "waves_around" || name == "waves_along" || name == "active" || name == "contraction" ||
           name == "bending" || name == "frequency";
  };
  return surely_moved(genome, strength, seed, chosen, &ShellGenome::frequency, 0, 20);
}

ShellGenome crossover(const ShellGenome& a, const ShellGenome& b, std::uint64_t seed) {
  Random random(seed);
  ShellGenome child = a;
  for (const auto& row : shell_genome_table()) {
    const bool of_b = random.chance(0.5);
    const std::string& name = row.description.name;
    if (of_b && name != "form" && name != "segments") row.set(child, row.get(b));
  }
  child.thickness = std::min(child.thickness, child.diameter / 4);
  return child;
}

Robot mutate_shell_robot(const Robot& parent, const MutationRequest& request, const std::string& name) {
  ShellGenome genome = mutate(shell_genome_in(parent), request.strength, request.seed);
  if (request.muscles > 0) genome = mutate_muscles(genome, request.muscles, seed_of(request.seed, 0));
  return grow(genome, name);
}

Robot cross_shell_robots(const Robot& a, const Robot& b, std::uint64_t seed, const std::string& name) {
  return grow(crossover(shell_genome_in(a), shell_genome_in(b), seed), name);
}

}  // namespace mercury
