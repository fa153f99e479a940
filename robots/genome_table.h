// SPDX-License-Identifier: Apache-2.0
// Genomes that are a struct of numbers with a table (parameter_table.h): what the origin keeps of them, and how they
// move.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <type_traits>
#include <variant>

#include "mercury/error.h"
#include "mercury/origin.h"
#include "mercury/random.h"
#include "robots/mutation_step.h"
#include "robots/parameter_table.h"

namespace mercury {

// {"kind": ..., "environment": ..., and each number by its name}. The genome has a member `environment`.
template <class Genome>
std::string origin_of(const char* kind, const ParameterTable<Genome>& table, const Genome& genome) {
  nlohmann::ordered_json origin{{"kind", kind}};
  if (!genome.environment.empty()) origin["environment"] = genome.environment;
  for (const auto& row : table)
    std::visit(
        [&]<class Value>(const Value& value) {
          if constexpr (!std::is_same_v<Value, SizeRange>) origin[row.description.name] = value;
        },
        row.get(genome));
  return origin.dump();
}

// A value of the kind that the default has.
inline ParameterValue value_in(const nlohmann::json& origin, const GeneratorParameter& description) {
  const std::string place = "/origin/" + description.name;
  const auto found = origin.find(description.name);
  if (found == origin.end()) throw InputError(place, "is missing");
  if (std::holds_alternative<std::string>(description.initial) && found->is_string()) return found->get<std::string>();
  if (std::holds_alternative<double>(description.initial) && found->is_number()) return found->get<double>();
  if (std::holds_alternative<std::int64_t>(description.initial) && found->is_number_integer())
    return found->get<std::int64_t>();
  throw InputError(place, "give " + accepted_values(description));
}

// The genome in the origin of a robot of that kind. Throws InputError("/origin/NAME", ...).
template <class Genome>
Genome genome_in(const Robot& robot, const ParameterTable<Genome>& table) {
  const auto origin = nlohmann::json::parse(robot.origin, nullptr, false);
  Genome genome;
  genome.environment = environment_of(robot);
  for (const auto& row : table) {
    const ParameterValue value = value_in(origin, row.description);
    try {
      check(row.description, value);
    } catch (const ParameterError& error) {
      throw InputError("/origin/" + error.parameter(), error.problem());
    }
    row.set(genome, value);
  }
  return genome;
}

// The genome with the chosen numbers moved by a normal number, or one with a heavier tail (mutation_step.h), times
// `size` times their range. Every number draws, so that its step does not depend on the choice.
template <class Genome, class Chosen>
Genome moved(const Genome& genome, const ParameterTable<Genome>& table, double size, std::uint64_t seed, Chosen chosen,
             int tail = 0) {
  Random random(seed);
  const auto within = [&](double value, double low, double high) {
    return tail == 0 ? std::clamp(value, low, high) : reflected(value, low, high);
  };
  Genome child = genome;
  for (const auto& row : table) {
    const double drawn = step_number(random, tail);
    if (!std::isfinite(row.description.accepts.highest) || !chosen(row.description.name)) continue;
    const double low = row.description.accepts.lowest, high = row.description.accepts.highest;
    const double step = size * (high - low) * drawn;
    ParameterValue value = row.get(child);
    if (auto* number = std::get_if<double>(&value)) *number = within(*number + step, low, high);
    if (auto* whole = std::get_if<std::int64_t>(&value))
      *whole = static_cast<std::int64_t>(within(std::round(static_cast<double>(*whole) + step), low, high));
    row.set(child, value);
  }
  return child;
}

// A value as a number without bounds, and the reverse (bounded()). Its unit is a step of moved() with this size.
constexpr double usual_step = 0.02;
inline double number_of(const GeneratorParameter& description, double value) {
  const double low = description.accepts.lowest, high = description.accepts.highest;
  return unbounded(value, low, high) / (usual_step * (high - low));
}
inline double value_of(const GeneratorParameter& description, double number) {
  const double low = description.accepts.lowest, high = description.accepts.highest;
  return bounded(number * (usual_step * (high - low)), low, high);
}

// moved(), drawn again where it changes nothing; at last the number `nudged` moves by a millionth of its range, toward
// the middle.
template <class Genome, class Chosen>
Genome surely_moved(const Genome& genome, const ParameterTable<Genome>& table, double size, std::uint64_t seed,
                    Chosen chosen, double Genome::*nudged, double lowest, double highest, int tail = 0) {
  if (size == 0) return genome;
  constexpr std::uint64_t attempts = 30;
  for (std::uint64_t attempt = 0; attempt < attempts; ++attempt) {
    Genome child = moved(genome, table, size, attempt == 0 ? seed : seed_of(seed, attempt), chosen, tail);
    if (child != genome) return child;
  }
  Genome child = genome;
  child.*nudged += (child.*nudged > (lowest + highest) / 2 ? -1e-6 : 1e-6) * (highest - lowest);
  return child;
}

}  // namespace mercury
