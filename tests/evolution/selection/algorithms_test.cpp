// SPDX-License-Identifier: Apache-2.0
// Algorithms against what their papers say, computed the long way.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "evolution/selection/behavior.h"
#include "evolution/selection/islands.h"
#include "mercury/algorithm.h"
#include "mercury/error.h"
#include "mercury/quantity.h"
#include "tests/evolution/vector_genome.h"
#include "tests/refusal.h"

namespace mercury {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::Ge;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Le;
using testing::UnorderedElementsAre;

constexpr double infinite = std::numeric_limits<double>::infinity();

Individual individual(std::uint64_t id, std::vector<double> scores, int line_began = 0) {
  Individual one{.id = id, .line_began = line_began};
  one.assessment = {.fate = Fate::sound, .scores = std::move(scores)};
  one.assessment.values.assign(quantities().size(), 0.0);
  return one;
}

// Ids that do not follow the places; equal scores, and some robots that came to grief.
std::vector<Individual> random_pool(std::size_t count, std::size_t objectives, std::uint64_t seed) {
  Random random(seed);
  std::vector<std::uint64_t> ids(count);
  for (std::size_t i = 0; i < count; ++i) ids[i] = i + 100;
  for (std::size_t i = count; i > 1; --i) std::swap(ids[i - 1], ids[random.below(i)]);
  std::vector<Individual> pool;
  for (std::size_t i = 0; i < count; ++i) {
    std::vector<double> scores(objectives);
    for (double& score : scores) score = static_cast<double>(random.below(12));
    pool.push_back(individual(ids[i], scores, static_cast<int>(random.below(8))));
    for (double& value : pool.back().assessment.values) value = random.uniform();
    if (random.chance(0.1)) {
      pool.back().assessment.scores.assign(objectives, worst_score);
      pool.back().assessment.fate = Fate::exploded;
    }
    if (random.chance(0.05)) {
      pool.back().assessment.scores.assign(objectives, worst_score);
      pool.back().assessment.values.clear();
      pool.back().assessment.fate = Fate::failed;
    }
  }
  return pool;
}

AlgorithmSettings algorithm_settings(std::string_view name, std::size_t population) {
  AlgorithmSettings settings{.name = std::string(name), .population = population};
  if (algorithm_named(name).of_behavior)
    settings.axes = {{.quantity = "size", .lowest = 0, .highest = 1, .cells = 4},
                     {.quantity = "symmetry", .lowest = 0, .highest = 1, .cells = 5}};
  return settings;
}

std::vector<std::uint64_t> ids_of(std::span<const Individual> pool, std::span<const std::size_t> indices) {
  std::vector<std::uint64_t> ids;
  for (const std::size_t i : indices) ids.push_back(pool[i].id);
  return ids;
}

bool scores_before(const Individual& a, const Individual& b) {
  return a.score() != b.score() ? a.score() > b.score() : a.id < b.id;
}

class EveryAlgorithm : public testing::TestWithParam<std::string_view> {
 protected:
  std::unique_ptr<Algorithm> make(std::size_t population) const {
    return make_algorithm(algorithm_settings(GetParam(), population));
  }
};

std::string algorithm_name(const testing::TestParamInfo<std::string_view>& test) {
  std::string name(test.param);
  std::ranges::replace(name, '-', '_');
  return name;
}
INSTANTIATE_TEST_SUITE_P(Algorithms, EveryAlgorithm,
                         testing::Values("ga", "afpo", "alps", "nsga2", "map-elites", "novelty", "neat", "cma-es",
                                         "sep-cma-es", "cma-me", "random"),
                         algorithm_name);

TEST_P(EveryAlgorithm, SurvivorsAreDifferentMembersOfThePoolTheBestFirst) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const std::size_t count = seed * 3;
    const std::vector<Individual> pool = random_pool(count, 1, seed);
    const std::vector<std::size_t> chosen = make(20)->survivors(pool, count / 2);
    EXPECT_THAT(chosen, testing::Each(testing::Lt(count)));
    EXPECT_EQ(std::set(chosen.begin(), chosen.end()).size(), chosen.size());
    ASSERT_THAT(chosen, testing::Not(IsEmpty()));
    if (!algorithm_named(GetParam()).has_map) {
      EXPECT_EQ(chosen.size(), std::min<std::size_t>(count, 20));
    }
    for (std::size_t k = 1; k < chosen.size(); ++k)
      EXPECT_GE(pool[chosen[k - 1]].score(), pool[chosen[k]].score()) << seed;
  }
}

TEST_P(EveryAlgorithm, TheBestOfThePoolLivesOn) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const std::vector<Individual> pool = random_pool(60, 1, seed);
    const double best = std::ranges::max_element(pool, {}, &Individual::score)->score();
    EXPECT_EQ(pool[make(20)->survivors(pool, 30).front()].score(), best);
  }
}

