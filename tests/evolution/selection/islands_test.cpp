// SPDX-License-Identifier: Apache-2.0
// The island model against what defines it: who has parents where, who migrates when, and what one island knows of the
// others.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "mercury/error.h"
#include "mercury/evolution.h"
#include "tests/evolution/vector_genome.h"
#include "tests/refusal.h"

namespace mercury {
namespace {

constexpr std::size_t islands = 3, migrants = 2;
constexpr int interval = 5;

class IslandModel : public testing::TestWithParam<std::string_view> {
 protected:
  // 32 robots on 3 islands: 11, 11 and 10.
  static EvolutionSettings settings(int every = interval, std::uint64_t seed = 1) {
    EvolutionSettings settings;
    settings.algorithm = {.name = std::string(GetParam()),
                          .population = 32,
                          .islands = islands,
                          .migration_interval = every,
                          .migrants = migrants};
    settings.generations = 22;
    settings.seed = seed;
    return settings;
  }
};

std::string suite_name(const testing::TestParamInfo<std::string_view>& test) { return std::string(test.param); }
INSTANTIATE_TEST_SUITE_P(Algorithms, IslandModel, testing::Values("ga", "afpo", "alps", "nsga2", "neat", "random"),
                         suite_name);

std::vector<Generation> run(const EvolutionSettings& settings, Assessor& assessor) {
  const VectorSpace space;
  Evolution evolution(settings, space);
  return run(evolution, assessor);
}

std::map<std::uint64_t, Individual> by_id(const std::vector<Generation>& generations) {
  std::map<std::uint64_t, Individual> all;
  for (const Generation& generation : generations)
    for (const Individual& individual : generation.born) all.emplace(individual.id, individual);
  return all;
}

// The best first.
std::vector<std::uint64_t> living_on(std::size_t island, const Generation& generation,
                                     const std::map<std::uint64_t, Individual>& all) {
  std::vector<std::uint64_t> ids;
  for (const std::uint64_t id : generation.living)
    if (all.at(id).island == island) ids.push_back(id);
  return ids;
}

TEST_P(IslandModel, GenesFlowByMigrantsAlone) {
  const std::vector<Generation> generations = run(settings());
  const std::map<std::uint64_t, Individual> all = by_id(generations);
  for (const Generation& generation : generations) {
    std::vector<std::size_t> born(islands), came(islands);
    for (const Individual& child : generation.born) {
      ++born[child.island];
      came[child.island] += child.is_migrant;
      for (const std::uint64_t parent : child.parents)
        EXPECT_EQ(all.at(parent).island, child.is_migrant ? (child.island + islands - 1) % islands : child.island);
    }
    const bool is_migration = generation.number > 0 && generation.number % interval == 0;
    EXPECT_THAT(born, testing::ElementsAre(11, 11, 10));
    EXPECT_THAT(came, testing::Each(is_migration ? migrants : 0)) << generation.number;
  }
}

TEST_P(IslandModel, MigrantsAreCopiesOfTheBestOfTheIslandBefore) {
  const std::vector<Generation> generations = run(settings());
  const std::map<std::uint64_t, Individual> all = by_id(generations);
  std::size_t seen = 0;
  for (const Generation& generation : generations)
    for (std::size_t island = 0; island < islands; ++island) {
      std::vector<std::uint64_t> parents;
      for (const Individual& child : generation.born) {
        if (!child.is_migrant || child.island != island) continue;
        const Individual& parent = all.at(child.parents.at(0));
        parents.push_back(parent.id);
        EXPECT_EQ(child.genome->encode(), parent.genome->encode());
        EXPECT_EQ(child.assessment, parent.assessment);
        EXPECT_EQ(child.line_began, parent.line_began);
        EXPECT_NE(std::ranges::find(generation.living, child.id), generation.living.end());
        ++seen;
      }
      if (parents.empty()) continue;
      std::vector<std::uint64_t> best = living_on((island + islands - 1) % islands,
                                                  generations[static_cast<std::size_t>(generation.number) - 1], all);
      best.resize(migrants);
      EXPECT_EQ(parents, best);
    }
  EXPECT_EQ(seen, 4 * islands * migrants);  // in generations 5, 10, 15 and 20
}

// Random search keeps the best, so it is plain who the worst are.
TEST(Islands, MigrantsReplaceTheWorst) {
  EvolutionSettings settings;
  settings.algorithm = {
      .name = "random", .population = 30, .islands = islands, .migration_interval = 1, .migrants = migrants};
  settings.generations = 5;
  const std::vector<Generation> generations = run(settings);
  const std::map<std::uint64_t, Individual> all = by_id(generations);
  for (std::size_t n = 1; n < generations.size(); ++n)
    for (std::size_t island = 0; island < islands; ++island) {
      std::vector<std::uint64_t> natives = living_on(island, generations[n - 1], all), expected;
      for (const Individual& child : generations[n].born)
        if (child.island == island) (child.is_migrant ? expected : natives).push_back(child.id);
      std::ranges::sort(natives, [&](std::uint64_t a, std::uint64_t b) {
        return all.at(a).score() != all.at(b).score() ? all.at(a).score() > all.at(b).score() : a < b;
      });
      natives.resize(10 - migrants);
      expected.insert(expected.end(), natives.begin(), natives.end());
      EXPECT_THAT(living_on(island, generations[n], all), testing::UnorderedElementsAreArray(expected)) << n;
    }
}

// Takes an island for a bad one: its robots have other scores. The places of children say where they are born.
class Disturbing : public VectorAssessor {
 public:
  explicit Disturbing(std::size_t island) : island_(island) {}
  std::optional<std::vector<Assessment>> assess(std::span<const GenomePointer> candidates,
                                                std::span<const double> limits, const Watch& watch) override {
    auto assessments = VectorAssessor::assess(candidates, limits, watch);
    for (std::size_t i = island_; i < assessments->size(); i += islands) {
      double& score = (*assessments)[i].scores.front();
      score = -score;
    }
    return assessments;
  }

