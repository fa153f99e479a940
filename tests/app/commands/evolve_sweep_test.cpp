// SPDX-License-Identifier: Apache-2.0
// Sweeps: mercury evolve --seeds --vary, and the test that compares their variants.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include "app/commands/sweep.h"
#include "tests/app/program.h"

namespace mercury::test {
namespace {

// The share of all ways to deal the values to two samples in which the ranks are at least as uneven.
double share_of_ways(std::vector<double> values, std::size_t first) {
  const auto unevenness = [&](const std::vector<bool>& dealt) {
    double larger = 0, pairs = 0;
    for (std::size_t i = 0; i < values.size(); ++i)
      for (std::size_t j = 0; j < values.size(); ++j)
        if (dealt[i] && !dealt[j]) larger += values[i] > values[j], ++pairs;
    return std::abs(larger - pairs / 2);
  };
  std::vector<bool> dealt(values.size());
  std::fill_n(dealt.begin(), first, true);
  const double found = unevenness(dealt);
  std::sort(dealt.begin(), dealt.end());
  double ways = 0, uneven = 0;
  do {
    ++ways;
    uneven += unevenness(dealt) >= found;
  } while (std::next_permutation(dealt.begin(), dealt.end()));
  return uneven / ways;
}

TEST(RankTest, CountsAllWaysToDealTheValues) {
  const std::vector<double> values{3, 9, 1, 7, 8, 2, 6, 4, 5, 0};
  for (std::size_t first = 1; first < values.size(); ++first) {
    const std::span<const double> all(values);
    EXPECT_NEAR(rank_test(all.first(first), all.subspan(first)), share_of_ways(values, first), 1e-12) << first;
  }
}

TEST(RankTest, NoTieAndNoSampleLeavesItsRange) {
  const std::vector<double> same(30, 1.5), ramp{1, 2, 3}, none;
  EXPECT_EQ(rank_test(same, same), 1);
  EXPECT_EQ(rank_test(ramp, none), 1);
  EXPECT_EQ(rank_test(ramp, ramp), 1);
}

// Beyond 20 values, the normal distribution must go on where the exact one ends.
TEST(RankTest, TheNormalDistributionAgreesWithTheExactOne) {
  for (const double shift : {0.0, 3.5, 6.5, 9.5}) {
    std::vector<double> a(20), b(20);
    std::iota(a.begin(), a.end(), 0.0);
    std::iota(b.begin(), b.end(), shift + 0.25);
    const double exact = rank_test(a, b);
    a.push_back(9.4);  // in the middle of both
    b.push_back(9.6 + shift);
    EXPECT_NEAR(rank_test(a, b), exact, 0.1 * exact + 0.01) << shift;
  }
}

class EvolveSweep : public FolderTest {
 protected:
  Outcome evolve(const std::string& name, const Arguments& more) const {
    return mercury(joined({"evolve", path(name)}, more));
  }
  static std::vector<std::string> small(const Arguments& more) {
    return joined({"--from", "voxel:3x2x2", "--population", "6", "--generations", "2", "--seconds", "0.2", "--quiet",
                   "--device", "cpu"},
                  more);
  }
};

TEST_F(EvolveSweep, ItsRunsAreThoseOfSingleCommands) {
  const Outcome sweep = succeeded(evolve("sweep", small({"--seeds", "3,7", "--vary", "algorithm=ga,afpo"})));
  for (const std::string seed : {"3", "7"})
    for (const std::string algorithm : {"ga", "afpo"}) {
      const std::string single = "single-" + algorithm + "-" + seed;
      succeeded(evolve(single, small({"--seed", seed, "--algorithm", algorithm})));
      EXPECT_EQ(read("sweep/algorithm=" + algorithm + "/seed-" + seed + "/lineage.csv"), read(single + "/lineage.csv"));
    }
  const Sweep read_back = read_sweep(path("sweep"));
  ASSERT_EQ(read_back.variants.size(), 2u);
  for (const SweepVariant& variant : read_back.variants) {
    ASSERT_EQ(variant.runs.size(), 2u);
    for (const SweptRun& run : variant.runs) {
      EXPECT_TRUE(run.done);
      EXPECT_EQ(run.tried, (std::vector<std::size_t>{6, 12, 18}));
      EXPECT_TRUE(std::ranges::is_sorted(run.best));  // both keep their best
    }
  }
  const std::string csv = read("sweep/sweep.csv");
  EXPECT_EQ(std::ranges::count(csv, '\n'), 5);
  EXPECT_NE(sweep.output.find("algorithm=ga"), std::string::npos);
}

TEST_F(EvolveSweep, OptionsWithoutAValueAreThereOrNot) {
  succeeded(evolve("sweep", small({"--seeds", "3", "--vary", "muscle-adaptation=no,yes", "--genes", "both"})));
  succeeded(evolve("with", small({"--seed", "3", "--genes", "both", "--muscle-adaptation"})));
  succeeded(evolve("without", small({"--seed", "3", "--genes", "both"})));
  EXPECT_EQ(read("sweep/muscle-adaptation=yes/seed-3/lineage.csv"), read("with/lineage.csv"));
  EXPECT_EQ(read("sweep/muscle-adaptation=no/seed-3/lineage.csv"), read("without/lineage.csv"));
  EXPECT_NE(read("with/lineage.csv"), read("without/lineage.csv"));
}

TEST_F(EvolveSweep, GoesOnWhereItStopped) {
  succeeded(evolve("sweep", small({"--seeds", "1..2", "--prepare"})));
  EXPECT_EQ(runs_of_sweep(path("sweep")).size(), 2u);
  succeeded(evolve("sweep/all/seed-1", {"--resume", "--quiet"}));  // a run of it, by itself
  succeeded(evolve("sweep", {"--resume", "--generations", "3", "--quiet"}));
  for (const std::string seed : {"1", "2"}) {
    succeeded(evolve("single-" + seed, small({"--seed", seed})));
    succeeded(evolve("single-" + seed, {"--resume", "--generations", "3", "--quiet"}));
    EXPECT_EQ(read("sweep/all/seed-" + seed + "/lineage.csv"), read("single-" + seed + "/lineage.csv"));
  }
}

TEST_F(EvolveSweep, MistakesAreRefusedBeforeAnythingIsWritten) {
  const std::vector<std::vector<std::string>> mistakes{{"--seeds", "5..1"},
                                                       {"--seeds", "1,1"},
                                                       {"--seeds", "1..99999"},
                                                       {"--seeds", "x"},
                                                       {"--vary", "algorithm"},
                                                       {"--vary", "algorithm="},
                                                       {"--vary", "algorithm=ga,"},
                                                       {"--vary", "algorithm=swim"},
                                                       {"--vary", "nonsense=1"},
                                                       {"--vary", "pipelined=maybe"},
                                                       {"--vary", "resume=1"},
                                                       {"--vary", "seed=1,2"},
                                                       {"--vary", "elites=0.1,9"},
                                                       {"--seeds", "1", "--seed", "2"},
                                                       {"--vary", "elites=0.1,0.1"},
                                                       {"--seeds", "1..2", "--shard", "1/2"},
                                                       {"--vary", "elites=0.1", "--vary", "elites=0.2"}};
  for (const std::vector<std::string>& mistake : mistakes) {
    const Outcome outcome = evolve("sweep", small(mistake));
    EXPECT_EQ(outcome.status, 2) << testing::PrintToString(mistake);
    EXPECT_EQ(std::ranges::count(outcome.messages, '\n'), 1) << outcome.messages;
    EXPECT_FALSE(std::filesystem::exists(path("sweep"))) << testing::PrintToString(mistake);
  }
  succeeded(evolve("sweep", small({"--seeds", "1", "--prepare"})));
  EXPECT_EQ(evolve("sweep", small({"--seeds", "1"})).status, 2);                          // it is there
  EXPECT_EQ(evolve("sweep", {"--resume", "--seeds", "1..3"}).status, 2);                  // it keeps its runs
  EXPECT_EQ(evolve("sweep/all/seed-1", small({"--seeds", "1", "--force"})).status, 2);    // it is a run
  EXPECT_EQ(evolve("sweep", small({"--seeds", "4", "--force", "--prepare"})).status, 2);  // which would stay beside it
  EXPECT_EQ(evolve("sweep", small({"--seeds", "1..2", "--force", "--prepare"})).status, 0);
  EXPECT_EQ(runs_of_sweep(path("sweep")).size(), 2u);
}

}  // namespace
}  // namespace mercury::test