TEST_P(EveryAlgorithm, WhoLivesOnDoesNotDependOnTheOrderOfThePool) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    std::vector<Individual> pool = random_pool(50, 1, seed);
    const auto algorithm = make(15);
    const std::vector<std::uint64_t> before = ids_of(pool, algorithm->survivors(pool, 25));
    std::reverse(pool.begin(), pool.begin() + 25);
    std::reverse(pool.begin() + 25, pool.end());
    EXPECT_EQ(ids_of(pool, algorithm->survivors(pool, 25)), before);
  }
}

TEST_P(EveryAlgorithm, PoolsWithoutAnySoundRobotAreSurvived) {
  std::vector<Individual> pool;
  for (std::uint64_t id = 0; id < 10; ++id) {
    pool.push_back(individual(id, {worst_score}));
    pool.back().assessment.values.clear();
  }
  pool[3].assessment.scores.clear();  // of an assessor of another kind
  pool[4].assessment.scores = {std::nan("")};
  const std::vector<std::size_t> chosen = make(4)->survivors(pool, 5);
  EXPECT_THAT(chosen.size(), AllOf(Ge(1u), Le(4u)));
  Random random(1);
  EXPECT_EQ(make(4)->plan(pool, 6, random).size(), 6u);
}

TEST_P(EveryAlgorithm, AnEmptyPoolLeavesNobodyAndThenAllIsRandom) {
  Random random(1);
  EXPECT_THAT(make(4)->survivors({}, 0), IsEmpty());
  for (const ChildPlan& plan : make(4)->plan({}, 6, random)) EXPECT_THAT(plan.parents, IsEmpty());
}

TEST_P(EveryAlgorithm, PlansDependOnTheirArgumentsAlone) {
  const std::vector<Individual> living = random_pool(30, 1, 1);
  const auto parents = [&](std::uint64_t seed) {
    Random random(seed);
    std::vector<std::vector<std::size_t>> all;
    for (const ChildPlan& plan : make(30)->plan(living, 40, random)) all.push_back(plan.parents);
    return all;
  };
  EXPECT_EQ(parents(1), parents(1));
  if (GetParam() != "random" && !algorithm_named(GetParam()).of_numbers) {
    EXPECT_NE(parents(1), parents(2));
  }
}

// Algorithms whose children have parents.
class Parents : public EveryAlgorithm {};
INSTANTIATE_TEST_SUITE_P(Algorithms, Parents, testing::Values("ga", "afpo", "nsga2", "map-elites", "novelty"),
                         algorithm_name);

