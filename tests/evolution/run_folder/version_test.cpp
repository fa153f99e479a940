// SPDX-License-Identifier: Apache-2.0
// Run folders of every version are read for ever: version_1/ was written by Mercury 0.3.0, version_2/ by the last
// version before islands.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "robots/bytes.h"
#include "tests/evolution/run_folder/test_run.h"

namespace mercury {
namespace {

struct Expected {
  std::vector<std::uint64_t> parents;
  int generation;
  double score;
  std::uint64_t seed, genome;  // checksum of its bytes
};

const std::vector<Expected> born{{{}, 0, 0x1.78e0e0e0e0e0ep+5, 0x3d124de708c5c289u, 0xc255254f2fb9c832u},
                                 {{}, 0, 0x1.8d4d4d4d4d4d3p+5, 0x5d9aaa253a8e24f1u, 0xcdefa06d6eddf3c1u},
                                 {{}, 0, 0x1.8bf3f3f3f3f43p+5, 0x6e47e040b9b9b328u, 0xe62c42723e08748eu},
                                 {{2}, 1, 0x1.88f8f8f8f8f93p+5, 0x5608e7b77775dd62u, 0xe8da94900cb9e4a7u},
                                 {{2, 0}, 1, 0x1.61e1e1e1e1e1ep+5, 0x63e759826c59bd8u, 0x355e0cd06e3e83e5u},
                                 {{}, 1, 0x1.8505050505052p+5, 0xbac82c2e78ae7714u, 0x8b8af76ebb217e17u},
                                 {{5, 1}, 2, 0x1.7f2f2f2f2f2f5p+5, 0x72753504932f50bcu, 0x2a33bc39d9a18d1fu},
                                 {{1, 2}, 2, 0x1.7b8b8b8b8b8bbp+5, 0xef0d0885d9975057u, 0xac53e8c9df6ae3a3u},
                                 {{}, 2, 0x1.9060606060605p+5, 0x5deafb36093bd70u, 0x69405cd68cb84af7u}};

void expect_version_1(const RunHistory& run) {
  ASSERT_GE(run.individuals().size(), born.size());
  for (std::size_t id = 0; id < born.size(); ++id) {
    const Individual& individual = run.individuals()[id];
    EXPECT_EQ(individual.parents, born[id].parents);
    EXPECT_EQ(individual.generation, born[id].generation);
    EXPECT_EQ(individual.score(), born[id].score);
    EXPECT_EQ(individual.seed, born[id].seed);
    EXPECT_EQ(checksum_of(run.genome(id)->encode()), born[id].genome);
  }
}

TEST(RunFolderVersion1, IsRead) {
  const RunHistory run(MERCURY_RUN_VERSION_1, byte_space);
  expect_version_1(run);
  EXPECT_EQ(run.generations().size(), 3u);
  EXPECT_THAT(run.living(), testing::ElementsAre(8, 1, 5));
  EXPECT_EQ(run.settings().program, "Mercury 0.3.0");
  EXPECT_EQ(run.settings().evolution.algorithm.population, 3u);
  EXPECT_EQ(run.settings().evolution.algorithm.crossover, 0.5);
  ASSERT_EQ(run.settings().space.founders.size(), 1u);
  EXPECT_EQ(run.settings().space.founders[0].name, "founder");
  EXPECT_EQ(run.settings().space.founders[0].masses.size(), 12u);
}

using RunFolderOfVersion1 = RunFolderTest;

TEST_F(RunFolderOfVersion1, GoesOn) {
  std::filesystem::copy(MERCURY_RUN_VERSION_1, path("run"), std::filesystem::copy_options::recursive);
  {
    RunFolder run = open("run");
    run.set_generations(4);
    evolve(run);
  }
  EXPECT_EQ(history("run").generations().size(), 5u);
  expect_version_1(history("run"));
}

// Makes all generations once more from the settings alone, with the scores that the journal has: the lineage is what it
// was, so that what evolution draws is what it drew then. That goes for both genes, body and muscles.
TEST(RunFolderVersion2, HasTheLineageThatThisVersionMakes) {
  const RunHistory run(MERCURY_RUN_VERSION_2);
  ASSERT_EQ(run.individuals().size(), 20u);
  Evolution evolution(run.settings().evolution, run.space());
  std::size_t id = 0, mutants = 0;
  while (!evolution.is_over()) {
    std::vector<Individual> children = evolution.children();
    for (Individual& child : children) {
      ASSERT_LT(id, run.individuals().size());
      const Individual& stored = run.individuals()[id];
      EXPECT_EQ(child.parents, stored.parents);
      EXPECT_EQ(child.seed, stored.seed);
      EXPECT_EQ(child.line_began, stored.line_began);
      EXPECT_EQ(stored.island, 0);
      EXPECT_EQ(child.genome->encode(), run.genome(id)->encode());
      mutants += !child.parents.empty();
      child.assessment = stored.assessment;
      ++id;
    }
    evolution.select(std::move(children));
  }
  EXPECT_EQ(id, run.individuals().size());
  EXPECT_GT(mutants, 10u);
  std::vector<std::uint64_t> living;
  for (const Individual& individual : evolution.living()) living.push_back(individual.id);
  EXPECT_TRUE(std::ranges::equal(living, run.living()));
}

}  // namespace
}  // namespace mercury
