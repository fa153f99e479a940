// SPDX-License-Identifier: Apache-2.0
#include "mercury/shell.h"

#include <nlohmann/json.hpp>

#include "mercury/error.h"
#include "mercury/origin.h"
#include "robots/parameter_table.h"
#include "robots/shell_body.h"
#include "robots/shell_evolution.h"
#include "robots/shell_surface.h"

namespace mercury {
namespace {

std::string origin_of(const ShellGenome& genome) {
  nlohmann::ordered_json origin{{"kind", "shell"}};
  if (!genome.environment.empty()) origin["environment"] = genome.environment;
  for (const auto& row : shell_genome_table())
    std::visit(
        [&]<class Value>(const Value& value) {
          if constexpr (!std::is_same_v<Value, SizeRange>) origin[row.description.name] = value;
        },
        row.get(genome));
  return origin.dump();
}

// A value of the kind that the default has.
ParameterValue read(const nlohmann::json& origin, const GeneratorParameter& description) {
  const std::string place = "/origin/" + description.name;
  const auto found = origin.find(description.name);
  if (found == origin.end()) throw InputError(place, "is missing");
  if (std::holds_alternative<std::string>(description.initial) && found->is_string()) return found->get<std::string>();
  if (std::holds_alternative<double>(description.initial) && found->is_number()) return found->get<double>();
  if (std::holds_alternative<std::int64_t>(description.initial) && found->is_number_integer())
    return found->get<std::int64_t>();
  throw InputError(place, "give " + accepted_values(description));
}

}  // namespace

void check_shell_thickness(double thickness, double diameter) {
  if (thickness > diameter / 4)
    throw ParameterError("thickness", "more than a quarter of the diameter is not accepted; give less");
}

void validate(const ShellGenome& genome) {
  check_each(shell_genome_table(), genome);
  check_shell_thickness(genome.thickness, genome.diameter);
}

Robot grow(const ShellGenome& genome, const std::string& name) {
  validate(genome);
  const RevolvedMesh mesh = mesh_of(genome);
  if (2 * mesh.vertices().size() > max_masses)
    throw ParameterError("segments",
                         "the shell would have more than " + std::to_string(max_masses) + " masses; give fewer");
  Robot robot = shell_body(genome, mesh);
  robot.name = name;
  robot.origin = origin_of(genome);
  return robot;
}

std::optional<ShellGenome> shell_genome_of(const Robot& robot) {
  if (kind_of(robot) != "shell") return std::nullopt;
  const auto origin = nlohmann::json::parse(robot.origin, nullptr, false);
  ShellGenome genome;
  genome.environment = environment_of(robot);
  for (const auto& row : shell_genome_table()) {
    const ParameterValue value = read(origin, row.description);
    try {
      check(row.description, value);
    } catch (const ParameterError& error) {
      throw InputError("/origin/" + error.parameter(), error.problem());
    }
    row.set(genome, value);
  }
  return genome;
}

}  // namespace mercury