TEST_P(Parents, AreTwoForTheShareOfChildrenThatIsSet) {
  const std::vector<Individual> living = random_pool(30, 1, 1);
  AlgorithmSettings settings = algorithm_settings(GetParam(), 30);
  for (const double share : {0.0, 0.3, 1.0}) {
    settings.crossover = share;
    Random random(1);
    const double children = 10'000;
    double crossed = 0;
    for (const ChildPlan& plan : make_algorithm(settings)->plan(living, 10'000, random)) {
      EXPECT_THAT(plan.parents, testing::Each(testing::Lt(living.size())));
      EXPECT_LE(plan.parents.size(), 2u);
      if (plan.parents.size() < 2) continue;
      ++crossed;
      EXPECT_NE(plan.parents[0], plan.parents[1]);
    }
    // Five standard deviations of the binomial distribution; one child of afpo is random.
    EXPECT_NEAR(crossed, share * children, 5 * std::sqrt(share * (1 - share) * children) + 1);
  }
}

TEST_P(Parents, OneIsEnough) {
  const std::vector<Individual> living = random_pool(1, 1, 1);
  AlgorithmSettings settings = algorithm_settings(GetParam(), 30);
  settings.crossover = 1;
  Random random(1);
  for (const ChildPlan& plan : make_algorithm(settings)->plan(living, 10, random)) EXPECT_LE(plan.parents.size(), 1u);
}

TEST(GeneticAlgorithm, KeepsItsEliteAndTheBestChildren) {
  AlgorithmSettings settings{.name = "ga", .population = 4, .elites = 0.5};
  const std::vector<Individual> pool{individual(0, {9}), individual(1, {8}), individual(2, {7}), individual(3, {6}),
                                     individual(4, {1}), individual(5, {3}), individual(6, {2}), individual(7, {0})};
  EXPECT_THAT(make_algorithm(settings)->survivors(pool, 4), ElementsAre(0, 1, 5, 6));
  settings.elites = 0;
  EXPECT_THAT(make_algorithm(settings)->survivors(pool, 4), ElementsAre(5, 6, 4, 7));
  settings.elites = 1;
  EXPECT_THAT(make_algorithm(settings)->survivors(pool, 4), ElementsAre(0, 1, 2, 3));
  settings.elites = 0.5;
  EXPECT_THAT(make_algorithm(settings)->survivors(std::span(pool).first(5), 4), ElementsAre(0, 1, 2, 4));
}

// Of n, the best of k drawn with replacement is the one of rank r (from 0) with probability
// ((n - r)^k - (n - r - 1)^k) / n^k.
TEST(GeneticAlgorithm, ParentsWinTournamentsAsOftenAsTheorySays) {
  const std::size_t n = 10;
  std::vector<Individual> living;
  for (std::size_t i = 0; i < n; ++i) living.push_back(individual(i, {-static_cast<double>(i)}));
  for (const int k : {1, 2, 4}) {
    Random random(1);
    const double children = 100'000;
    std::vector<double> counts(n);
    const auto algorithm = make_algorithm({.name = "ga", .population = n, .tournament = k, .crossover = 0});
    for (const ChildPlan& plan : algorithm->plan(living, 100'000, random)) ++counts[plan.parents.at(0)];
    for (std::size_t r = 0; r < n; ++r) {
      const double size = static_cast<double>(n), rank = static_cast<double>(r);
      const double p = (std::pow(size - rank, k) - std::pow(size - rank - 1, k)) / std::pow(size, k);
      EXPECT_NEAR(counts[r], p * children, 5 * std::sqrt(p * (1 - p) * children) + 1) << k << " " << r;
    }
  }
}

// (age, score) by definition: younger is better, and of equal ones the lower id.
bool afpo_dominates(const Individual& a, const Individual& b) {
  if (a.line_began == b.line_began && a.score() == b.score()) return a.id < b.id;
  return a.line_began >= b.line_began && scores_before(a, b);
}

TEST(AgeFitnessPareto, FrontsOfAgeAndScoreLiveOn) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const std::vector<Individual> pool = random_pool(60, 1, seed);
    std::vector<const Individual*> left;
    for (const Individual& one : pool) left.push_back(&one);
    std::vector<std::uint64_t> expected;
    const std::size_t population = 25;
    while (expected.size() < population) {
      std::vector<const Individual*> front, rest;
      for (const Individual* one : left) {
        const bool goes = std::ranges::any_of(left, [&](const auto* other) { return afpo_dominates(*other, *one); });
        (goes ? rest : front).push_back(one);
      }
      std::ranges::sort(front, [](const auto* a, const auto* b) { return scores_before(*a, *b); });
      for (const Individual* one : front)
        if (expected.size() < population) expected.push_back(one->id);
      left = rest;
    }
    const auto algorithm = make_algorithm({.name = "afpo", .population = population});
    EXPECT_THAT(ids_of(pool, algorithm->survivors(pool, 30)), testing::UnorderedElementsAreArray(expected));
  }
}

TEST(AgeFitnessPareto, OneChildIsRandomAndLivesOnHoweverBad) {
  const auto algorithm = make_algorithm({.name = "afpo", .population = 10});
  std::vector<Individual> pool;
  for (std::uint64_t id = 0; id < 10; ++id) pool.push_back(individual(id, {100.0 + static_cast<double>(id)}));
  Random random(1);
  const std::vector<ChildPlan> plans = algorithm->plan(pool, 10, random);
  EXPECT_EQ(std::ranges::count_if(plans, [](const ChildPlan& plan) { return plan.parents.empty(); }), 1);
  for (const ChildPlan& plan : plans)
    pool.push_back(individual(pool.size(), {plan.parents.empty() ? -5.0 : 50.0}, plan.parents.empty() ? 1 : 0));
  EXPECT_THAT(ids_of(pool, algorithm->survivors(pool, 10)), testing::Contains(19));
}

TEST(Nsga2, FrontsThenCrowdingDecide) {
  // Front 0 is (0, 4), (1, 3), (3, 1), (4, 0); front 1 is (0, 3), (2, 1), (3, 0) and (1, 2). Three of front 1 fit:
  // both ends, and then the one whose neighbors are further apart. (1, 2): (2 + 2) / 3; (2, 1): (2 + 2) / 3, the same;
  // the better first score wins.
  const std::vector<Individual> pool{individual(0, {0, 4}), individual(1, {0, 3}), individual(2, {1, 3}),
                                     individual(3, {1, 2}), individual(4, {2, 1}), individual(5, {3, 1}),
                                     individual(6, {3, 0}), individual(7, {4, 0}), individual(8, {-1, -1})};
  EXPECT_THAT(make_algorithm({.name = "nsga2", .population = 7})->survivors(pool, 4), ElementsAre(7, 0, 5, 2, 6, 1, 4));
}

// By definition: the rank of a point is the length of the longest chain of points that dominate each other down to it.
TEST(Nsga2, LowerFrontsGoFirstAndWholeFrontsStay) {
  const auto beats = [](const Individual& a, const Individual& b) {
    const auto& x = a.assessment.scores;
    const auto& y = b.assessment.scores;
    return x != y && std::ranges::equal(x, y, std::ranges::greater_equal());
  };
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const std::vector<Individual> pool = random_pool(60, 1 + seed % 3, seed);
    std::vector<int> rank(pool.size(), 0);
    for (std::size_t pass = 0; pass < pool.size(); ++pass)
      for (std::size_t a = 0; a < pool.size(); ++a)
        for (std::size_t b = 0; b < pool.size(); ++b)
          if (beats(pool[a], pool[b])) rank[b] = std::max(rank[b], rank[a] + 1);
    const std::vector<std::size_t> chosen = make_algorithm({.name = "nsga2", .population = 30})->survivors(pool, 30);
    EXPECT_TRUE(std::ranges::is_sorted(chosen, {}, [&](std::size_t i) { return rank[i]; }));
    const int last = rank[chosen.back()];
    for (std::size_t i = 0; i < pool.size(); ++i)
      EXPECT_EQ(std::ranges::count(chosen, i), rank[i] < last ? 1 : rank[i] > last ? 0 : std::ranges::count(chosen, i));
  }
}