 private:
  const std::size_t island_;
};

// What happened on an island up to a generation: seeds, genomes and scores, and who lived on, as places among these.
struct Story {
  std::vector<std::uint64_t> seeds;
  std::vector<std::string> genomes;
  std::vector<double> scores;
  std::vector<std::vector<std::size_t>> living;
  bool operator==(const Story&) const = default;
};
Story story_of(std::size_t island, const std::vector<Generation>& generations, int before) {
  const std::map<std::uint64_t, Individual> all = by_id(generations);
  Story story;
  std::map<std::uint64_t, std::size_t> places;
  for (const Generation& generation : generations) {
    if (generation.number >= before) break;
    for (const Individual& child : generation.born) {
      if (child.island != island) continue;
      places.emplace(child.id, places.size());
      story.seeds.push_back(child.seed);
      story.genomes.push_back(child.genome->encode());
      story.scores.push_back(child.score());
    }
    story.living.emplace_back();
    for (const std::uint64_t id : living_on(island, generation, all)) story.living.back().push_back(places.at(id));
  }
  return story;
}

TEST_P(IslandModel, WithoutMigrationNoIslandKnowsOfTheOthers) {
  const std::vector<Generation> plain = run(settings(0));
  for (std::size_t bad = 0; bad < islands; ++bad) {
    Disturbing assessor(bad);
    const std::vector<Generation> disturbed = run(settings(0), assessor);
    for (std::size_t island = 0; island < islands; ++island)
      EXPECT_EQ(story_of(island, plain, 100) == story_of(island, disturbed, 100), island != bad) << island;
  }
  for (const Generation& generation : plain)
    for (const Individual& child : generation.born) EXPECT_FALSE(child.is_migrant);
}

// What happens on island 1 comes to island 2 at the first migration, in generation 5, and to island 0 at the second.
TEST_P(IslandModel, NewsTakesAMigrationFromIslandToIsland) {
  Disturbing assessor(1);
  const std::vector<Generation> plain = run(settings()), disturbed = run(settings(), assessor);
  const auto same = [&](std::size_t island, int before) {
    return story_of(island, plain, before) == story_of(island, disturbed, before);
  };
  EXPECT_FALSE(same(1, 1));
  EXPECT_TRUE(same(2, interval));
  EXPECT_FALSE(same(2, interval + 1));
  EXPECT_TRUE(same(0, 2 * interval));
  if (GetParam() != "random") {  // whose robots matter to nobody unless they are among the best
    EXPECT_FALSE(same(0, 100));
  }
}

TEST_P(IslandModel, ComesNearerToTheOptimumThanRandomSearch) {
  const auto best_of = [](const EvolutionSettings& settings) {
    double best = worst_score;
    for (const Generation& generation : run(settings))
      for (const Individual& child : generation.born) best = std::max(best, child.score());
    return best;
  };
  if (GetParam() == "random") return;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    EvolutionSettings random = settings(0, seed);
    random.algorithm = {.name = "random", .population = 32};
    EXPECT_GT(best_of(settings(interval, seed)), best_of(random) / 2) << seed;
  }
}

// As files hold it, also where a generation is made before the one before is tried.
TEST_P(IslandModel, ARunThatIsRestoredGoesOnBitForBit) {
  for (const bool pipelined : {false, true}) {
    EvolutionSettings settings = IslandModel::settings();
    settings.pipelined = pipelined;
    expect_the_same_when_restored(settings);
  }
}

TEST_P(IslandModel, TheLineageDoesNotDependOnThreads) {
  const std::vector<Generation> whole = run(settings());
  for (const std::size_t threads : {1, 3}) {
    const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism, threads);
    EXPECT_EQ(run(settings()), whole);
  }
}

