// SPDX-License-Identifier: Apache-2.0
// The keys of run.toml, listed once for the writer and the reader.
#pragma once

#include <string>

#include "evolution/run_folder/run_file.h"
#include "mercury/configuration.h"

namespace mercury {

// `File` is RunFileWriter or RunFileReader. Both have
//   value(key, variable, comment)            must be there
//   parameter(key, variable, comment)        may be absent: then the variable stays as it is
//   named(key, variable, from_name)          a variable with name_of(variable) and the reverse
//   table(key, describe)                     [key]
//   tables(key, list, describe)              [[key]], one per element
//   generator_values(key, kind, values)      [key], the parameters of a generator
// All of a table. Files of earlier versions may lack some.
template <class File, class Settings>
void describe_parameters(File& file, Settings& settings) {
  for_each_parameter(settings, [&](const auto& parameter, auto& value) {
    const std::string unit(parameter.unit), help(parameter.help);
    file.parameter(parameter.name, value, unit.empty() ? help : unit + "; " + help);
  });
}

template <class File, class Run>
void describe_algorithm(File& file, Run& algorithm) {
  file.value("name", algorithm.name);
  describe_parameters(file, algorithm);
  file.tables("axes", algorithm.axes, [](auto& table, auto& axis) {
    table.value("quantity", axis.quantity);
    table.value("lowest", axis.lowest);
    table.value("highest", axis.highest);
    table.value("cells", axis.cells);
  });
}

template <class File, class Configured>
void describe_configuration(File& file, Configured& configuration) {
  const auto parameters = [](auto& table) {
    return [&table](const auto& parameter, auto& value) { table.parameter(parameter.name, value, parameter.unit); };
  };
  file.table("configuration", [&](auto& table) {
    table.named("solver", configuration.solver, solver_named);
    for_each_parameter(configuration, parameters(table));
    table.named("device", configuration.device, device_named);
    for_each_parameter(configuration.device, parameters(table));
  });
  file.table("environment", [&](auto& table) {
    table.named("name", configuration.environment, environment_named);
    for_each_parameter(configuration.environment, parameters(table));
  });
}

template <class File, class Run>
void describe(File& file, Run& run) {
  auto& settings = run.settings;
  auto& evolution = settings.evolution;
  file.value("program", settings.program);
  file.table("evolution", [&](auto& table) {
    describe_parameters(table, evolution);
    table.value("objectives", evolution.objectives);
    table.value("quantities", run.quantities, "that the journal holds of each individual");
  });
  file.table("algorithm", [&](auto& table) { describe_algorithm(table, evolution.algorithm); });
  file.table("trials", [&](auto& table) { describe_parameters(table, evolution.trials); });
  describe_configuration(file, evolution.configuration);
  file.table("genomes", [&](auto& table) {
    auto& space = settings.space;
    table.value("kind", space.kind);
    table.named("genes", space.genes, genes_named);
    table.value("environment", space.environment);
    table.value("founders", run.founder_files, "in founders/");
    describe_parameters(table, space.muscles);
    describe_parameters(table, space.growth);
    table.generator_values("values", space.kind, space.values);
  });
}

}  // namespace mercury
