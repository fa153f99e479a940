// SPDX-License-Identifier: Apache-2.0
// The loop of generations on a search whose optimum is known.
#include "mercury/evolution.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "mercury/error.h"
#include "tests/evolution/vector_genome.h"
#include "tests/refusal.h"

namespace mercury {
namespace {

EvolutionSettings settings_of(std::string_view algorithm, std::uint64_t seed = 1) {
  EvolutionSettings settings;
  settings.algorithm.name = algorithm;
  settings.algorithm.population = 32;
  settings.algorithm.axes = {{.quantity = "size", .lowest = -1, .highest = 1, .cells = 5},
                             {.quantity = "symmetry", .lowest = -1, .highest = 1, .cells = 5}};
  settings.generations = 30;
  settings.seed = seed;
  return settings;
}

double best_score(std::string_view algorithm, std::uint64_t seed) {
  const VectorSpace space;
  VectorAssessor assessor;
  Evolution evolution(settings_of(algorithm, seed), space);
  run(evolution, assessor);
  EXPECT_EQ(assessor.count(), 32u * 31) << algorithm;
  return evolution.living().front().score();
}

class AnyEvolution : public testing::TestWithParam<std::string_view> {};

std::string suite_name(const testing::TestParamInfo<std::string_view>& test) {
  std::string name(test.param);
  std::ranges::replace(name, '-', '_');
  return name;
}
INSTANTIATE_TEST_SUITE_P(Algorithms, AnyEvolution,
                         testing::Values("ga", "afpo", "alps", "nsga2", "map-elites", "novelty", "neat", "cma-es",
                                         "sep-cma-es", "cma-me", "random"),
                         suite_name);

// Algorithms whose children have parents.
class Inheritance : public testing::TestWithParam<std::string_view> {};
INSTANTIATE_TEST_SUITE_P(Algorithms, Inheritance,
                         testing::Values("ga", "afpo", "alps", "nsga2", "map-elites", "neat", "cma-es", "sep-cma-es"),
                         suite_name);

// The squared distance to the optimum that is left is less than half of what random search leaves.
TEST_P(Inheritance, BeatsRandomSearchAtAsManyTrials) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed)
    EXPECT_GT(best_score(GetParam(), seed), best_score("random", seed) / 2) << seed;
}

// The sum over the cells of a map of how much better their elites are than the worst score possible in it.
double map_quality(std::string_view algorithm, std::uint64_t seed) {
  const VectorSpace space;
  VectorAssessor assessor;
  EvolutionSettings settings = settings_of(algorithm, seed);
  settings.algorithm.population = 72;  // two emitters
  for (MapAxis& axis : settings.algorithm.axes) axis.cells = 20;
  Evolution evolution(settings, space);
  run(evolution, assessor);
  constexpr double worst = -8 * 1.5 * 1.5;
  double sum = 0;
  for (const Individual& elite : evolution.living()) sum += std::max(0.0, elite.score() - worst);
  return sum;
}

// Fontaine et al. 2020 find that emitters fill the map of a sphere better than mutations at as many trials; so it is
// here, by the median of five seeds.
TEST(CmaMe, FillsAMapBetterThanMutations) {
  std::vector<double> gains;
  for (std::uint64_t seed = 1; seed <= 5; ++seed)
    gains.push_back(map_quality("cma-me", seed) / map_quality("map-elites", seed));
  std::ranges::sort(gains);
  EXPECT_GT(gains[2], 1) << gains[0] << " to " << gains[4];
}

TEST_P(AnyEvolution, TheBestNeverGetsWorse) {
  const VectorSpace space;
  VectorAssessor assessor;
  Evolution evolution(settings_of(GetParam()), space);
  double best = worst_score;
  while (evolution.advance(assessor)) {
    EXPECT_GE(evolution.living().front().score(), best);
    best = evolution.living().front().score();
  }
}

TEST_P(AnyEvolution, AnEvolutionThatIsRestoredGoesOnBitForBit) {
  const VectorSpace space;
  const EvolutionSettings settings = settings_of(GetParam());
  const std::vector<Generation> whole = run(settings);
  VectorAssessor assessor;
  // Interrupted after every generation: the next one is made by an evolution that knows what files would hold: the
  // genomes of the living, and of all the rest.
  std::vector<Individual> living, born;
  for (int number = 0; number <= settings.generations; ++number) {
    Evolution evolution(settings, space);
    if (number > 0) evolution.restore(number - 1, living, born);
    EXPECT_EQ(evolution.next_generation(), number);
    const std::optional<Generation> generation = evolution.advance(assessor);
    ASSERT_TRUE(generation);
    EXPECT_EQ(*generation, whole.at(static_cast<std::size_t>(number)));
    living = evolution.living();
    for (Individual& individual : living) individual.genome = space.decode(individual.genome->encode());
    for (Individual individual : generation->born) {
      individual.genome = nullptr;
      born.push_back(individual);
    }
  }
}

