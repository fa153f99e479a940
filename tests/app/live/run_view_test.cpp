// SPDX-License-Identifier: Apache-2.0
// What the window shows of a run, against the run's own history.
#include "app/live/run_view.h"

#include <set>

#include "mercury/error.h"
#include "mercury/quantity.h"
#include "tests/app/live/run_setup.h"
#include "tests/app/program.h"

namespace mercury {
namespace {

using RunViewTest = test::FolderTest;

TEST_F(RunViewTest, ANewGenerationMakesANewView) {
  test::SmallRun run(path("run"));
  RunReader reader(path("run"));
  const auto empty = reader.read();
  ASSERT_TRUE(empty);
  EXPECT_EQ(empty->generation(), -1);
  EXPECT_TRUE(empty->champions.empty());
  EXPECT_TRUE(empty->best.empty());
  EXPECT_FALSE(reader.read());
  run.advance(2);
  const auto view = reader.read();
  ASSERT_TRUE(view);
  EXPECT_EQ(view->generation(), 1);
  EXPECT_EQ(view->opening, empty->opening);
  EXPECT_FALSE(view->is_over());
  EXPECT_FALSE(reader.read());
  run.advance(100);
  EXPECT_TRUE(reader.read()->is_over());
}

TEST_F(RunViewTest, ChampionsAreTheBestOfTheGenerationsEachOnce) {
  test::SmallRun run(path("run"));
  run.advance(7);
  const auto view = RunReader(path("run")).read();
  const RunHistory history(path("run"));
  std::vector<std::uint64_t> expected;
  std::vector<int> since;
  for (int generation = 0; generation < 7; ++generation)
    if (expected.empty() || history.champion(generation) != expected.back()) {
      expected.push_back(history.champion(generation));
      since.push_back(generation);
    }
  std::vector<std::uint64_t> found;
  std::vector<int> found_since;
  for (const Champion& champion : view->champions) {
    found.push_back(champion.individual.id);
    found_since.push_back(champion.since);
  }
  EXPECT_EQ(found, expected);
  EXPECT_EQ(found_since, since);
}

TEST_F(RunViewTest, TheSceneStartsWithDifferentRobotsTheBestFirst) {
  test::SmallRun run(path("run"));
  run.advance(4);
  const auto view = RunReader(path("run")).read();
  const RunHistory history(path("run"));
  ASSERT_GT(view->best.size(), 1u);
  ASSERT_LE(view->best.size(), 6u);
  EXPECT_EQ(view->best.front(), history.champion(3));
  std::set<std::uint64_t> hashes;
  for (const std::uint64_t id : view->best) hashes.insert(history.individuals()[id].assessment.hash);
  EXPECT_EQ(hashes.size(), view->best.size());
}

TEST_F(RunViewTest, AFamilyFollowsFirstParentsAndNamesTheSecondOnes) {
  test::SmallRun run(path("run"));
  run.advance(7);
  RunReader reader(path("run"));
  reader.read();
  const RunHistory history(path("run"));
  bool crossed = false;
  for (const Individual& self : history.individuals()) {
    const Family family = reader.family(self.id);
    std::uint64_t id = self.id;
    for (std::size_t i = 0; i < family.line.size(); ++i) {
      const FamilyMember& member = family.line[i];
      ASSERT_EQ(member.individual.id, id);
      const std::vector<std::uint64_t>& parents = history.individuals()[id].parents;
      ASSERT_EQ(member.other_parent.has_value(), parents.size() > 1);
      if (member.other_parent) {
        EXPECT_EQ(member.other_parent->id, parents[1]);
      }
      crossed = crossed || parents.size() > 1;
      ASSERT_EQ(parents.empty(), i + 1 == family.line.size());
      if (!parents.empty()) id = parents.front();
    }
    std::size_t children = 0;
    for (const Individual& other : history.individuals())
      for (const std::uint64_t parent : other.parents) children += parent == self.id;
    EXPECT_EQ(family.children, children);
  }
  EXPECT_TRUE(crossed);
}

TEST_F(RunViewTest, NoveltyHasAxesAndNoMap) {
  test::SmallRun run(path("run"), test::small_run("novelty"));
  run.advance(2);
  EXPECT_TRUE(RunReader(path("run")).read()->map.axes.empty());
}

TEST_F(RunViewTest, ACellOfTheMapHasTheBestOfItsRobots) {
  test::SmallRun run(path("run"), test::small_run("map-elites"));
  run.advance(5);
  const auto view = RunReader(path("run")).read();
  const EliteMap& map = view->map;
  ASSERT_EQ(map.columns, 4u);
  ASSERT_EQ(map.rows, 3u);
  ASSERT_EQ(map.cells.size(), 12u);
  const RunHistory history(path("run"));
  const std::size_t masses = *find_quantity("masses"), share = *find_quantity("muscle_share");
  const auto cell_of = [](double value, double low, double high, int cells) {
    int cell = 0;
    while (cell + 1 < cells && value >= low + (high - low) * (cell + 1) / cells) ++cell;
    return static_cast<std::size_t>(cell);
  };
  std::vector<double> best(12, worst_score);
  std::set<std::size_t> filled;
  for (const std::uint64_t id : history.living()) {
    const Individual& elite = history.individuals()[id];
    const std::size_t cell =
        cell_of(elite.assessment.values[share], 0, 1, 3) * 4 + cell_of(elite.assessment.values[masses], 8, 30, 4);
    filled.insert(cell);
    best[cell] = std::max(best[cell], elite.score());
  }
  EXPECT_EQ(map.filled(), filled.size());
  for (std::size_t i = 0; i < 12; ++i)
    if (map.cells[i]) {
      EXPECT_EQ(map.cells[i]->score(), best[i]) << i;
    }
}

TEST_F(RunViewTest, ARunThatIsReplacedIsReadFromTheStart) {
  {
    test::SmallRun run(path("run"));
    run.advance(3);
  }
  RunReader reader(path("run"));
  const auto before = reader.read();
  std::filesystem::remove_all(path("run"));
  EXPECT_THROW(reader.read(), InputError);
  RunSettings other = test::small_run();
  other.evolution.seed = 2;
  test::SmallRun again(path("run"), other);
  again.advance(1);
  const auto view = reader.read();
  ASSERT_TRUE(view);
  EXPECT_EQ(view->generation(), 0);
  EXPECT_NE(view->opening, before->opening);
}

TEST_F(RunViewTest, WhatIsNotThereIsNamed) {
  RunReader nothing(path("nothing"));
  EXPECT_THROW(nothing.read(), InputError);
  EXPECT_THROW(nothing.family(0), InputError);
  test::SmallRun run(path("run"));
  run.advance(1);
  RunReader reader(path("run"));
  reader.read();
  EXPECT_THROW(reader.grow(8), InputError);
  EXPECT_EQ(reader.grow(7).name, "run-7");
}

}  // namespace
}  // namespace mercury
