// SPDX-License-Identifier: Apache-2.0
// Algorithms of evolution. An algorithm sees the living individuals, says what children to make, and then who lives on.
// Most keep no state, so a run can be continued from its living individuals alone. The state of those that search among
// numbers (CMA-ES) or keep an archive (novelty) follows from the seeds and scores of all generations, from which it is
// computed again.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "mercury/individual.h"
#include "mercury/parameters.h"
#include "mercury/random.h"

namespace mercury {

// One axis of a map of elites: a quantity, cut into equal cells between two values. What lies outside counts to the
// cell at that end.
struct MapAxis {
  std::string quantity;
  double lowest = 0, highest = 1;
  int cells = 10;
  friend bool operator==(const MapAxis&, const MapAxis&) = default;
};

struct AlgorithmSettings {
  std::string name = "afpo";
  std::size_t population = 128;  // that lives on after each generation (for map-elites: children per generation)
  int tournament = 4;            // individuals among which the best becomes a parent
  double elites = 0.1;           // ga: share of the population that lives on unconditionally
  double crossover = 0.25;       // share of the children that have two parents
  std::vector<MapAxis> axes;     // map-elites, novelty, cma-me: one or more
  std::size_t niches = 0;        // map-elites, cma-me: cells of equal size in place of the axes' cells; 0 = those
  int neighbors = 15;            // novelty: the nearest robots, whose mean distance is the novelty
  std::size_t archived = 6;      // novelty: robots of each generation that come into the archive
  int age_layers = 5;            // alps
  int age_gap = 5;               // alps: generations
  std::size_t islands = 1;       // into which the population is split; 1 = it is not (selection/islands.h)
  int migration_interval = 10;   // islands: generations; 0 = nobody migrates
  std::size_t migrants = 2;      // islands: robots of each island
  double species_distance = 3;   // neat: from the oldest robot of a species to the others
  std::size_t species = 12;      // neat: at most; if there are more, species_distance grows
  int stagnation = 15;           // neat: generations without a better robot, after which a species dies out; 0 = never

  static constexpr std::tuple parameters{
      Parameter("population", &AlgorithmSettings::population, "", Accepts::between(1, 1e6), {1, 4096, true},
                "Robots that live on after each generation"),
      Parameter("tournament", &AlgorithmSettings::tournament, "", Accepts::at_least(1), {1, 16},
                "Robots among which the best becomes a parent"),
      Parameter("elites", &AlgorithmSettings::elites, "", Accepts::between(0, 1), {0, 1},
                "ga: share that lives on unconditionally")
          .with_form("0..1"),
      Parameter("crossover", &AlgorithmSettings::crossover, "", Accepts::between(0, 1), {0, 1},
                "Share of the children with two parents")
          .with_form("0..1"),
      Parameter("niches", &AlgorithmSettings::niches, "", Accepts::between(0, 4096), {0, 1000},
                "map-elites, cma-me: cells of equal size, a centroidal Voronoi tessellation, in place of the cells of "
                "--axis"),
      Parameter("neighbors", &AlgorithmSettings::neighbors, "", Accepts::between(1, 10000), {1, 50},
                "novelty: nearest robots whose mean distance counts"),
      Parameter("archived", &AlgorithmSettings::archived, "", Accepts::between(0, 10000), {0, 50},
                "novelty: robots of each generation that come into the archive"),
      Parameter("age_layers", &AlgorithmSettings::age_layers, "", Accepts::between(1, 40), {2, 12},
                "alps: layers of ages"),
      Parameter(
          "age_gap", &AlgorithmSettings::age_gap, "", Accepts::between(1, 10000), {1, 20},
          "alps: generations below which robots are in the lowest layer; above it, 2, 4, 9, 16, ... times as many"),
      Parameter(
          "islands", &AlgorithmSettings::islands, "", Accepts::between(1, 1000), {1, 16},
          "ga, afpo, alps, nsga2, neat, random: islands into which the population is split, each with parents of its "
          "own"),
      Parameter("migration_interval", &AlgorithmSettings::migration_interval, "", Accepts::between(0, 1e6), {0, 50},
                "islands: generations from one migration to the next; 0 = none"),
      Parameter("migrants", &AlgorithmSettings::migrants, "", Accepts::between(1, 1e6), {1, 16},
                "islands: best robots of each island whose copies replace the worst of the next one"),
      Parameter("species_distance", &AlgorithmSettings::species_distance, "", Accepts::above_zero, {0.1f, 10},
                "neat: distance of brains below which robots are of one species"),
      Parameter("species", &AlgorithmSettings::species, "", Accepts::between(1, 10000), {1, 50},
                "neat: species at most; where there would be more, their distance grows"),
      Parameter("stagnation", &AlgorithmSettings::stagnation, "", Accepts::between(0, 1e6), {0, 50},
                "neat: generations without a better robot after which a species dies out; 0 = none does")};
};

// What a child is made from: indices of its parents among the living. None = a new random genome. Algorithms that
// search among numbers give these (Genome::with_numbers), or none for the genome with which the search begins; then the
// parent is that of the lineage alone.
struct ChildPlan {
  std::vector<std::size_t> parents;
  std::vector<double> numbers;
  std::size_t island = 0;   // on which it is born
  bool is_migrant = false;  // a copy of its one parent, which is of another island
};

class Algorithm {
 public:
  virtual ~Algorithm() = default;

