// SPDX-License-Identifier: Apache-2.0
// The history of a run folder, as mercurysim/evolution.py reads it.
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "mercury/quantity.h"
#include "mercury/run_folder.h"
#include "python/src/array.h"
#include "python/src/bindings.h"
#include "python/src/genomes.h"
#include "python/src/values.h"

namespace mercury::python {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

// One array per property, one element per individual.
nb::dict individuals_of(const RunHistory& self) {
  const auto all = self.individuals();
  const std::size_t count = all.size(), objectives = self.settings().evolution.objectives.size();
  nb::dict columns;
  const auto column = [&]<class T>(const char* name, T, const auto& value) {
    std::vector<T> values;
    values.reserve(count);
    for (const Individual& individual : all) values.push_back(static_cast<T>(value(individual)));
    columns[name] = owned_array(std::move(values), {count});
  };
  using Integer = std::int64_t;
  const auto parent = [](std::size_t i) {
    return [i](const Individual& one) { return i < one.parents.size() ? static_cast<Integer>(one.parents[i]) : -1; };
  };
  column("id", Integer{}, [](const Individual& one) { return one.id; });
  column("parent", Integer{}, parent(0));
  column("other_parent", Integer{}, parent(1));
  column("generation", Integer{}, [](const Individual& one) { return one.generation; });
  column("died", Integer{}, [&](const Individual& one) { return self.died(one.id).value_or(-1); });
  column("line_began", Integer{}, [](const Individual& one) { return one.line_began; });
  if (self.settings().evolution.algorithm.islands > 1)
    column("island", Integer{}, [](const Individual& one) { return one.island; });
  nb::list fates;
  for (const Individual& individual : all) {
    const std::string_view fate = name_of(individual.assessment.fate);
    fates.append(nb::str(fate.data(), fate.size()));
  }
  columns["fate"] = nb::module_::import_("numpy").attr("array")(fates, nb::arg("dtype") = "U12");
  for (std::size_t i = 0; i < objectives; ++i)
    column(i == 0 ? "score" : ("score" + std::to_string(i + 1)).c_str(), double{}, [i](const Individual& one) {
      return i < one.assessment.scores.size() ? one.assessment.scores[i] : worst_score;
    });
  for (std::size_t i = 0; i < quantities().size(); ++i)
    column(std::string(quantities()[i].name).c_str(), double{}, [i](const Individual& one) {
      return i < one.assessment.values.size() ? one.assessment.values[i] : not_a_number;
    });
  return columns;
}

nb::dict generations_of(const RunHistory& self) {
  nb::dict columns;
  const auto column = [&]<class T>(const char* name, T, const auto& value) {
    std::vector<T> values;
    for (const GenerationSummary& generation : self.generations()) values.push_back(static_cast<T>(value(generation)));
    columns[name] = owned_array(std::move(values), {self.generations().size()});
  };
  using Integer = std::int64_t;
  column("generation", Integer{}, [](const GenerationSummary& one) { return one.number; });
  column("born", Integer{}, [](const GenerationSummary& one) { return one.born; });
  column("living", Integer{}, [](const GenerationSummary& one) { return one.living; });
  column("best", Integer{}, [](const GenerationSummary& one) { return one.best; });
  const std::size_t objectives = self.settings().evolution.objectives.size();
  for (std::size_t i = 0; i < objectives; ++i) {
    const std::string number = i == 0 ? "" : std::to_string(i + 1);
    const auto spread = [&](const char* name, double ScoreSpread::*member) {
      column((name + number).c_str(), double{},
             [&](const GenerationSummary& one) { return i < one.scores.size() ? one.scores[i].*member : worst_score; });
    };
    column(("best_score" + number).c_str(), double{},
           [i](const GenerationSummary& one) { return i < one.best_scores.size() ? one.best_scores[i] : worst_score; });
    spread("lower_quartile", &ScoreSpread::lower_quartile);
    spread("median", &ScoreSpread::median);
    spread("upper_quartile", &ScoreSpread::upper_quartile);
    spread("highest", &ScoreSpread::highest);
  }
  constexpr std::pair<const char*, Fate> fates[] = {
      {"exploded", Fate::exploded},   {"overstretched", Fate::overstretched},
      {"too_small", Fate::too_small}, {"undefined", Fate::undefined},
      {"stopped", Fate::stopped},     {"failed", Fate::failed}};
  for (const auto& [name, fate] : fates)
    column(name, Integer{}, [fate = fate](const GenerationSummary& one) { return one.fates[fate]; });
  column("lines", Integer{}, [](const GenerationSummary& one) { return one.lines; });
  if (const std::vector<std::size_t> species = self.species(); !species.empty())
    column("species", Integer{},
           [&](const GenerationSummary& one) { return species[static_cast<std::size_t>(one.number)]; });
  if (algorithm_of(self.settings().evolution.algorithm).has_map) {
    column("cells", Integer{}, [](const GenerationSummary& one) { return one.scored; });
    column("coverage", double{}, [](const GenerationSummary& one) { return one.coverage; });
    column("qd_score", double{}, [](const GenerationSummary& one) { return one.score_sum; });
  }
  if (const std::size_t islands = self.settings().evolution.algorithm.islands; islands > 1)
    for (std::size_t i = 0; i < islands; ++i)
      column(("best_of_island_" + std::to_string(i)).c_str(), double{},
             [i](const GenerationSummary& one) { return one.best_of_islands[i]; });
  column("seconds", double{}, [](const GenerationSummary& one) { return one.times.seconds; });
  return columns;
}

nb::dict settings_of(const RunHistory& self) {
  const RunSettings& run = self.settings();
  const EvolutionSettings& evolution = run.evolution;
  nb::dict values;
  values["robots"] = run.space.founders.empty() ? run.space.kind : std::to_string(run.space.founders.size()) + " given";
  values["genes"] = name_of(run.space.genes);
  values["objective"] = nb::cast(evolution.objectives);
  values["algorithm"] = evolution.algorithm.name;
  nb::list axes;
  for (const MapAxis& axis : evolution.algorithm.axes)
    axes.append(nb::make_tuple(axis.quantity, axis.lowest, axis.highest, axis.cells));
  values["axes"] = axes;
  const auto add = [&](const auto& table) {
    for_each_parameter(table, [&](const auto& parameter, const auto& value) {
      values[std::string(parameter.name).c_str()] = nb::cast(value);
    });
  };
  add(evolution), add(evolution.algorithm), add(evolution.trials), add(run.space.muscles), add(run.space.growth);
  values["environment"] = object_of(evolution.configuration.environment);
  values["solver"] = std::string(name_of(evolution.configuration.solver));
  values["dt"] = evolution.configuration.dt;
  values["damping"] = evolution.configuration.damping;
  values["program"] = run.program;
  return values;
}

std::uint64_t known_id(const RunHistory& self, nb::handle given) {
  const std::int64_t id = whole_from("id", given);
  if (id < 0 || static_cast<std::uint64_t>(id) >= self.individuals().size())
    throw std::out_of_range("robot " + std::to_string(id) + " is out of range, the run has " +
                            std::to_string(self.individuals().size()));
  return static_cast<std::uint64_t>(id);
}

Genomes genomes_of(const RunHistory& self, nb::handle kind) { return {space_maker(kind)(self.settings().space)}; }

}  // namespace

