// SPDX-License-Identifier: Apache-2.0
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "mercury/custom.h"
#include "mercury/environment.h"
#include "mercury/error.h"
#include "mercury/evolution.h"
#include "mercury/names.h"
#include "mercury/objective.h"
#include "mercury/origin.h"
#include "mercury/quantity.h"
#include "mercury/real_body.h"
#include "mercury/threads.h"
#include "python/src/arguments.h"
#include "python/src/bindings.h"
#include "python/src/values.h"

namespace mercury::python {
namespace {

void set(const std::string& name, double& to, nb::handle value) { to = number_from(name, value); }
void set(const std::string& name, bool& to, nb::handle value) { to = bool_from(name, value); }
void set(const std::string& name, std::uint64_t& to, nb::handle value) { to = seed_from(name, value); }
void set(const std::string& name, int& to, nb::handle value) {
  to = static_cast<int>(whole_from(name, value, std::numeric_limits<int>::min(), std::numeric_limits<int>::max()));
}

// "masses:20:120:8", or (name, lowest, highest, cells), of which only the name is needed.
MapAxis axis_from(nb::handle given) {
  const std::string wanted = "a text such as \"masses:20:120:8\", or (name, lowest, highest, cells)";
  nb::object parts = nb::borrow(given);
  if (nb::isinstance<nb::str>(given)) parts = given.attr("split")(":");
  if (!nb::isinstance<nb::list>(parts) && !nb::isinstance<nb::tuple>(parts)) refuse_type("axes", wanted, given);
  const std::size_t count = nb::len(parts);
  if (count != 1 && count != 3 && count != 4) throw InputError("axes", "give " + wanted);
  const std::string name = text_from("axes", parts[0]);
  std::optional<MapAxis> usual = usual_axis(name);
  if (!usual) throw InputError("axes", "\"" + name + "\" is no quantity" + suggestion(name, names_of_quantities()));
  MapAxis& axis = *usual;
  const nb::object to_number = nb::borrow(nb::handle(reinterpret_cast<PyObject*>(&PyFloat_Type)));
  if (count > 1)
    axis.lowest = nb::cast<double>(to_number(parts[1])), axis.highest = nb::cast<double>(to_number(parts[2]));
  if (count > 3)
    axis.cells = nb::cast<int>(nb::borrow(nb::handle(reinterpret_cast<PyObject*>(&PyLong_Type)))(parts[3]));
  return axis;
}

std::vector<std::string> texts_from(const std::string& name, nb::handle given) {
  if (nb::isinstance<nb::str>(given)) return {text_from(name, given)};
  std::vector<std::string> texts;
  for (const nb::handle each : given) texts.push_back(text_from(name, each));
  return texts;
}

// The water, floor and so on for which the robots are made, as `mercury evolve` chooses them.
Configuration usual_configuration(const GenomeSpaceRequest& space) {
  const Physics physics = physics_of(space);
  std::string wanted = !space.founders.empty() ? environment_of(space.founders.front())
                       : is_custom(space.kind) ? std::string()
                                               : generator_named(space.kind).environment;
  if (!is_environment(wanted) || (physics == Physics::real && has_water(environment_named(wanted)))) wanted.clear();
  return default_configuration(physics, wanted);
}

}  // namespace

EvolutionSettings settings_from(const nb::dict& given, GenomeSpaceRequest& space) {
  EvolutionSettings settings;
  settings.configuration = usual_configuration(space);
  AlgorithmSettings& algorithm = settings.algorithm;
  bool has_algorithm = false, has_trials = false, has_population = false;
  nb::object device = nb::str("auto");
  int threads = 0;
  std::vector<std::string> names{"objective", "algorithm", "axes",   "environment", "solver",
                                 "dt",        "damping",   "device", "threads"};
  const auto read_table = [&](auto& table, const std::string& name, nb::handle value) {
    bool found = false;
    for_each_parameter(table, [&](const auto& parameter, auto& member) {
      if (names.empty() || std::string(parameter.name) != name) return;
      set(name, member, value);
      found = true;
    });
    return found;
  };
  const auto collect = [&](auto& table) {
    for_each_parameter(table, [&](const auto& parameter, auto&) { names.emplace_back(parameter.name); });
  };
  collect(settings), collect(algorithm), collect(settings.trials), collect(space.muscles), collect(space.growth);
  for (const auto [key, value] : given) {
    const std::string name = text_from("settings", key);
    if (name == "objective") {
      settings.objectives = texts_from(name, value);
    } else if (name == "algorithm") {
      algorithm.name = text_from(name, value);
      has_algorithm = true;
    } else if (name == "axes") {
      for (const nb::handle axis : value) algorithm.axes.push_back(axis_from(axis));
    } else if (name == "environment") {
      if (!value.is_none()) settings.configuration.environment = environment_of(value);
    } else if (name == "solver") {
      settings.configuration.solver = solver_named(text_from(name, value));
    } else if (name == "dt") {
      settings.configuration.dt = number_from(name, value);
    } else if (name == "damping") {
      settings.configuration.damping = number_from(name, value);
    } else if (name == "device") {
      device = nb::borrow(value);
    } else if (name == "threads") {
      set(name, threads, value);
    } else if (!read_table(settings, name, value) && !read_table(algorithm, name, value) &&
               !read_table(settings.trials, name, value) && !read_table(space.muscles, name, value) &&
               !read_table(space.growth, name, value)) {
      throw nb::type_error(("there is no setting " + name + suggestion(name, names)).c_str());
    }
    has_trials = has_trials || name == "trials";
    has_population = has_population || name == "population";
  }
  settings.configuration.device = device_named(nb::str(device).c_str());
  settings.configuration.device.threads = threads;
  require_possible_threads(settings.configuration.device);
  complete_algorithm(algorithm, has_algorithm, settings.objectives.size());
  if (settings.trials.racing && !has_trials) settings.trials.trials = 1;
  validate(settings);
  for (const std::string& formula : settings.objectives)
    if (const std::string why = why_meaningless(Objective(formula), settings.configuration.environment); !why.empty())
      throw InputError("objective", "\"" + formula + "\": " + why + "; give another environment or objective");
  if (const std::string parts = custom_parts(settings, space); settings.confirm && !parts.empty())
    throw InputError("confirm", "mercury evolve --resume makes the checks, and does not have " + parts +
                                    "; check champions by mercury check");
  space.environment = name_of(settings.configuration.environment);
  const std::unique_ptr<GenomeSpace> genomes = make_genome_space(space);
  validate(settings, *genomes);
  if (!has_population) algorithm.population = usual_population(algorithm.name, *genomes, settings.seed);
  return settings;
}

}  // namespace mercury::python
