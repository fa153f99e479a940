// SPDX-License-Identifier: Apache-2.0
// An evolution: generation after generation, children of the living are made, tried and selected.
//
//     const auto space = mercury::make_genome_space({.kind = "voxel"});
//     const mercury::EvolutionSettings settings{.generations = 20};
//     const auto assessor = make_assessor(settings);
//     mercury::Evolution evolution(settings, *space);
//     while (const auto generation = evolution.advance(*assessor, watch)) use(generation->living.front());
//
// If it is pipelined, the parents of generation n are those who lived after generation n - 2, so that its children can
// be made, and begun with, while generation n - 1 is tried. Those of generation 1 are of generation 0.
//
//     tried      |  0  |  1  |  2  |  3  |
//     children       0    1,2    3     4      of 1 and 2 from those who live after 0, of 3 after 1, ...
//
// Everything depends on the settings alone, bit for bit: each generation draws from a seed of its own, so an evolution
// that is restored goes on as if it had never stopped.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "mercury/algorithm.h"
#include "mercury/assessor.h"
#include "mercury/configuration.h"
#include "mercury/genome.h"
#include "mercury/individual.h"
#include "mercury/parameters.h"

namespace mercury {

struct EvolutionSettings {
  AlgorithmSettings algorithm;
  std::vector<std::string> objectives{"distance"};
  TrialSettings trials = search_trials();
  Configuration configuration;
  std::size_t children = 0;  // per generation; 0 = as many as the population, or as the algorithm makes
  int generations = 100;     // after generation 0, which is random
  double mutation = 1;       // strength
  bool pipelined = false;    // children of a generation are made while the one before is tried
  bool confirm = false;      // only champions whose results hold are in a run's best/ (mercury/confirmation.h)
  std::uint64_t seed = 1;

  static constexpr std::tuple parameters{
      Parameter("generations", &EvolutionSettings::generations, "", Accepts::between(0, 1e9), {1, 1000, true},
                "Generations after the first, random one"),
      Parameter("children", &EvolutionSettings::children, "", Accepts::between(0, 1e6), {0, 4096},
                "Robots born in a generation")
          .with_default_note("default: --population"),
      Parameter("mutation", &EvolutionSettings::mutation, "", Accepts::above_zero, {0.1f, 10, true},
                "Strength of mutations"),
      Parameter("pipelined", &EvolutionSettings::pipelined,
                "Make a generation while the one before is tried: parents are older by one"),
      Parameter("confirm", &EvolutionSettings::confirm, "Check champions; only those whose results hold are in best/"),
      Parameter("seed", &EvolutionSettings::seed, "", Accepts::at_least_zero, {0, 100}, "Seed of the run")};
};

// Throws ParameterError for settings out of range or that do not go together.
void validate(const EvolutionSettings& settings);
// Throws ParameterError("algorithm", ...) if the algorithm cannot search among these genomes.
void validate(const EvolutionSettings& settings, const GenomeSpace& space);

// The population that an algorithm has where nothing else is said: 4 + 3 ln n for those that search among n numbers
// (Hansen 2016, table 1), else that of AlgorithmSettings.
std::size_t usual_population(std::string_view algorithm, const GenomeSpace& space, std::uint64_t seed);

std::unique_ptr<Assessor> make_assessor(const EvolutionSettings& settings);

// One generation after its selection.
struct Generation {
  int number = 0;
  std::vector<Individual> born;                                  // in it, by id, with their genomes
  std::vector<std::uint64_t> living;                             // ids of those who live on, the best first
  friend bool operator==(const Generation&, const Generation&);  // genomes are not compared
};

class Islands;

class Evolution {
 public:
  // The space must outlive it. `algorithm` = a custom one (mercury/custom.h), in place of that of the settings. Throws
  // as validate().
  Evolution(const EvolutionSettings& settings, const GenomeSpace& space,
            std::unique_ptr<Algorithm> algorithm = nullptr);
  ~Evolution();

  // Continues after a generation: `living` as it left them; `born` = all individuals so far, by id, whose genomes are
  // not needed; `before` = those who lived when the generation began, needed if it is pipelined. Throws InputError if
  // an algorithm that learns does not come to the same robots again.
  void restore(int generation, std::vector<Individual> living, std::span<const Individual> born,
               std::vector<Individual> before = {});

  const EvolutionSettings& settings() const { return settings_; }
  int next_generation() const { return next_generation_; }
  bool is_over() const { return next_generation_ > settings_.generations; }
  const std::vector<Individual>& living() const { return living_; }  // the best first

  // The children of the next generation, not yet assessed. Children differ in Genome::identity() from each other and
  // from the living, wherever that is possible within a bounded number of tries. `watch` is called now and then, with
  // none done; it cannot stop this, because each process of an MPI run makes the same children.
  std::vector<Individual> children(const Watch& watch = {}) const;
  // Scores that its robots must reach at the checks of racing; empty without racing.
  std::vector<double> interim_limits() const;
  // The id of the first of them.
  std::uint64_t next_id() const { return next_id_; }
  // Selects among the living and these children, which are assessed: those of children(), or others that a program has
  // made, with ids from next_id() on. Throws InputError, and changes nothing, if the algorithm fails.
  Generation select(std::vector<Individual> children);
  // The same, but these live on, by their ids, the best first. Throws InputError unless each lives or is a child, and
  // is named once.
  Generation select(std::vector<Individual> children, std::span<const std::uint64_t> living);

  // All of it: one generation. Nothing if it is over, or if `watch` said to stop; then nothing has changed. Throws
  // InputError if no robot of generation 0 can be tried.
  std::optional<Generation> advance(Assessor& assessor, const Watch& watch = {});

 private:
  void begin_to_learn();
  // Indices of those who live on, the best first, of the living and then the children.
  using SurvivorsOf = std::function<std::vector<std::size_t>(std::span<const Individual> pool)>;
  Generation select(std::vector<Individual> children, const SurvivorsOf& survivors_of);
  // Those who are the parents of the next generation.
  const std::vector<Individual>& parents() const;
  // The children of a generation.
  std::vector<Individual> breed(int generation, const std::vector<Individual>& parents, std::uint64_t first_id,
                                const Watch& watch) const;
  std::vector<ChildPlan> plans(int generation, std::span<const Individual> parents) const;
  std::vector<double> interim_limits(std::span<const Individual> parents) const;
  // The children of the next generation, with which the assessor has begun.
  std::vector<Individual> begun(Assessor& assessor, const Watch& watch);

  EvolutionSettings settings_;
  const GenomeSpace& space_;
  GenomePointer start_;  // where a search among numbers begins; else nullptr
  std::unique_ptr<const Islands> islands_;
  int next_generation_ = 0;
  std::uint64_t next_id_ = 0;
  std::vector<Individual> living_, before_;    // now, and if it is pipelined, when the last generation began
  std::deque<std::vector<Individual>> begun_;  // children of the next generations
};

}  // namespace mercury