void bind_run_history(nb::module_& module) {
  nb::class_<RunHistory>(module, "_History")
      .def(
          "__init__",
          [](RunHistory* self, nb::handle folder, nb::handle kind) {
            new (self) RunHistory(path_from("folder", folder), space_maker(kind));
          },
          nb::arg("folder"), nb::arg("kind").none())
      .def("refresh", &RunHistory::refresh)
      .def("individuals", &individuals_of)
      .def("generations", &generations_of)
      .def("settings", &settings_of)
      .def("genomes", &genomes_of, nb::arg("kind").none())
      .def("__len__", [](const RunHistory& self) { return self.individuals().size(); })
      .def("robot",
           [](const RunHistory& self, nb::handle id) {
             return SharedRobot{std::make_shared<const Robot>(self.grow(known_id(self, id)))};
           })
      .def("genome",
           [](const RunHistory& self, nb::handle id) { return SharedGenome{self.genome(known_id(self, id))}; })
      .def("line_of", [](const RunHistory& self, nb::handle id) { return self.line_of(known_id(self, id)); })
      .def("living", [](const RunHistory& self) {
        return std::vector<std::uint64_t>(self.living().begin(), self.living().end());
      });
  module.def("_quantities", [] { return names_of_quantities(); });
}

}  // namespace mercury::python
