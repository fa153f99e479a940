// SPDX-License-Identifier: Apache-2.0
// mercury render and mercury info of the runs of an evolution.
#include <gmock/gmock.h>

#include <set>

#include "app/commands/run_film.h"
#include "mercury/quantity.h"
#include "render/png.h"
#include "tests/app/commands/small_run.h"
#include "tests/app/program.h"

namespace mercury::test {
namespace {

using testing::HasSubstr;

class RunPicture : public FolderTest {
 protected:
  Outcome render(const std::string& run, const std::string& output, const Arguments& more) const {
    return mercury(joined({"render", path(run), "--size", "160x90", "--fps", "10", "-o", path(output)}, more));
  }
  // The message of a command that cannot be used.
  std::string refusal(const std::string& run, const std::string& output, const Arguments& more) const {
    const Outcome outcome = render(run, output, more);
    EXPECT_EQ(outcome.status, 2) << outcome.messages;
    EXPECT_EQ(std::ranges::count(outcome.messages, '\n'), 1) << outcome.messages;
    return outcome.messages;
  }
};

TEST_F(RunPicture, LineageIsFilmedOneAncestorAfterTheOther) {
  make_run(path("swim"), small_run("ga", 12));
  const RunHistory run(path("swim"));
  const std::size_t ancestors = run.line_of(run.living().front()).size();
  ASSERT_GT(ancestors, 1u);
  const Outcome outcome = succeeded(render("swim", "a.mp4", {"--lineage", "best", "--seconds", "0.3"}));
  EXPECT_EQ(probe(path("a.mp4"))["nb_read_frames"], std::to_string(3 * ancestors));
  EXPECT_THAT(outcome.messages, HasSubstr("(ocean-simple)"));  // as the run has it, not the default
}

TEST_F(RunPicture, AncestorsAreTheFirstTheLastAndTheLargestRises) {
  make_run(path("swim"), small_run("ga", 20));
  const RunHistory run(path("swim"));
  std::uint64_t id = 0;  // with the longest line
  for (const std::uint64_t living : run.living())
    if (run.line_of(living).size() > run.line_of(id).size()) id = living;
  const std::vector<std::uint64_t> line = run.line_of(id);
  ASSERT_GT(line.size(), 3u);
  const Outcome outcome =
      render("swim", "frames", {"--lineage", std::to_string(id), "--ancestors", "3", "--seconds", "0.1", "--each"});
  ASSERT_EQ(outcome.status, 0) << outcome.messages;
  const std::vector<std::string> folders = listing();
  const auto is_filmed = [&](std::uint64_t robot) {
    return std::ranges::count(folders, "frames-swim-" + std::to_string(robot)) == 1;
  };
  EXPECT_TRUE(is_filmed(line.front()));
  EXPECT_TRUE(is_filmed(line.back()));
  // Between them, at most one: the one that raised the best score of the line so far most.
  double highest = run.individuals()[line.front()].score(), largest = 0;
  std::optional<std::uint64_t> step;
  for (std::size_t i = 1; i + 1 < line.size(); ++i) {
    const double rise = run.individuals()[line[i]].score() - highest;
    if (rise > largest) {
      largest = rise;
      step = line[i];
    }
    highest += std::max(0.0, rise);
  }
  for (std::size_t i = 1; i + 1 < line.size(); ++i) EXPECT_EQ(is_filmed(line[i]), line[i] == step) << line[i];
}

TEST_F(RunPicture, GenerationsStandInARowWithTheirCaptions) {
  make_run(path("swim"), small_run());
  const RunHistory run(path("swim"));
  const Outcome outcome = succeeded(render("swim", "a.png", {"--generation", "0,3,last", "--still", "0.2"}));
  EXPECT_THAT(outcome.messages, HasSubstr("simulating 3 robots"));
  // A caption more or less changes the picture.
  succeeded(render("swim", "b.png", {"--generation", "0,3,last", "--still", "0.2", "--show", "skin,path,clock,scale"}));
  EXPECT_NE(read("a.png"), read("b.png"));
}

TEST_F(RunPicture, MapIsDrawnAsATable) {
  make_run(path("map"), small_run("map-elites"));
  const RunHistory run(path("map"));
  const Outcome outcome = succeeded(render("map", "a.png", {"--map"}));
  EXPECT_THAT(outcome.messages, HasSubstr("simulating " + std::to_string(run.living().size()) + " robot"));
  EXPECT_EQ(render::read_png(path("a.png")).width, 160);
  succeeded(render("map", "a.gif", {"--map", "--seconds", "0.2"}));
  EXPECT_EQ(probe(path("a.gif"))["nb_read_frames"], "2");
}

TEST_F(RunPicture, ChampionsAreFilmedTogetherAndEachAlone) {
  make_run(path("swim"), small_run());
  const RunHistory run(path("swim"));
  const Outcome outcome = succeeded(render("swim", "a.gif", {"--best", "2", "--seconds", "0.1"}));
  EXPECT_THAT(outcome.messages, HasSubstr("simulating 2 robots"));
  succeeded(render("swim", "each.gif", {"--best", "2", "--seconds", "0.1", "--each"}));
  for (const std::uint64_t id : run.living().first(2))
    EXPECT_TRUE(std::filesystem::exists(path("each-swim-" + std::to_string(id) + ".gif")));
}

TEST_F(RunPicture, OptionsChangeTheConfigurationOfTheRun) {
  make_run(path("swim"), small_run(), 1);
  EXPECT_THAT(render("swim", "a.gif", {"--seconds", "0.1", "--environment", "land"}).messages, HasSubstr("(land)"));
  EXPECT_THAT(refusal("swim", "b.gif", {"--friction", "1"}),
              HasSubstr("--friction: ocean-simple has no such parameter"));
}

TEST_F(RunPicture, WhatARunDoesNotHaveIsRefused) {
  make_run(path("swim"), small_run("afpo", 2));
  EXPECT_EQ(refusal("swim", "a.mp4", {"--lineage", "99"}),
            "mercury: --lineage: the run has no robot 99; give best, or a number from 0 to 17\n");
  EXPECT_EQ(refusal("swim", "a.mp4", {"--lineage", "worst"}),
            "mercury: --lineage: \"worst\" is not accepted; give best, or the number of a robot\n");
  EXPECT_EQ(refusal("swim", "a.mp4", {"--generation", "0,3"}),
            "mercury: --generation: the run has no generation 3; give numbers from 0 to 2, or last\n");
  EXPECT_EQ(refusal("swim", "a.png", {"--map"}),
            "mercury: " + path("swim") +
                ": has no map, since its algorithm is afpo; --map takes runs of map-elites or cma-me\n");
}

TEST_F(RunPicture, OptionsThatDoNotGoTogetherAreRefused) {
  make_run(path("map"), small_run("map-elites"), 1);
  const auto refused = [&](const Arguments& options, const std::string& message) {
    EXPECT_EQ(refusal("map", "a.mp4", options), "mercury: " + message + "\n");
  };
  refused({"--lineage", "best", "--map"}, "--map: not together with --lineage; give one of them");
  refused({"--generation", "0", "--best", "3"}, "--best: not together with --generation; give one of them");
  refused({"--ancestors", "3"}, "--ancestors: works with --lineage only");
  refused({"--lineage", "best", "--ancestors", "1"},
          "--ancestors: 1 is not accepted; give 2 or more, for the first and the last");
  refused({"--best", "0"}, "--best: 0 is not accepted; give 1 or more");
  refused({"--map", "--each"}, "--each: not together with --map");
  refused({"--map", "--color", "strain"}, "--color: not together with --map, where colors show scores");
  refused({"--map", "--camera", "top"}, "--camera: not together with --map; --azimuth and --elevation turn the robots");
  refused({"--map", "--grid", "2x2"}, "--grid: not together with --map, which has a layout of its own");
  refused({"--random", "voxel"}, path("map") + ": a run is filmed alone; give it without other robots");
}

TEST_F(RunPicture, OptionsOfRunsNeedARun) {
  succeeded(mercury({"new", "voxel", "--count", "2", "-o", path("robots")}));
  for (const auto& [option, value] : {std::pair{"--lineage", "best"}, {"--generation", "0"}, {"--best", "2"}})
    EXPECT_EQ(
        refusal("robots", "a.gif", {option, value}),
        "mercury: " + std::string(option) + ": films a run of mercury evolve, and " + path("robots") + " is none\n");
  EXPECT_EQ(mercury({"render", "--map", "-o", path("a.png")}).messages,
            "mercury: --map: films a run of mercury evolve; give its folder\n");
  EXPECT_EQ(render("robots", "a.gif", {"--seconds", "0.1"}).status, 0);
}

class RunInfo : public RunPicture {};

TEST_F(RunInfo, SummarizesTheRun) {
  make_run(path("swim"), small_run(), 4);
  const RunHistory run(path("swim"));
  const Individual& best = run.individuals()[run.living().front()];
  const Outcome outcome = succeeded(mercury({"info", path("swim")}));
  EXPECT_THAT(outcome.output, testing::StartsWith("swim\n"));
  EXPECT_THAT(outcome.output,
              testing::ContainsRegex("evolves +voxel robots, voxels 1x1x1..3x2x2; what changes: body\n"));
  EXPECT_THAT(outcome.output, testing::ContainsRegex("generations +3 of 6 done\n"));
  EXPECT_THAT(outcome.output, testing::ContainsRegex("robots +24, of which 6 live"));
  EXPECT_THAT(outcome.output, HasSubstr("12 robots/s, 2.0 s in all, on CPU"));  // 24 in 4 times half a second
  EXPECT_THAT(outcome.output, testing::ContainsRegex("environment +ocean-simple, "));
  EXPECT_THAT(outcome.output, HasSubstr("robot " + std::to_string(best.id) + " of generation " +
                                        std::to_string(best.generation) + ": " + number_text(best.score()) + " m\n"));
  for (const Quantity& quantity : quantities())
    EXPECT_THAT(outcome.output, HasSubstr(std::string(quantity.name) + " "));
  EXPECT_THAT(outcome.output, HasSubstr("genomes ("));
}

TEST_F(RunInfo, ReadsARunThatIsBeingWritten) {
  RunFolder writer = RunFolder::create(path("swim"), small_run());
  const Outcome outcome = succeeded(mercury({"info", path("swim")}));
  EXPECT_THAT(outcome.output, testing::ContainsRegex("generations +none of 6 yet\n"));
  EXPECT_EQ(refusal("swim", "a.mp4", {}),
            "mercury: " + path("swim") + ": has no generation yet; try again when the first one is done\n");
}

TEST(ScoreText, NamesUnitsOrFormulas) {
  Individual robot;
  robot.assessment.fate = Fate::sound;
  robot.assessment.scores = {0.73125};
  RunSettings settings;
  EXPECT_EQ(score_text(settings, robot), "0.731 m");
  settings.evolution.objectives = {"distance - 0.1 * work"};
  EXPECT_EQ(score_text(settings, robot), "score 0.731");
  settings.evolution.objectives = {"distance", "masses"};
  robot.assessment.scores = {0.73125, 1234.4};
  EXPECT_EQ(score_text(settings, robot), "distance 0.731 m, masses 1234");
  robot.assessment.fate = Fate::exploded;
  EXPECT_EQ(score_text(settings, robot), "exploded");
}

}  // namespace
}  // namespace mercury::test