  // The children of the next generation. Depends on the arguments alone.
  virtual std::vector<ChildPlan> plan(std::span<const Individual> living, std::size_t children,
                                      Random& random) const = 0;
  // Who lives on: indices in `pool`, which holds the living (the first `living` of it) and then their children, all
  // assessed; the best first. In generation 0, `living` is 0. The order of equal ones is that of their ids.
  virtual std::vector<std::size_t> survivors(std::span<const Individual> pool, std::size_t living) const = 0;

  // Into how many species it divides individuals; 0 if it has none.
  virtual std::size_t species(std::span<const Individual> /*living*/) const { return 0; }

  // Of algorithms that learn; others have nothing to do.
  // Begins: at these numbers, with children about `step` from them in each, if it searches among numbers.
  virtual void begin(std::span<const double> /*numbers*/, double /*step*/) {}
  // Learns from the children that plan() gave, in its order, assessed, and with `random` as plan() had it. Called after
  // each generation; when a run goes on, after begin(), for each generation that it has.
  virtual void learn(std::span<const Individual> /*born*/, Random /*random*/) {}
};

struct AlgorithmDescription {
  std::string_view name, help;
  bool many_objectives = false;  // whether it takes more than one
  bool of_numbers = false;       // whether it searches among numbers: its genomes need Genome::numbers()
  bool of_behavior = false;      // whether it needs axes
  bool of_species = false;       // whether its genomes need Genome::distance()
  bool has_map = false;          // whether the best of each cell of a map live on
  bool learns = false;           // whether it knows more than the living
  std::unique_ptr<Algorithm> (*make)(const AlgorithmSettings& settings) = nullptr;
};
// ga, afpo, alps, nsga2, map-elites, novelty, neat, cma-es, sep-cma-es, cma-me, random.
std::span<const AlgorithmDescription> algorithms();
// Throws ParameterError("algorithm", ...) for an unknown name. Custom ones (mercury/custom.h) have one description.
const AlgorithmDescription& algorithm_named(std::string_view name);
// The same for these settings: a custom algorithm with axes has a map.
const AlgorithmDescription& algorithm_of(const AlgorithmSettings& settings);
// An axis of this quantity with its usual ends; none if there is no such quantity.
std::optional<MapAxis> usual_axis(std::string_view quantity);
// Chooses the usual algorithm for the axes and that many objectives, unless one is named, and the usual axes where it
// needs some and there are none. Throws ParameterError("algorithm", ...) for an unknown name.
void complete_algorithm(AlgorithmSettings& settings, bool is_named, std::size_t objectives);
// Throws ParameterError("algorithm", ...) for an unknown name, or ("population", ...), ("axes", ...) and so on for
// settings out of range.
std::unique_ptr<Algorithm> make_algorithm(const AlgorithmSettings& settings);

// The cell of an individual in a map of elites, counted with the first axis fastest; `values` as in Assessment.
std::size_t map_cell(std::span<const MapAxis> axes, std::span<const double> values);
// How many cells the map of map-elites and cma-me has.
std::size_t map_cells(const AlgorithmSettings& settings);

}  // namespace mercury