// Algorithms that need the scores of a generation only for the next but one.
class Pipelined : public testing::TestWithParam<std::string_view> {
 protected:
  static EvolutionSettings settings() {
    EvolutionSettings settings = settings_of(GetParam());
    settings.pipelined = true;
    return settings;
  }
};
INSTANTIATE_TEST_SUITE_P(Algorithms, Pipelined,
                         testing::Values("ga", "afpo", "alps", "nsga2", "map-elites", "neat", "random"), suite_name);

TEST_P(Pipelined, ParentsAreThoseWhoLivedAfterTheGenerationBeforeTheLast) {
  const std::vector<Generation> generations = run(settings());
  ASSERT_EQ(generations.size(), 31u);
  std::size_t parents = 0;
  for (std::size_t n = 1; n < generations.size(); ++n) {
    const std::vector<std::uint64_t>& living = generations[n < 2 ? 0 : n - 2].living;
    for (const Individual& child : generations[n].born)
      for (const std::uint64_t parent : child.parents) {
        EXPECT_NE(std::ranges::find(living, parent), living.end()) << n;
        ++parents;
      }
  }
  EXPECT_EQ(parents == 0, GetParam() == "random");
}

TEST_P(Pipelined, IsBetterThanRandomSearchAtAsManyTrials) {
  if (GetParam() == "random") return;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    EvolutionSettings settings = Pipelined::settings();
    settings.seed = seed;
    double best = worst_score;
    for (const Generation& generation : run(settings))
      for (const Individual& child : generation.born) best = std::max(best, child.score());
    EXPECT_GT(best, best_score("random", seed)) << seed;
  }
}

// As files hold it: those who live after the last generation and after the one before.
TEST_P(Pipelined, AnEvolutionThatIsRestoredGoesOnBitForBit) { expect_the_same_when_restored(settings()); }

// An assessor that refuses to go on, once per generation.
class Interrupting : public VectorAssessor {
 public:
  std::optional<std::vector<Assessment>> assess(std::span<const GenomePointer> candidates,
                                                std::span<const double> limits, const Watch& watch) override {
    refuses_ = !refuses_;
    return refuses_ ? std::nullopt : VectorAssessor::assess(candidates, limits, watch);
  }

 private:
  bool refuses_ = false;
};

TEST_P(Pipelined, AnInterruptedGenerationIsMadeAgain) {
  const VectorSpace space;
  const std::vector<Generation> whole = run(settings());
  Interrupting assessor;
  Evolution evolution(settings(), space);
  for (const Generation& expected : whole) {
    EXPECT_FALSE(evolution.advance(assessor));
    EXPECT_EQ(evolution.advance(assessor), expected);
  }
}

TEST(Pipelined, AlgorithmsThatLearnAreRefused) {
  EvolutionSettings settings = settings_of("cma-es");
  settings.pipelined = true;
  EXPECT_EQ(refusal<ParameterError>([&] { validate(settings); }),
            "pipelined: cma-es learns from each generation before it makes the next; leave it out");
}

TEST_P(AnyEvolution, TheLineageDoesNotDependOnThreads) {
  const auto lineage = [&](std::size_t threads) {
    const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism, threads);
    return run(settings_of(GetParam()));
  };
  const std::vector<Generation> one = lineage(1);
  EXPECT_EQ(one, lineage(2));
  EXPECT_EQ(one, lineage(7));
}

TEST_P(AnyEvolution, SeedsGiveOtherLineages) {
  EXPECT_NE(run(settings_of(GetParam(), 1)), run(settings_of(GetParam(), 2)));
}

TEST_P(AnyEvolution, ChildrenDifferFromEachOtherAndFromTheLiving) {
  const VectorSpace space;
  VectorAssessor assessor;
  Evolution evolution(settings_of(GetParam()), space);
  while (!evolution.is_over()) {
    std::set<std::uint64_t> identities;
    for (const Individual& individual : evolution.living()) identities.insert(individual.genome->identity());
    const std::size_t before = identities.size();
    const std::vector<Individual> children = evolution.children();
    for (const Individual& child : children) identities.insert(child.genome->identity());
    EXPECT_EQ(identities.size(), before + children.size());
    evolution.advance(assessor);
  }
}

TEST_P(AnyEvolution, EveryChildHasItsPlaceInTheLineage) {
  std::map<std::uint64_t, Individual> known;
  std::set<std::uint64_t> alive;
  for (const Generation& generation : run(settings_of(GetParam()))) {
    for (const Individual& child : generation.born) {
      EXPECT_EQ(child.id, known.size());
      EXPECT_EQ(child.generation, generation.number);
      int began = generation.number;
      for (const std::uint64_t parent : child.parents) {
        EXPECT_TRUE(alive.contains(parent));
        began = std::min(began, known.at(parent).line_began);
      }
      EXPECT_EQ(child.line_began, began);
      known.emplace(child.id, child);
    }
    for (const Individual& child : generation.born) alive.insert(child.id);
    for (const std::uint64_t id : generation.living) EXPECT_TRUE(alive.contains(id));
    alive = {generation.living.begin(), generation.living.end()};
  }
}

