// SPDX-License-Identifier: Apache-2.0
#include "python/src/custom_parts.h"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "mercury/quantity.h"
#include "mercury/random.h"
#include "python/src/array.h"
#include "python/src/called_object.h"
#include "python/src/genomes.h"

namespace mercury::python {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

// [individual][number], NaN or what is said where an individual has none.
nb::object rows_of(std::span<const Individual> individuals, std::size_t width, double otherwise,
                   std::vector<double> Assessment::*numbers) {
  std::vector<double> rows(individuals.size() * width, otherwise);
  for (std::size_t i = 0; i < individuals.size(); ++i) {
    const std::vector<double>& own = individuals[i].assessment.*numbers;
    std::copy_n(own.begin(), std::min(width, own.size()), rows.begin() + static_cast<std::ptrdiff_t>(i * width));
  }
  return owned_array(std::move(rows), {individuals.size(), width});
}

// A Population of mercurysim/_custom.py.
nb::object population_of(std::span<const Individual> individuals, std::size_t objectives) {
  std::vector<std::int64_t> ids, generations, line_began;
  nb::list fates, parents, genomes;
  for (const Individual& one : individuals) {
    ids.push_back(static_cast<std::int64_t>(one.id));
    generations.push_back(one.generation);
    line_began.push_back(one.line_began);
    fates.append(std::string(name_of(one.assessment.fate)));
    parents.append(nb::cast(one.parents));
    genomes.append(one.genome ? nb::cast(SharedGenome{one.genome}) : nb::none());
  }
  const std::size_t count = individuals.size();
  return nb::module_::import_("mercurysim._custom")
      .attr("Population")(owned_array(std::move(ids), {count}), owned_array(std::move(generations), {count}),
                          owned_array(std::move(line_began), {count}),
                          rows_of(individuals, objectives, worst_score, &Assessment::scores), fates, parents, genomes,
                          rows_of(individuals, quantities().size(), not_a_number, &Assessment::values));
}

class AlgorithmOfPython : public Algorithm {
 public:
  AlgorithmOfPython(const AlgorithmSettings& settings, nb::handle selection)
      : usual_(make_algorithm(settings)), selection_(selection) {}

  std::vector<ChildPlan> plan(std::span<const Individual> living, std::size_t children, Random& random) const override {
    const std::uint64_t seed = random.bits();
    return selection_.call([&](nb::handle selection) {
      std::vector<ChildPlan> plans;
      const nb::object chosen = selection.attr("parents")(population_of(living, objectives_), children, seed);
      for (std::vector<std::size_t>& parents : nb::cast<std::vector<std::vector<std::size_t>>>(chosen))
        plans.push_back({.parents = std::move(parents), .numbers = {}});
      return plans;
    });
  }
  std::vector<std::size_t> survivors(std::span<const Individual> pool, std::size_t living) const override {
    for (const Individual& one : pool) objectives_ = std::max(objectives_, one.assessment.scores.size());
    const auto chosen = selection_.call([&](nb::handle selection) {
      return nb::cast<std::optional<std::vector<std::size_t>>>(
          selection.attr("survivors")(population_of(pool, objectives_), living));
    });
    return chosen ? *chosen : usual_->survivors(pool, living);
  }
  void learn(std::span<const Individual> born, Random random) override {
    for (const Individual& one : born) objectives_ = std::max(objectives_, one.assessment.scores.size());
    selection_.call(
        [&](nb::handle selection) { selection.attr("learn")(population_of(born, objectives_), random.bits()); });
  }

 private:
  const std::unique_ptr<Algorithm> usual_;
  const CalledObject selection_;
  mutable std::size_t objectives_ = 1;
};

class ScoringAssessor : public Assessor {
 public:
  ScoringAssessor(std::unique_ptr<Assessor> assessor, const EvolutionSettings& settings, nb::handle scoring)
      : assessor_(std::move(assessor)), settings_(settings), scoring_(scoring) {}

  std::optional<std::vector<Assessment>> assess(std::span<const GenomePointer> candidates,
                                                std::span<const double> interim_limits, const Watch& watch) override {
    std::optional<std::vector<Assessment>> assessments = assessor_->assess(candidates, interim_limits, watch);
    if (assessments) score(*assessments);
    return assessments;
  }
  void prepare(std::span<const GenomePointer> candidates, std::span<const double> interim_limits) override {
    assessor_->prepare(candidates, interim_limits);
  }
  std::string device_name() const override { return assessor_->device_name(); }

 private:
  // Of one objective and all robots. Quartiles may be missing.
  struct Scores {
    std::vector<double> scores, lower_quartiles, upper_quartiles;
  };

  std::vector<std::optional<Scores>> scores_of(const std::vector<Assessment>& assessments) const {
    const std::size_t width = quantities().size(), trials = static_cast<std::size_t>(settings_.trials.trials);
    std::vector<double> values(assessments.size() * trials * width, not_a_number);
    for (std::size_t i = 0; i < assessments.size(); ++i) {
      const auto& own = assessments[i].trial_values;
      for (std::size_t t = 0; t < std::min(trials, own.size()); ++t)
        std::ranges::copy(own[t], values.begin() + static_cast<std::ptrdiff_t>((i * trials + t) * width));
    }
    return scoring_.call([&](nb::handle scoring) {
      std::vector<std::optional<Scores>> all;
      for (const nb::handle one :
           scoring(owned_array(std::move(values), {assessments.size(), trials, width}), settings_.trials.mean)) {
        all.emplace_back();
        if (one.is_none()) continue;
        const auto numbers = [&](std::size_t i) { return nb::cast<std::vector<double>>(one[i]); };
        all.back() = Scores{numbers(0), numbers(1), numbers(2)};
      }
      return all;
    });
  }