TEST(Nsga2, EndsOfTheFirstFrontAreParentsMoreOftenThanTheRest) {
  std::vector<Individual> living;
  for (std::uint64_t i = 0; i < 10; ++i) {
    const auto x = static_cast<double>(i);
    living.push_back(individual(i, {x, 9 - x}));
    living.push_back(individual(10 + i, {x - 20, -11 - x}));
  }
  Random random(1);
  std::map<std::size_t, int> count;
  const auto algorithm = make_algorithm({.name = "nsga2", .population = 20, .crossover = 0});
  for (const ChildPlan& plan : algorithm->plan(living, 40'000, random)) ++count[plan.parents[0]];
  // A binary tournament over 20: whoever beats all of them wins 39/400 of them, the next one 37/400.
  EXPECT_NEAR(count[0], 3900, 5 * std::sqrt(3900));
  EXPECT_NEAR(count[18], 3700, 5 * std::sqrt(3700));
  // All of the first front together: 3/4.
  int first_front = 0;
  for (const auto& [i, n] : count)
    if (i % 2 == 0) first_front += n;
  EXPECT_NEAR(first_front, 30'000, 5 * std::sqrt(40'000 * 0.75 * 0.25));
}

TEST(MapElites, KeepsTheBestOfEachCell) {
  const AlgorithmSettings settings = algorithm_settings("map-elites", 10);
  const std::size_t size = find_quantity("size").value(), symmetry = find_quantity("symmetry").value();
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const std::vector<Individual> pool = random_pool(80, 1, seed);
    std::map<std::pair<int, int>, const Individual*> best;
    for (const Individual& one : pool) {
      if (one.score() == worst_score) continue;
      const auto& values = one.assessment.values;
      const Individual*& elite = best[{static_cast<int>(values[size] * 4), static_cast<int>(values[symmetry] * 5)}];
      if (!elite || scores_before(one, *elite)) elite = &one;
    }
    std::vector<std::uint64_t> expected;
    for (const auto& [cell, elite] : best) expected.push_back(elite->id);
    EXPECT_THAT(ids_of(pool, make_algorithm(settings)->survivors(pool, 40)),
                testing::UnorderedElementsAreArray(expected));
  }
}

TEST(MapElites, CellsAreCountedWithTheFirstAxisFastestAndEndAtTheLastOne) {
  const std::vector<MapAxis> axes{{.quantity = "size", .lowest = -1, .highest = 1, .cells = 4},
                                  {.quantity = "strain", .lowest = 0, .highest = 2, .cells = 3}};
  const auto cell = [&](double size, double strain) {
    std::vector<double> values(quantities().size(), 0);
    values[find_quantity("size").value()] = size;
    values[find_quantity("strain").value()] = strain;
    return map_cell(axes, values);
  };
  EXPECT_EQ(cell(-1, 0), 0u);
  EXPECT_EQ(cell(-0.4, 0), 1u);
  EXPECT_EQ(cell(0, 0), 2u);
  EXPECT_EQ(cell(0, 0.7), 6u);
  EXPECT_EQ(cell(1, 2), 11u);
  EXPECT_EQ(cell(infinite, 1e300), 11u);
  EXPECT_EQ(cell(-infinite, -1e300), 0u);
  EXPECT_EQ(cell(std::nan(""), 2), 8u);
}