TEST_P(IslandModel, TheBestComesFirstAndNeverGetsWorse) {
  const std::vector<Generation> generations = run(settings());
  const std::map<std::uint64_t, Individual> all = by_id(generations);
  double best = worst_score;
  for (const Generation& generation : generations) {
    EXPECT_LE(generation.living.size(), 32u);
    for (const std::uint64_t id : generation.living)
      EXPECT_LE(all.at(id).score(), all.at(generation.living.front()).score());
    EXPECT_GE(all.at(generation.living.front()).score(), best);
    best = all.at(generation.living.front()).score();
  }
}

TEST(Islands, FoundersAreSpreadOverThem) {
  class Founders : public VectorSpace {
   public:
    std::size_t founders() const override { return 40; }
  };
  EvolutionSettings settings;
  settings.algorithm = {.name = "ga", .population = 16, .islands = 4};
  const Founders space;
  std::vector<std::size_t> born(4);
  for (const Individual& child : Evolution(settings, space).children()) ++born[child.island];
  EXPECT_THAT(born, testing::Each(10u));
}

TEST(Islands, SettingsThatDoNotGoTogetherAreRefused) {
  const auto refusal = [](AlgorithmSettings algorithm, std::size_t children = 0) -> std::string {
    EvolutionSettings settings;
    settings.algorithm = std::move(algorithm);
    settings.children = children;
    return mercury::refusal<ParameterError>([&] { validate(settings); });
  };
  const std::vector<MapAxis> axes{{.quantity = "size"}};
  EXPECT_EQ(refusal({.name = "cma-es", .islands = 2}),
            "islands: cma-es learns from all robots; give 1, or --algorithm ga, afpo, alps, nsga2, neat or random");
  EXPECT_EQ(refusal({.name = "map-elites", .axes = axes, .islands = 2}),
            "islands: map-elites keeps one map; give 1, or --algorithm ga, afpo, alps, nsga2, neat or random");
  EXPECT_THAT(refusal({.name = "novelty", .axes = axes, .islands = 2}), testing::StartsWith("islands: "));
  EXPECT_EQ(refusal({.population = 4, .islands = 5}), "islands: 5 are more than the population of 4");
  EXPECT_EQ(refusal({.population = 8, .islands = 4}),
            "migrants: 2 leave no other robot on an island of 2; give fewer, or a larger population");
  EXPECT_EQ(refusal({.population = 8, .islands = 4, .migration_interval = 0}), "");
  EXPECT_EQ(refusal({.population = 40, .islands = 4}, 11), "children: 11 are too few for 4 islands and their migrants");
  EXPECT_EQ(refusal({.population = 40, .islands = 4}, 12), "");
  EXPECT_THAT(refusal({.islands = 0}), testing::StartsWith("islands: "));
  EXPECT_THAT(refusal({.islands = 2, .migrants = 0}), testing::StartsWith("migrants: "));
  EXPECT_THAT(refusal({.islands = 2, .migration_interval = -1}), testing::StartsWith("migration_interval: "));
}

}  // namespace
}  // namespace mercury