  void score(std::vector<Assessment>& assessments) const {
    const std::vector<std::optional<Scores>> scores = scores_of(assessments);
    for (std::size_t i = 0; i < assessments.size(); ++i) {
      Assessment& assessment = assessments[i];
      assessment.trial_values.clear();
      if (assessment.fate != Fate::sound && assessment.fate != Fate::stopped) continue;
      for (std::size_t o = 0; o < scores.size() && assessment.fate != Fate::undefined; ++o)
        if (scores[o]) take(*scores[o], i, o, assessment);
    }
  }

  void take(const Scores& from, std::size_t robot, std::size_t objective, Assessment& assessment) const {
    if (!std::isfinite(from.scores[robot])) {
      assessment.fate = Fate::undefined;
      assessment.problem = Objective(settings_.objectives[objective]).undefined_text();
      assessment.violation = std::numeric_limits<double>::infinity();
      std::ranges::fill(assessment.scores, worst_score);
      assessment.lower_quartiles.clear(), assessment.upper_quartiles.clear();
      return;
    }
    assessment.scores[objective] = from.scores[robot];
    if (objective >= assessment.lower_quartiles.size()) return;
    const bool known = !from.lower_quartiles.empty();
    assessment.lower_quartiles[objective] = known ? from.lower_quartiles[robot] : from.scores[robot];
    assessment.upper_quartiles[objective] = known ? from.upper_quartiles[robot] : from.scores[robot];
  }

  const std::unique_ptr<Assessor> assessor_;
  const EvolutionSettings settings_;
  const CalledObject scoring_;
};

nb::object scores_of(const Assessed& self) {
  const std::size_t objectives = self.assessments.empty() ? 1 : self.assessments.front().scores.size();
  std::vector<double> scores;
  for (const Assessment& one : self.assessments) scores.insert(scores.end(), one.scores.begin(), one.scores.end());
  const std::size_t count = self.assessments.size();
  return objectives == 1 ? owned_array(std::move(scores), {count})
                         : owned_array(std::move(scores), {count, objectives});
}

nb::dict quantities_of(const Assessed& self) {
  nb::dict table;
  for (std::size_t q = 0; q < quantities().size(); ++q) {
    std::vector<double> column;
    for (const Assessment& one : self.assessments)
      column.push_back(q < one.values.size() ? one.values[q] : not_a_number);
    const std::size_t count = column.size();
    table[nb::str(quantities()[q].name.data(), quantities()[q].name.size())] = owned_array(std::move(column), {count});
  }
  return table;
}

template <class Value>
nb::list list_of(const Assessed& self, const Value& value) {
  nb::list list;
  for (const Assessment& one : self.assessments) list.append(value(one));
  return list;
}

}  // namespace

std::unique_ptr<Algorithm> algorithm_of_python(const AlgorithmSettings& settings, nb::handle selection) {
  return std::make_unique<AlgorithmOfPython>(settings, selection);
}

std::unique_ptr<Assessor> scored_by_python(std::unique_ptr<Assessor> assessor, const EvolutionSettings& settings,
                                           nb::handle scoring) {
  return std::make_unique<ScoringAssessor>(std::move(assessor), settings, scoring);
}

void bind_custom_parts(nb::module_& module) {
  nb::class_<Assessed>(module, "Assessed", "What became of some genomes that a run has tried, in their order.")
      .def("__len__", [](const Assessed& self) { return self.genomes.size(); })
      .def_prop_ro(
          "genomes",
          [](const Assessed& self) {
            nb::list genomes;
            for (const GenomePointer& genome : self.genomes) genomes.append(nb::cast(SharedGenome{genome}));
            return genomes;
          },
          nb::sig("def genomes(self) -> list[Genome]"), "Which.")
      .def_prop_ro("scores", &scores_of, nb::sig("def scores(self) -> numpy.typing.NDArray[numpy.float64]"),
                   "Their scores, more is better: (robots,), or (robots, objectives) of several objectives. -inf for "
                   "robots that\nare not sound.")
      .def_prop_ro(
          "fates",
          [](const Assessed& self) {
            return list_of(self, [](const Assessment& one) { return std::string(name_of(one.fate)); });
          },
          nb::sig("def fates(self) -> list[str]"), "\"sound\", \"exploded\", \"overstretched\" and so on.")
      .def_prop_ro(
          "problems",
          [](const Assessed& self) { return list_of(self, [](const Assessment& one) { return one.problem; }); },
          nb::sig("def problems(self) -> list[str]"), "Why robots failed, or have no score; else empty.")
      .def_prop_ro("quantities", &quantities_of,
                   nb::sig("def quantities(self) -> dict[str, numpy.typing.NDArray[numpy.float64]]"),
                   "All quantities of all trials together, by name; NaN where a robot has none.");
}

}  // namespace mercury::python