TEST_P(AnyEvolution, GenomesThatDoNotExistAndRobotsThatFailAreBorne) {
  const VectorSpace space(8, 3);  // every third random genome is refused
  VectorAssessor assessor(1, 4);  // every fourth robot fails
  Evolution evolution(settings_of(GetParam()), space);
  const std::vector<Generation> generations = run(evolution, assessor);
  EXPECT_EQ(generations.size(), 31u);
  std::size_t failed = 0, born = 0;
  for (const Generation& generation : generations) {
    EXPECT_EQ(generation.born.size(), 32u);  // what is refused is drawn again
    born += generation.born.size();
    failed += static_cast<std::size_t>(std::ranges::count(
        generation.born, Fate::failed, [](const Individual& child) { return child.assessment.fate; }));
  }
  EXPECT_GT(failed, born / 8);
  EXPECT_EQ(evolution.living().front().assessment.fate, Fate::sound);
}

TEST(Evolution, NothingChangesIfTheWatchSaysToStop) {
  const VectorSpace space;
  VectorAssessor assessor;
  const EvolutionSettings settings = settings_of("ga");
  Evolution evolution(settings, space);
  std::vector<Generation> generations;
  for (int attempt = 0; !evolution.is_over(); ++attempt) {
    const Watch watch = [&](std::size_t done, std::size_t) { return attempt % 2 == 1 || done < 10; };
    const std::optional<Generation> generation = evolution.advance(assessor, watch);
    EXPECT_EQ(generation.has_value(), attempt % 2 == 1);
    if (generation) generations.push_back(*generation);
  }
  EXPECT_EQ(generations, run(settings));
}

// Making thousands of children may take longer than their trials.
TEST(Evolution, TheWatchIsCalledWhileChildrenAreMade) {
  const VectorSpace space;
  EvolutionSettings settings = settings_of("ga");
  settings.algorithm.population = 1000;
  int calls = 0;
  const std::size_t made = Evolution(settings, space)
                               .children([&](std::size_t done, std::size_t all) {
                                 EXPECT_EQ(done, 0u);
                                 EXPECT_EQ(all, 1000u);
                                 ++calls;
                                 return true;
                               })
                               .size();
  EXPECT_EQ(made, 1000u);
  EXPECT_GE(calls, 4);
}

TEST(Evolution, MoreGenerationsContinueAShorterRun) {
  EvolutionSettings settings = settings_of("afpo");
  const std::vector<Generation> longer = run(settings);
  settings.generations = 10;
  const std::vector<Generation> shorter = run(settings);
  ASSERT_EQ(shorter.size(), 11u);
  EXPECT_TRUE(std::equal(shorter.begin(), shorter.end(), longer.begin()));
}

TEST(Evolution, TwoObjectivesGiveAFrontBetweenBothOptima) {
  EvolutionSettings settings = settings_of("nsga2");
  settings.objectives = {"distance", "-strain"};
  const VectorSpace space(3);
  VectorAssessor assessor(2);
  Evolution evolution(settings, space);
  run(evolution, assessor);
  // The optima are sqrt(3) apart. On the line between them the roots of both scores add up to that; elsewhere to more.
  const double apart = std::sqrt(3.0);
  double least = apart, most = 0;
  for (const Individual& individual : evolution.living()) {
    const double a = std::sqrt(-individual.assessment.scores[0]), b = std::sqrt(-individual.assessment.scores[1]);
    EXPECT_GE(a + b, apart - 1e-9);
    EXPECT_LT(a + b, 1.15 * apart);
    least = std::min(least, a);
    most = std::max(most, a);
  }
  EXPECT_LT(least, 0.2 * apart);  // both ends of the front are there
  EXPECT_GT(most, 0.8 * apart);
}

TEST(Evolution, ASpaceOfOneGenomeIsSearchedInBoundedTime) {
  class One : public VectorSpace {
   public:
    GenomePointer random(std::uint64_t, std::uint64_t) const override {
      class Constant : public VectorGenome {
       public:
        Constant() : VectorGenome(std::vector<double>(8, 0.25)) {}
        GenomePointer mutate(double, std::uint64_t) const override { return std::make_shared<Constant>(); }
      };
      return std::make_shared<Constant>();
    }
  };
  for (const Generation& generation : run(settings_of("ga"), One())) EXPECT_EQ(generation.born.size(), 32u);
}

// A try for a child unlike the others may find no genome at all; then the child that was there before lives.
TEST(Evolution, AChildOutlivesALaterTryThatFails) {
  class FailsLater : public VectorSpace {
   public:
    GenomePointer random(std::uint64_t, std::uint64_t) const override {
      if (++made_ > 32) throw InputError("genome", "there is none");
      return std::make_shared<VectorGenome>(std::vector<double>(8, 0.25));
    }

   private:
    mutable std::atomic<int> made_ = 0;
  };
  const FailsLater space;
  EXPECT_EQ(Evolution(settings_of("ga"), space).children().size(), 32u);
}

TEST(Evolution, AGenerationWithoutAnyGenomeIsReported) {
  const VectorSpace space(8, 1);  // none exists
  VectorAssessor assessor;
  Evolution evolution(settings_of("ga"), space);
  EXPECT_THROW(evolution.advance(assessor), InputError);
}

}  // namespace
}  // namespace mercury