TEST(MapElites, EveryEliteIsAsLikelyAParent) {
  const std::vector<Individual> living = random_pool(10, 1, 1);
  AlgorithmSettings settings = algorithm_settings("map-elites", 10);
  settings.crossover = 0;
  Random random(1);
  std::vector<int> count(10);
  for (const ChildPlan& plan : make_algorithm(settings)->plan(living, 10'000, random)) ++count[plan.parents.at(0)];
  EXPECT_THAT(count, testing::Each(AllOf(Ge(850), Le(1150))));  // five standard deviations of 30
}

// Voronoi cells are centroidal if each point is the mean of what is nearest to it, here of other samples than those it
// was made from.
TEST(MapElites, NichesAreEqualCellsOfWhichEachPointIsTheMiddle) {
  constexpr std::size_t cells = 16, samples = 80'000;
  for (const std::size_t dimensions : {1u, 2u, 3u}) {
    const std::vector<Behavior> centers = centroids(dimensions, cells);
    ASSERT_EQ(centers.size(), cells);
    std::vector<Behavior> sums(cells, Behavior(dimensions, 0));
    std::vector<double> counts(cells, 0);
    Random random(7);
    for (std::size_t i = 0; i < samples; ++i) {
      Behavior point(dimensions);
      for (double& value : point) value = random.uniform();
      const std::size_t cell = nearest_of(centers, point);
      for (const Behavior& center : centers)
        ASSERT_LE(squared_distance(centers[cell], point), squared_distance(center, point));
      ++counts[cell];
      for (std::size_t k = 0; k < dimensions; ++k) sums[cell][k] += point[k];
    }
    const double width = std::pow(1.0 / cells, 1.0 / static_cast<double>(dimensions));
    for (std::size_t cell = 0; cell < cells; ++cell) {
      EXPECT_NEAR(counts[cell] * cells / samples, 1, 0.6) << dimensions;
      for (std::size_t k = 0; k < dimensions; ++k)
        EXPECT_NEAR(sums[cell][k] / counts[cell], centers[cell][k], 0.2 * width) << dimensions;
    }
  }
  EXPECT_EQ(centroids(3, 5), centroids(3, 5));
}

TEST(MapElites, KeepsTheBestOfEachNiche) {
  AlgorithmSettings settings = algorithm_settings("map-elites", 10);
  settings.niches = 12;
  EXPECT_EQ(map_cells(settings), 12u);
  const std::vector<Behavior> centers = centroids(2, 12);
  const std::size_t size = find_quantity("size").value(), symmetry = find_quantity("symmetry").value();
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const std::vector<Individual> pool = random_pool(80, 1, seed);
    std::map<std::size_t, const Individual*> best;
    for (const Individual& one : pool) {
      if (one.score() == worst_score) continue;
      const auto& values = one.assessment.values;
      const Individual*& elite = best[nearest_of(centers, Behavior{values[size], values[symmetry]})];
      if (!elite || scores_before(one, *elite)) elite = &one;
    }
    std::vector<std::uint64_t> expected;
    for (const auto& [cell, elite] : best) expected.push_back(elite->id);
    EXPECT_THAT(ids_of(pool, make_algorithm(settings)->survivors(pool, 40)),
                testing::UnorderedElementsAreArray(expected));
  }
}

// One axis, on which robots stand at these places.
std::vector<Individual> line_of(const std::vector<double>& places) {
  std::vector<Individual> pool;
  for (const double place : places) {
    pool.push_back(individual(pool.size(), {static_cast<double>(pool.size())}));
    pool.back().assessment.values[find_quantity("size").value()] = place;
  }
  return pool;
}

AlgorithmSettings novelty_settings(std::size_t population, int neighbors) {
  return {.name = "novelty",
          .population = population,
          .axes = {{.quantity = "size", .lowest = 0, .highest = 1}},
          .neighbors = neighbors,
          .archived = 2};
}

TEST(Novelty, IsTheMeanDistanceFromTheNearestNeighbors) {
  // With two neighbors: 0: (0.1 + 0.3) / 2, 0.1: (0.1 + 0.2) / 2, 0.3: (0.2 + 0.3) / 2, 1: (0.7 + 0.9) / 2.
  const std::vector<Individual> pool = line_of({0, 0.1, 0.3, 1});
  // The best by score is the last one, and it is the newest, too; then by novelty 0.3 and 0.
  EXPECT_THAT(make_algorithm(novelty_settings(3, 2))->survivors(pool, 0), ElementsAre(3, 2, 0));
  EXPECT_THAT(make_algorithm(novelty_settings(2, 2))->survivors(pool, 0), ElementsAre(3, 2));
  // With one neighbor, 0.3 is 0.2 away from another one, and 0 and 0.1 from each other 0.1.
  EXPECT_THAT(make_algorithm(novelty_settings(2, 1))->survivors(pool, 0), ElementsAre(3, 2));
}

TEST(Novelty, WhoIsNearToTheArchiveIsNotNew) {
  const std::vector<Individual> pool = line_of({0.9, 0.45, 0.1});  // the last one is the best, and stays
  const auto algorithm = make_algorithm(novelty_settings(2, 1));
  EXPECT_THAT(algorithm->survivors(pool, 0), ElementsAre(2, 0));
  algorithm->learn(line_of({0.8, 0.8}), Random(1));  // both come into the archive
  EXPECT_THAT(algorithm->survivors(pool, 0), ElementsAre(2, 1));
  algorithm->begin({}, 1);
  EXPECT_THAT(algorithm->survivors(pool, 0), ElementsAre(2, 0));
}

// Robots of these scores, whose lines began that many generations ago.
std::vector<Individual> aged(const std::vector<std::pair<double, int>>& scores_and_ages) {
  constexpr int now = 100;
  std::vector<Individual> pool;
  for (const auto& [score, age] : scores_and_ages) {
    pool.push_back(individual(pool.size(), {score}, now - age));
    pool.back().generation = now;
  }
  return pool;
}

TEST(Alps, RobotsCompeteWithinTheLayerOfTheirAge) {
  // Limits of age: 2, 4, none. One robot per layer.
  const AlgorithmSettings settings{.name = "alps", .population = 3, .age_layers = 3, .age_gap = 2};
  const auto algorithm = make_algorithm(settings);
  // The young one of score 1 stays beside older ones of more; of those in the upper layer, the best.
  EXPECT_THAT(algorithm->survivors(aged({{1, 0}, {5, 2}, {9, 4}, {8, 50}, {7, 4}}), 0), ElementsAre(2, 1, 0));
  // Whoever is not the best of a layer tries the next one: 6 goes up past 5 and then loses against 9.
  EXPECT_THAT(algorithm->survivors(aged({{7, 0}, {6, 1}, {5, 3}, {9, 10}}), 0), ElementsAre(3, 0, 1));
  // An empty layer is filled from below.
  EXPECT_THAT(algorithm->survivors(aged({{1, 0}, {2, 0}, {3, 0}, {4, 0}}), 0), ElementsAre(3, 2, 1));
  // The old ones do not come down.
  EXPECT_THAT(algorithm->survivors(aged({{1, 9}, {2, 9}, {3, 9}, {4, 9}}), 0), ElementsAre(3));
}

TEST(Alps, ParentsAreOfTheLayerOfTheChildOrTheOneBelowAndSomeChildrenAreNew) {
  AlgorithmSettings settings{.name = "alps", .population = 12, .age_layers = 3, .age_gap = 2};
  const auto algorithm = make_algorithm(settings);
  std::vector<std::pair<double, int>> robots;
  for (int i = 0; i < 12; ++i) robots.push_back({i, i < 4 ? 0 : i < 8 ? 3 : 20});
  const std::vector<Individual> living = aged(robots);
  Random random(3);
  const std::vector<ChildPlan> plans = algorithm->plan(living, 300, random);
  std::size_t fresh = 0;
  for (std::size_t i = 0; i < plans.size(); ++i) {
    fresh += plans[i].parents.empty();
    for (const std::size_t parent : plans[i].parents) {
      const std::size_t layer = parent / 4;
      EXPECT_TRUE(layer == i % 3 || layer + 1 == i % 3) << i;
    }
  }
  EXPECT_EQ(fresh, 2u);  // 4 robots of the lowest layer are replaced within 2 generations
}

// Robots whose distance is that of two numbers.
struct Placed {
  double place, score;
  int generation = 0;
};
std::vector<Individual> placed(const std::vector<Placed>& robots) {
  std::vector<Individual> pool;
  for (const Placed& robot : robots) {
    pool.push_back(individual(pool.size(), {robot.score}));
    pool.back().generation = robot.generation;
    pool.back().genome = std::make_shared<VectorGenome>(std::vector{robot.place});
  }
  return pool;
}
// How many of 600 children have each robot as a parent.
std::vector<std::size_t> children_of(const std::vector<Placed>& robots, AlgorithmSettings settings = {}) {
  settings.name = "neat";
  settings.crossover = 0;
  Random random(1);
  std::vector<std::size_t> children(robots.size());
  for (const ChildPlan& plan : make_algorithm(settings)->plan(placed(robots), 600, random))
    ++children[plan.parents.at(0)];
  return children;
}

// The paper's equation 2: a score counts divided by the number of robots of the species. One fifth of them are parents.
TEST(Neat, SpeciesHaveChildrenInProportionToTheMeanOfTheirScores) {
  EXPECT_THAT(children_of({{0, 6}, {1, 7}, {1, 5}, {2, 6}, {10, 3}, {20, 2}, {20, 4}}),
              ElementsAre(0, 300, 0, 0, 150, 0, 150));
  // Below 0, scores count from the lowest one; robots that came to grief count nothing.
  EXPECT_THAT(children_of({{0, -1}, {10, -3}, {10, -7}, {20, -7}, {20, worst_score}}), ElementsAre(450, 150, 0, 0, 0));
  EXPECT_THAT(children_of({{0, 0}, {10, 0}, {20, worst_score}}), ElementsAre(200, 200, 200));
  // Of shares that are no whole numbers, the largest remainders get the rest: 600 / 7 = 85.7.
  EXPECT_THAT(children_of({{0, 1}, {10, 5}, {20, 1}}), ElementsAre(86, 428, 86));
}

TEST(Neat, RobotsAreOfTheFirstSpeciesWhoseOldestMemberIsNear) {
  // 4 is near to 2, but not to 0, with whom 2 is; 6.9 is near to 4.
  EXPECT_THAT(children_of({{0, 1}, {2, 1}, {4, 2}, {6.9, 4}}), ElementsAre(150, 0, 0, 450));
  EXPECT_THAT(children_of({{0, 1}, {2, 1}, {4, 2}, {6.9, 4}}, {.species_distance = 2.5}), ElementsAre(86, 0, 171, 343));
  // Of 0, 10 and 20 there may be two: at 3 * 1.25^6 = 11.4, 10 joins 0.
  EXPECT_THAT(children_of({{0, 1}, {10, 3}, {20, 6}}, {.species = 2}), ElementsAre(0, 150, 450));
  EXPECT_THAT(children_of({{0, 1}, {1e30, 3}, {2e30, 6}}, {.species = 1}), ElementsAre(0, 0, 600));
}

TEST(Neat, ItsSpeciesAreCounted) {
  const auto species = [](const std::vector<Placed>& robots, AlgorithmSettings settings) {
    return make_algorithm(settings)->species(placed(robots));
  };
  EXPECT_EQ(species({{0, 1}, {2, 1}, {4, 2}, {6.9, 4}}, {.name = "neat"}), 2u);
  EXPECT_EQ(species({{0, 1}, {2, 1}, {4, 2}, {6.9, 4}}, {.name = "neat", .species_distance = 2.5}), 3u);
  EXPECT_EQ(species({{0, 1}, {10, 3}, {20, 6}}, {.name = "neat", .species = 2}), 2u);
  EXPECT_EQ(species({}, {.name = "neat"}), 0u);
  EXPECT_EQ(species({{0, 1}, {10, 3}}, {.name = "ga"}), 0u);
  // Robots of two islands are never of one species.
  std::vector<Individual> living = placed({{0, 1}, {1, 1}, {20, 2}, {1, 4}});
  living[3].island = 1;
  EXPECT_EQ(Islands({.name = "neat", .islands = 2}).species(living), 3u);
}

TEST(Neat, SpeciesThatDoNotImproveDieOutButForTheBest) {
  const AlgorithmSettings settings{.stagnation = 15};
  // 20 generations after, the best of the first species is 16 old, that of the second one 15, that of the third 20.
  const std::vector<Placed> robots{{0, 4, 4}, {10, 2, 5}, {20, 6, 0}, {1, 1, 20}, {11, 2, 20}, {21, 6, 20}};
  EXPECT_THAT(children_of(robots, settings), ElementsAre(0, 150, 450, 0, 0, 0));
  EXPECT_THAT(children_of(robots, {.stagnation = 0}), ElementsAre(143, 114, 343, 0, 0, 0));
  const auto algorithm = make_algorithm({.name = "neat", .population = 6, .stagnation = 15});
  EXPECT_THAT(algorithm->survivors(placed(robots), 3), ElementsAre(2, 5, 0, 1, 4, 3));  // there is room for all
  // Where the best of all is older than 20, the two best species go on alone.
  const std::vector<Placed> old{{0, 4, 0}, {10, 2, 21}, {20, 6, 0}, {30, 3, 21}};
  EXPECT_THAT(children_of(old, settings), ElementsAre(240, 0, 360, 0));
}

TEST(Neat, TheBestOfEachSpeciesLivesOnWithTheChildrenLessTheWorstOfTheLargest) {
  const auto algorithm = make_algorithm({.name = "neat", .population = 5});
  // 0 is the best of its species, 1 is not, 2 was surpassed by its child 4.
  const std::vector<Placed> robots{{0, 9, 0},  {0, 8, 0}, {10, 2, 0}, {1, 4, 1},
                                   {10, 3, 1}, {1, 5, 1}, {1, 6, 1},  {9, 1, 1}};
  EXPECT_THAT(algorithm->survivors(placed(robots), 3), ElementsAre(0, 6, 5, 4, 7));
}

TEST(RandomSearch, KeepsTheBestAndMakesRandomChildren) {
  const auto algorithm = make_algorithm({.name = "random", .population = 2});
  const std::vector<Individual> pool{individual(4, {1}), individual(3, {5}), individual(2, {5}), individual(1, {0})};
  EXPECT_THAT(algorithm->survivors(pool, 2), ElementsAre(2, 1));
  Random random(1);
  for (const ChildPlan& plan : algorithm->plan(pool, 5, random)) EXPECT_THAT(plan.parents, IsEmpty());
}

TEST(Algorithms, SettingsOutOfRangeAreNamed) {
  const auto parameter_of = [](const AlgorithmSettings& settings) {
    return refused_parameter([&] { make_algorithm(settings); });
  };
  const MapAxis good{.quantity = "size"};
  EXPECT_EQ(parameter_of({}), "");
  EXPECT_EQ(parameter_of({.name = "map-elites", .axes = {good}}), "");
  EXPECT_EQ(parameter_of({.name = "cma"}), "algorithm");
  EXPECT_EQ(parameter_of({.population = 0}), "population");
  EXPECT_EQ(parameter_of({.population = 2'000'000}), "population");
  EXPECT_EQ(parameter_of({.tournament = 0}), "tournament");
  EXPECT_EQ(parameter_of({.elites = 1.5}), "elites");
  EXPECT_EQ(parameter_of({.crossover = -0.1}), "crossover");
  EXPECT_EQ(parameter_of({.crossover = std::nan("")}), "crossover");
  EXPECT_EQ(parameter_of({.name = "map-elites"}), "axes");
  EXPECT_EQ(parameter_of({.name = "novelty"}), "axes");
  EXPECT_EQ(parameter_of({.name = "map-elites", .axes = {good}, .niches = 5000}), "niches");
  EXPECT_EQ(parameter_of({.neighbors = 0}), "neighbors");
  EXPECT_EQ(parameter_of({.age_layers = 0}), "age_layers");
  EXPECT_EQ(parameter_of({.age_gap = 0}), "age_gap");
  EXPECT_EQ(parameter_of({.species_distance = 0}), "species_distance");
  EXPECT_EQ(parameter_of({.species = 0}), "species");
  EXPECT_EQ(parameter_of({.stagnation = -1}), "stagnation");
  EXPECT_EQ(parameter_of({.axes = {{.quantity = "beauty"}}}), "axes");
  EXPECT_EQ(parameter_of({.axes = {{.quantity = "size", .lowest = 1, .highest = 1}}}), "axes");
  EXPECT_EQ(parameter_of({.axes = {{.quantity = "size", .lowest = 0, .highest = infinite}}}), "axes");
  EXPECT_EQ(parameter_of({.axes = {{.quantity = "size", .cells = 0}}}), "axes");
  EXPECT_EQ(parameter_of({.axes = std::vector<MapAxis>(5, {.quantity = "size", .cells = 2000})}), "axes");
}

TEST(Algorithms, AnUnknownNameListsAll) {
  EXPECT_THAT(refusal<ParameterError>([] { make_algorithm({.name = "cma"}); }),
              HasSubstr("ga, afpo, alps, nsga2, map-elites, novelty, neat, cma-es, sep-cma-es, cma-me, random"));
}

TEST(Algorithms, OnlyNsga2TakesSeveralObjectives) {
  std::vector<std::string_view> several;
  for (const AlgorithmDescription& algorithm : algorithms())
    if (algorithm.many_objectives) several.push_back(algorithm.name);
  EXPECT_THAT(several, UnorderedElementsAre("nsga2"));
}

// Where no robot is sound, those live on that break the limits least; a sound one stands before all of them.
TEST(AnyAlgorithm, RobotsThatAreNotSoundAreRankedByHowMuchTheyBreakLimits) {
  std::vector<Individual> pool;
  for (std::uint64_t id = 0; id < 12; ++id) {
    pool.push_back(individual(id, {worst_score}));
    pool.back().assessment.fate = Fate::overstretched;
    pool.back().assessment.violation = static_cast<double>((id * 5 + 3) % 12 + 1);  // 1 .. 12, each once
    pool.back().assessment.values[*find_quantity("size")] = 0.25 * static_cast<double>(id % 4) + 0.1;
  }
  for (const char* name :
       {"ga", "afpo", "alps", "nsga2", "random", "map-elites", "novelty", "cma-es", "sep-cma-es", "cma-me"}) {
    std::vector<Individual> with_sound = pool;
    const std::vector<std::size_t> alive = make_algorithm(algorithm_settings(name, 4))->survivors(pool, 0);
    ASSERT_EQ(alive.size(), 4u) << name;
    EXPECT_EQ(pool[alive[0]].assessment.violation, 1) << name;
    for (std::size_t i = 1; i < 4; ++i)
      EXPECT_GT(pool[alive[i]].assessment.violation, pool[alive[i - 1]].assessment.violation) << name;
    with_sound.push_back(individual(12, {-1e9}));
    EXPECT_EQ(make_algorithm(algorithm_settings(name, 4))->survivors(with_sound, 0).front(), 12u) << name;
  }
}

}  // namespace
}  // namespace mercury
