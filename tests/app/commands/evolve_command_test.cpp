// SPDX-License-Identifier: Apache-2.0
// mercury evolve: runs, and that they go on as if they had never stopped.
#include <gmock/gmock.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "evolution/run_folder/champion_checks.h"
#include "mercury/cuda_devices.h"
#include "mercury/genome.h"
#include "mercury/quantity.h"
#include "mercury/robot_file.h"
#include "mercury/samples.h"
#include "tests/app/commands/evolve_runs.h"
#include "tests/app/program.h"

namespace mercury::test {
namespace {

// By column name, one map per line.
std::vector<std::map<std::string, std::string>> rows_of(const std::string& csv) {
  std::vector<std::map<std::string, std::string>> rows;
  std::vector<std::string> names;
  std::istringstream lines(csv);
  for (std::string line; std::getline(lines, line);) {
    std::vector<std::string> cells(1);
    bool quoted = false;
    for (const char c : line) {
      if (c == '"') quoted = !quoted;
      if (c == ',' && !quoted)
        cells.emplace_back();
      else
        cells.back() += c;
    }
    if (names.empty()) {
      names = cells;
      continue;
    }
    auto& row = rows.emplace_back();
    for (std::size_t i = 0; i < cells.size(); ++i) row[names.at(i)] = cells[i];
  }
  return rows;
}

// A run of version 0.2 after two generations goes on to the lineage that version 0.2 came to in four.
TEST_F(EvolveCommand, RunsOfVersion02GoOn) {
  const std::filesystem::path data = MERCURY_TEST_DATA;
  std::filesystem::copy(data / "run-of-version-0.2", path("old"), std::filesystem::copy_options::recursive);
  std::filesystem::copy(data / "run-of-version-0.2-lineage.csv", path("expected.csv"));
  succeeded(evolve("old", {"--resume", "--generations", "4", "--quiet", "--device", "cpu"}));
  const auto expected = rows_of(read("expected.csv")), found = rows_of(lineage("old"));
  ASSERT_EQ(expected.size(), 20u);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i)
    for (const auto& [column, value] : expected[i]) {
      ASSERT_TRUE(found[i].contains(column)) << column;
      EXPECT_EQ(found[i].at(column), value) << column << " of " << i;
    }
}

// Robots of generation 0 do not depend on the objective, so a run for speed_x says who goes backward.
TEST_F(EvolveCommand, RobotsWhoseObjectiveIsNotANumberAreUnsound) {
  const Arguments one_trial = joined(small("0"), {"--trials", "1"});
  const Outcome outcome = succeeded(evolve("roots", joined(one_trial, {"--objective", "sqrt(speed_x)"})));
  succeeded(evolve("speeds", joined(one_trial, {"--objective", "speed_x"})));
  const auto roots = rows_of(lineage("roots")), speeds = rows_of(lineage("speeds"));
  ASSERT_EQ(roots.size(), 8u);
  ASSERT_EQ(speeds.size(), 8u);
  int undefined = 0;
  for (std::size_t i = 0; i < roots.size(); ++i) {
    ASSERT_EQ(speeds[i].at("fate"), "sound");
    const double speed = std::stod(speeds[i].at("score"));
    undefined += speed < 0;
    EXPECT_EQ(roots[i].at("fate"), speed < 0 ? "undefined" : "sound");
    if (speed < 0) {
      EXPECT_EQ(roots[i].at("score"), "-inf");
    } else {
      EXPECT_NEAR(std::stod(roots[i].at("score")), std::sqrt(speed), 1e-12);
    }
  }
  EXPECT_GT(undefined, 0);
  EXPECT_LT(undefined, 8);
  EXPECT_EQ(rows_of(read("roots/generations.csv")).at(0).at("undefined"), std::to_string(undefined));
  EXPECT_THAT(outcome.messages, testing::HasSubstr("the objective \"sqrt(speed_x)\" is not a finite number for " +
                                                   std::to_string(undefined) + " of 8 robots of generation 0"));
}

TEST_F(EvolveCommand, AnObjectiveThatIsNeverANumberIsNamedOnce) {
  const Outcome outcome = succeeded(evolve("run", joined(small("2"), {"--objective", "1/0"})));
  EXPECT_THAT(outcome.messages, testing::HasSubstr("the objective \"1/0\" is not a finite number for 8 of 8 robots"));
  EXPECT_EQ(outcome.messages.find("\"1/0\""), outcome.messages.rfind("\"1/0\""));
  EXPECT_THAT(outcome.output, testing::HasSubstr("no robot is sound; the first one is undefined"));
  EXPECT_THAT(mercury({"info", path("run")}).output, testing::HasSubstr("24 undefined (100.0 %)"));
}

TEST_F(EvolveCommand, GoesOnToNoFewerGenerationsThanThereAre) {
  succeeded(evolve("run", small("3")));
  const std::string settings = read("run/run.toml"), before = lineage("run");
  for (const Arguments& go_on : {Arguments{"--resume"}, {"--merge"}, {"--resume", "--dry-run"}}) {
    EXPECT_THAT(
        evolve("run", joined(go_on, {"--generations", "2"})),
        Ends(2, "--generations: 2 is not accepted; " + path("run") + " has 3 generations already, so give 3 or more"));
  }
  EXPECT_EQ(read("run/run.toml"), settings);
  EXPECT_EQ(evolve("run", {"--resume", "--generations", "3", "--quiet"}).status, 0);
  EXPECT_EQ(lineage("run"), before);
  EXPECT_EQ(evolve("run", {"--resume", "--generations", "4", "--quiet"}).status, 0);
  EXPECT_EQ(generations_in("run"), 5u);  // generation 0 included
}

// Robots of a run are tried as there: lineage.csv and `mercury run` have the same hashes and distances.
TEST_F(EvolveCommand, RunTriesAnyIndividualAsInTheRun) {
  for (const Arguments& trials :
       {Arguments{}, {"--trials", "1"}, {"--noise", "0.2", "--damage", "0.1", "--settle", "0.1"}}) {
    succeeded(evolve("run", joined(small("2"), trials, {"--dt", "0.002", "--force"})));
    const auto rows = rows_of(lineage("run"));
    for (const std::size_t id : {0, 9, 23}) {
      const Outcome outcome =
          mercury({"run", path("run"), "--robot", std::to_string(id), "--csv", "-", "--device", "cpu"});
      ASSERT_EQ(outcome.status, 0) << outcome.messages;
      const auto results = rows_of(outcome.output);
      ASSERT_EQ(results.size(), 1u);
      EXPECT_EQ(results[0].at("name"), "run-" + std::to_string(id));
      EXPECT_EQ(results[0].at("hash"), rows[id].at("hash"));
      EXPECT_EQ(results[0].at("fate"), rows[id].at("fate"));
      EXPECT_DOUBLE_EQ(std::stod(results[0].at("distance")), std::stod(rows[id].at("distance")));
    }
  }
  const auto longer = rows_of(mercury({"run", path("run"), "--robot", "0", "--seconds", "0.4", "--csv", "-"}).output);
  EXPECT_NE(longer.at(0).at("hash"), rows_of(lineage("run")).at(0).at("hash"));
}

TEST_F(EvolveCommand, ARunStandsForItsChampionsItsElitesOrAnyIndividual) {
  succeeded(evolve("run", joined(small("3"), {"--no-confirm"})));
  const RunHistory history(path("run"));
  const auto names = [&](const Arguments& chosen) {
    const Outcome outcome = succeeded(mercury(joined({"run", path("run"), "--seconds", "0.3", "--csv", "-"}, chosen)));
    std::vector<std::string> found;
    for (const auto& row : rows_of(outcome.output)) found.push_back(row.at("name"));
    return found;
  };
  std::vector<std::string> champions, elites;
  for (const auto& [id, generation] : champions_of(history)) champions.push_back("run-" + std::to_string(id));
  for (const std::uint64_t id : history.living()) elites.push_back("run-" + std::to_string(id));
  EXPECT_EQ(names({}), champions);
  EXPECT_EQ(names({"--robot", "champions"}), champions);
  EXPECT_EQ(names({"--robot", "elites"}), elites);
  EXPECT_EQ(names({"--robot", "best", "--robot", "5"}), (std::vector<std::string>{elites.front(), "run-5"}));

  succeeded(mercury({"export", path("run"), "--robot", "5", "-o", path("a.stl")}));
  save_robot(path("five.json"), history.grow(5));
  succeeded(mercury({"export", path("five.json"), "-o", path("b.stl")}));
  EXPECT_EQ(read("a.stl"), read("b.stl"));

  succeeded(evolve("on", {"--from", path("run"), "--robot", "5", "--robot", "9", "--population", "2", "--generations",
                          "0", "--seconds", "0.1", "--quiet", "--no-confirm"}));
  EXPECT_EQ(load_robot(path("on/founders/0000.json")), history.grow(5));
  EXPECT_EQ(load_robot(path("on/founders/0001.json")), history.grow(9));

  std::filesystem::remove_all(path("run/best"));
  for (const auto& [arguments, message] : std::vector<std::pair<Arguments, std::string>>{
           {{path("run"), "--robot", "32"},
            "--robot: \"32\" is not accepted; give best, elites, champions, or one of the 32 robots of " + path("run")},
           {{path("run"), "--robot", "worst"}, "--robot: \"worst\" is not accepted"},
           {{"sample:eel", "--robot", "3"}, "--robot: chooses robots of a run of mercury evolve; give its folder"},
           {{path("run")},
            path("run") + ": has no champions in best/; checks.csv in it says why, and the robot \"best\" is"}}) {
    EXPECT_THAT(mercury(joined({"run"}, arguments)), Ends(2, testing::StartsWith(message)));
  }
}

// With the same jitters: the figures are those of checks.csv.
TEST_F(EvolveCommand, CheckRepeatsTheCheckOfAChampion) {
  succeeded(evolve("run", joined(small("1"), {"--objective", "path"})));
  const auto checks = rows_of(read("run/checks.csv"));
  const Outcome outcome =
      mercury({"check", path("run"), "--robot", checks.at(0).at("id"), "--csv", "-", "--device", "cpu"});
  const auto again = rows_of(outcome.output);
  ASSERT_EQ(again.size(), 1u) << outcome.messages;
  EXPECT_EQ(again[0].at("objective"), "path");
  for (const auto& [column, value] : checks[0])
    if (again[0].contains(column) && value.find_first_not_of("0123456789.e-") == std::string::npos && !value.empty()) {
      EXPECT_DOUBLE_EQ(std::stod(again[0].at(column)), std::stod(value)) << column;
    }
  EXPECT_EQ(again[0].at("verdict"), checks[0].at("verdict"));
}

TEST_F(EvolveCommand, BestOfMapElitesIsTheMap) {
  const Arguments map{"--axis", "masses:8:36:4", "--axis", "muscle_share:0:1:3"};
  succeeded(evolve("run", joined(small("1"), map)));
  write("run/best/mine.json", "{}");
  for (const char* generations : {"1", "6"}) {
    const Outcome outcome = succeeded(evolve("run", {"--resume", "--generations", generations, "--quiet"}));
    EXPECT_THAT(outcome.output, testing::HasSubstr(path("run/best") + " holds the map"));
    const RunHistory history(path("run"));
    std::set<std::string> elites{"mine.json"}, files;
    for (const std::uint64_t id : history.living()) {
      char name[40];
      std::snprintf(name, sizeof name, "%05d-%07d.json", history.individuals()[id].generation, static_cast<int>(id));
      elites.insert(name);
      EXPECT_EQ(load_robot(path(std::string("run/best/") + name)), history.grow(id));
    }
    for (const auto& file : std::filesystem::directory_iterator(path("run/best"))) files.insert(file.path().filename());
    EXPECT_EQ(files, elites);
    EXPECT_GT(files.size(), 3u);
  }
}

// By the table of all who lived.
TEST_F(EvolveCommand, GenerationsSayHowFullTheMapIsAndHowManyLinesLive) {
  const Arguments map{"--axis", "masses:8:36:4", "--axis", "muscle_share:0:1:3"};
  for (const Arguments& cells : {Arguments{}, Arguments{"--niches", "20"}}) {
    const std::string run = cells.empty() ? "grid" : "niches";
    succeeded(evolve(run, joined(small("5"), map, cells)));
    std::map<std::string, std::string> line_of;  // the first ancestor, by id
    std::set<std::string> lines;
    double living = 0, sum = 0;
    for (const auto& row : rows_of(read(run + "/first_parents.csv"))) {
      const std::string& parent = row.at("ancestor_list");  // "[12]", "[none]"
      const std::string& id = row.at("id");
      line_of[id] = parent == "[none]" ? id : line_of.at(parent.substr(1, parent.size() - 2));
      if (row.at("destruction_time") != "inf") continue;
      ++living;
      sum += std::stod(row.at("score"));
      lines.insert(line_of[id]);
    }
    const auto last = rows_of(read(run + "/generations.csv")).back();
    EXPECT_EQ(last.at("lines"), std::to_string(lines.size()));
    EXPECT_EQ(std::stod(last.at("cells")), living);
    EXPECT_DOUBLE_EQ(std::stod(last.at("coverage")), living / (cells.empty() ? 12 : 20));
    EXPECT_NEAR(std::stod(last.at("qd_score")), sum, 1e-12 * std::abs(sum));
  }
  succeeded(evolve("no-map", small("1")));
  EXPECT_EQ(rows_of(read("no-map/generations.csv")).back().at("coverage"), "");
}

TEST_F(EvolveCommand, StepsOfMusclesAreSettingsOfARun) {
  const Arguments steps{"--genes", "both", "--muscle-adaptation", "--muscle-tail", "1"};
  succeeded(evolve("whole", joined(small("4"), steps)));
  succeeded(evolve("parts", joined(small("2"), steps)));
  succeeded(evolve("parts", {"--resume", "--generations", "4", "--quiet"}));
  EXPECT_EQ(lineage("parts"), lineage("whole"));
  EXPECT_THAT(read("whole/run.toml"), testing::HasSubstr("\nmuscle_adaptation = true"));
  EXPECT_THAT(read("whole/run.toml"), testing::HasSubstr("\nmuscle_tail = 1"));
  EXPECT_THAT(evolve("body", joined(small("1"), {"--muscle-tail", "1"})),
              Ends(2, testing::HasSubstr("--muscle-tail: the muscles do not change; give muscles among")));
  EXPECT_THAT(evolve("numbers", {"--from", "sample:eel", "--genes", "muscles", "--algorithm", "cma-es",
                                 "--muscle-adaptation", "--quiet"}),
              Ends(2, testing::HasSubstr("--muscle-adaptation: does not go with --algorithm cma-es")));
}

TEST_F(EvolveCommand, GrowthOfBrainsIsASettingOfARun) {
  succeeded(evolve("whole", growing("4")));
  succeeded(evolve("parts", growing("2")));
  succeeded(evolve("parts", {"--resume", "--generations", "4", "--quiet"}));
  EXPECT_EQ(lineage("parts"), lineage("whole"));
  const std::string settings = read("whole/run.toml");
  EXPECT_THAT(settings, testing::HasSubstr("\nbrain_growth = true"));
  EXPECT_THAT(settings, testing::HasSubstr("\nnew_neurons = 0.3"));
  EXPECT_THAT(settings, testing::HasSubstr("\nname = \"neat\""));
  EXPECT_THAT(settings, testing::HasSubstr("\nspecies_distance = 3.0"));
  EXPECT_THAT(mercury({"info", path("whole")}).output, testing::HasSubstr("; brains grow"));
  const auto refused = [&](const Arguments& options, const std::string& message) {
    EXPECT_THAT(evolve("refused", joined(small("1"), options)), Ends(2, message));
  };
  refused({"--brain-growth"}, "--brain-growth: brains do not change; give brain among the genes");
  refused({"--genes", "body,brain", "--new-neurons", "0.1"}, "--new-neurons: goes with brain growth alone");
  refused({"--genes", "body,brain", "--brain-growth", "--recurrence", "2"},
          "--recurrence: 2 is not accepted; give 0 to 1");
  refused({"--genes", "body,brain", "--algorithm", "neat"},
          "--algorithm: neat divides robots into species by brains that grow; let brains grow");
  refused({"--genes", "body,brain", "--brain-growth", "--algorithm", "neat", "--species", "0"},
          "--species: 0 is not accepted; give 1 to 10000");
}

// Counted again from the genomes, by the definition of species in NEAT.
TEST_F(EvolveCommand, GenerationsHaveTheNumberOfSpecies) {
  const Arguments settings{"--species-distance", "0.4", "--species", "1000"};
  succeeded(evolve("whole", joined(growing("4"), settings)));
  succeeded(evolve("parts", joined(growing("2"), settings)));
  succeeded(evolve("parts", {"--resume", "--generations", "4", "--quiet"}));
  const RunHistory run(path("whole"));
  const auto rows = rows_of(read("whole/generations.csv")), of_parts = rows_of(read("parts/generations.csv"));
  ASSERT_EQ(rows.size(), 5u);
  std::set<std::string> counts;
  for (int generation = 0; generation < 5; ++generation) {
    std::vector<GenomePointer> oldest;
    for (const Individual& one : run.individuals()) {
      const std::optional<int> died = run.died(one.id);
      if (one.generation > generation || (died && *died <= generation)) continue;
      const GenomePointer genome = run.genome(one.id);
      if (std::ranges::none_of(oldest, [&](const auto& other) { return *other->distance(*genome) < 0.4; }))
        oldest.push_back(genome);
    }
    const std::string& count = rows[static_cast<std::size_t>(generation)].at("species");
    EXPECT_EQ(count, std::to_string(oldest.size())) << generation;
    EXPECT_EQ(of_parts[static_cast<std::size_t>(generation)].at("species"), count) << generation;
    counts.insert(count);
  }
  EXPECT_GT(counts.size(), 1u);  // it is no constant
  succeeded(evolve("ga", small("1")));
  EXPECT_EQ(rows_of(read("ga/generations.csv")).back().at("species"), "");
}

TEST_F(EvolveCommand, NoveltyAgesIslandsAndEmittersGoOnBitForBit) {
  const Arguments axes{"--axis", "speed_x:-0.1:0.1", "--axis", "speed_y:-0.1:0.1"};
  for (const Arguments& algorithm : {joined({"--algorithm", "novelty"}, axes),
                                     Arguments{"--algorithm", "alps", "--age-layers", "3", "--age-gap", "2"},
                                     Arguments{"--algorithm", "ga", "--islands", "2", "--migration-interval", "2"},
                                     joined({"--algorithm", "cma-me"}, axes)}) {
    const std::string name = algorithm.at(1);
    const auto options = [&](const std::string& generations) {
      Arguments all = joined(small(generations), algorithm);
      if (name != "cma-me") return all;
      all.at(1) = "sample:eel";
      return joined(all, {"--genes", "muscles"});
    };
    succeeded(evolve(name, options("4")));
    succeeded(evolve(name + "-parts", options("2")));
    succeeded(evolve(name + "-parts", {"--resume", "--generations", "4", "--quiet"}));
    EXPECT_EQ(read(name + "/first_parents.csv"), read(name + "-parts/first_parents.csv")) << name;
  }
  EXPECT_THAT(evolve("refused", joined(small("1"), {"--algorithm", "ga", "--axis", "masses"})),
              Ends(2, testing::HasSubstr("--axis: goes with --algorithm map-elites, novelty or cma-me")));
  const Outcome pipelined = evolve("pipelined", joined(small("1"), {"--algorithm", "novelty", "--pipelined"}, axes));
  EXPECT_EQ(pipelined.status, 2);
  EXPECT_THAT(pipelined.messages, testing::HasSubstr("novelty learns from each generation"));
}

// All champions are checked, beside the search; those whose results hold are in best/, and no others.
TEST_F(EvolveCommand, OnlyConfirmedChampionsAreInBest) {
  const Arguments settings{"--from",   "voxel:3x2x2", "--population", "8", "--generations", "6", "--seconds", "1",
                           "--device", "cpu",         "--seed",       "5", "--quiet"};
  const Outcome outcome = succeeded(evolve("run", settings));
  EXPECT_THAT(outcome.output, testing::HasSubstr(" champions are confirmed"));
  const std::string checks = read("run/checks.csv");
  std::vector<std::string> confirmed;
  std::size_t checked = 0;
  std::istringstream lines(checks);
  std::string line;
  for (std::getline(lines, line); std::getline(lines, line); ++checked) {
    char name[40];
    int id = 0, generation = 0;
    ASSERT_EQ(std::sscanf(line.c_str(), "%d,%d,", &id, &generation), 2);
    std::snprintf(name, sizeof name, "%05d-%07d.json", generation, id);
    if (line.find(",confirmed,") != std::string::npos) confirmed.emplace_back(name);
  }
  const RunHistory history(path("run"));
  std::set<std::uint64_t> champions;
  for (const GenerationSummary& generation : history.generations()) champions.insert(generation.best);
  EXPECT_EQ(checked, champions.size());
  EXPECT_EQ(std::filesystem::exists(path("run/best")) ? listing("run/best") : std::vector<std::string>{}, confirmed);

  // The search does not notice, and what is lost is made again.
  succeeded(evolve("unchecked", joined(settings, {"--no-confirm"})));
  EXPECT_EQ(lineage("unchecked"), lineage("run"));
  EXPECT_EQ(listing("unchecked/best").size(), champions.size());
  std::filesystem::remove(path("run/checks.csv"));
  std::filesystem::remove_all(path("run/best"));
  succeeded(evolve("run", {"--resume", "--quiet"}));
  EXPECT_EQ(read("run/checks.csv"), checks);
  EXPECT_EQ(std::filesystem::exists(path("run/best")) ? listing("run/best") : std::vector<std::string>{}, confirmed);
}

TEST_F(EvolveCommand, MakesARunFolder) {
  const Outcome outcome = succeeded(evolve("run", small()));
  EXPECT_EQ(outcome.messages, "");
  EXPECT_THAT(listing("run"), testing::IsSupersetOf({"checks.csv", "generations.csv", "genomes", "lineage.csv",
                                                     "progress.svg", "run.toml"}));
  const RunHistory history(path("run"));
  EXPECT_EQ(history.generations().size(), 5u);
  EXPECT_EQ(history.individuals().size(), 5u * 8);
  EXPECT_THAT(outcome.output, testing::HasSubstr("best: distance = "));
}

TEST_F(EvolveCommand, FoldingIsMeasuredWhereAnObjectiveOrAxisNamesIt) {
  for (const Arguments& asks : {Arguments{"--objective", "distance - inverted"},
                                Arguments{"--algorithm", "map-elites", "--axis", "overlap:0:1:4"}}) {
    succeeded(evolve("folds", joined(small("1"), asks, {"--force"})));
    const RunHistory run(path("folds"));
    for (const Individual& one : run.individuals()) {
      EXPECT_TRUE(std::isfinite(one.assessment.values[find_quantity("inverted").value()]));
      EXPECT_TRUE(std::isfinite(one.score()));
    }
  }
  succeeded(evolve("plain", small("1")));
  for (const Individual& one : RunHistory(path("plain")).individuals())
    EXPECT_TRUE(std::isnan(one.assessment.values[find_quantity("inverted").value()]));
}

TEST_F(EvolveCommand, UprightIsMeasuredWhereAnObjectiveOrAxisNamesIt) {
  for (const Arguments& asks : {Arguments{"--objective", "distance * upright"},
                                Arguments{"--algorithm", "map-elites", "--axis", "upright:-1:1:4"}}) {
    succeeded(evolve("stands", joined(small("1"), asks, {"--force"})));
    for (const Individual& one : RunHistory(path("stands")).individuals())
      EXPECT_TRUE(std::isfinite(one.assessment.values[find_quantity("upright").value()]));
  }
}

// A search among the muscles of a robot file: in one go, in two parts, and in shards.
TEST_F(EvolveCommand, TrialsAroundATargetGoOnBitForBitAndAreThereAgainInRun) {
  const auto run = [&](const char* folder, const char* generations) {
    return evolve(folder, joined(small(generations), {"--target-radius", "0.4", "--target-spread", "0.9", "--turned",
                                                      "--reach", "0.3", "--mean", "--trials", "4", "--objective",
                                                      "reached - target_nearest", "--no-confirm"}));
  };
  succeeded(run("whole", "3"));
  succeeded(run("parts", "1"));
  succeeded(evolve("parts", {"--resume", "--generations", "2", "--quiet"}));
  succeeded(evolve("parts", {"--merge", "--generations", "3", "--quiet"}));
  for (const char* shard : {"1/2", "2/2"}) succeeded(evolve("parts", {"--shard", shard, "--quiet"}));
  succeeded(evolve("parts", {"--merge", "--quiet"}));
  EXPECT_EQ(lineage("parts"), lineage("whole"));
  const RunHistory history(path("whole"));
  const Individual& best = history.individuals()[history.living().front()];
  const Outcome again = mercury({"run", path("whole"), "--robot", "best", "--json", "--device", "cpu"});
  const auto robot = nlohmann::json::parse(again.output)["robots"][0];
  EXPECT_DOUBLE_EQ(robot["reached"].get<double>(), best.assessment.values[*find_quantity("reached")]);
  char hash[20];
  std::snprintf(hash, sizeof hash, "%016llx", static_cast<unsigned long long>(best.assessment.hash));
  EXPECT_EQ(robot["hash"], hash);
}

TEST_F(EvolveCommand, CmaEsGoesOnBitForBitAndSaysWhatItCannotSearch) {
  for (const char* algorithm : {"cma-es", "sep-cma-es"}) {
    const auto run = [&](const char* folder, const char* generations) {
      return evolve(folder, {"--from", "sample:eel", "--genes", "muscles", "--algorithm", algorithm, "--seconds", "0.1",
                             "--trials", "1", "--generations", generations, "--no-confirm", "--quiet", "--force"});
    };
    const Outcome whole = succeeded(run("whole", "5"));
    const RunHistory history(path("whole"));
    const std::size_t numbers = history.genome(0)->numbers().size();
    EXPECT_GE(numbers, 4u);
    EXPECT_EQ(history.generations()[0].born, 4 + static_cast<std::size_t>(3 * std::log(static_cast<double>(numbers))));
    succeeded(run("parts", "2"));
    succeeded(evolve("parts", {"--resume", "--generations", "5", "--quiet"}));
    EXPECT_EQ(lineage("parts"), lineage("whole"));
    succeeded(run("shards", "3"));
    succeeded(evolve("shards", {"--merge", "--generations", "5", "--quiet"}));
    for (int generation = 4; generation <= 5; ++generation) {
      for (const char* shard : {"1/2", "2/2"}) succeeded(evolve("shards", {"--shard", shard, "--quiet"}));
      succeeded(evolve("shards", {"--merge", "--quiet"}));
    }
    EXPECT_EQ(lineage("shards"), lineage("whole"));
  }
  const auto refused = [&](const Arguments& more) {
    const Outcome outcome = evolve("refused", joined({"--algorithm", "cma-es"}, more));
    EXPECT_EQ(outcome.status, 2);
    return outcome.messages;
  };
  EXPECT_EQ(
      refused({"--from", "voxel:2x2x2"}),
      "mercury: --algorithm: cma-es needs genomes that are a fixed list of numbers: the muscles of a robot file, the "
      "weights of its brain, or a tapered robot\n");
  EXPECT_EQ(refused({"--from", "sample:eel", "--genes", "muscles", "--tournament", "3"}),
            "mercury: --tournament: does not go with --algorithm cma-es\n");
  EXPECT_FALSE(std::filesystem::exists(path("refused")));
}

TEST_F(EvolveCommand, LineageDoesNotDependOnThreads) {
  const std::string lineage_of_all_threads = expected_lineage();
  succeeded(evolve("one", joined(small(), {"--threads", "1"})));
  EXPECT_EQ(lineage("one"), lineage_of_all_threads);
  EXPECT_THAT(lineage_of_all_threads, testing::HasSubstr("ancestor_list"));
}

TEST_F(EvolveCommand, LineageDependsOnTheSeed) {
  succeeded(evolve("other", joined(small(), {"--seed", "6"})));
  EXPECT_NE(lineage("other"), expected_lineage());
}

TEST_F(EvolveCommand, GenerationsCanBeRaised) {
  succeeded(evolve("run", small("2")));
  succeeded(evolve("run", {"--resume", "--generations", "4", "--quiet"}));
  EXPECT_EQ(lineage("run"), expected_lineage());
}

TEST_F(EvolveCommand, MissingDevicesAreNoticedBeforeAFolderIsMade) {
  if (cuda_device_count() > 0) GTEST_SKIP() << "needs a machine without a GPU";
  const Outcome outcome = evolve("run", {"--device", "cuda"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(std::ranges::count(outcome.messages, '\n'), 1) << outcome.messages;
  EXPECT_EQ(listing(), std::vector<std::string>{});
}

TEST_F(EvolveCommand, RunsAreReplacedOnlyWithForce) {
  succeeded(evolve("run", small("1")));
  const std::string before = lineage("run");
  EXPECT_THAT(evolve("run", joined(small("1"), {"--seed", "9"})),
              Ends(2, path("run") + ": holds a run; --resume goes on with it, --force replaces it"));
  EXPECT_EQ(lineage("run"), before);
  succeeded(evolve("run", joined(small("1"), {"--seed", "9", "--force"})));
  EXPECT_NE(lineage("run"), before);
}

TEST_F(EvolveCommand, ResumedRunsKeepTheirSettings) {
  succeeded(evolve("run", small("1")));
  EXPECT_THAT(evolve("run", {"--resume", "--seconds", "3"}),
              Ends(2,
                   "--seconds: a run that goes on keeps its settings; only --generations, "
                   "--device and --threads may change"));
}

TEST_F(EvolveCommand, StartsFromRobotFiles) {
  succeeded(mercury({"new", "voxel", "-o", path("parents"), "--count", "3", "--voxels", "3x2x2"}));
  succeeded(evolve(
      "run", {"--from", path("parents"), "--population", "6", "--generations", "1", "--seconds", "0.2", "--quiet"}));
  const RunHistory history(path("run"));
  for (std::uint64_t id : {0, 1, 2})
    EXPECT_EQ(history.grow(id).masses, load_robot(path("parents/voxel-1-" + std::to_string(id) + ".json")).masses);
}

TEST_F(EvolveCommand, MusclesOfAnyBody) {
  succeeded(evolve("run", {"--from", MERCURY_ROBOT_LIBRARY "/eel.json", "--genes", "muscles", "--population", "4",
                           "--generations", "1", "--seconds", "0.1", "--quiet"}));
  const RunHistory history(path("run"));
  const Robot eel = load_robot(MERCURY_ROBOT_LIBRARY "/eel.json"), last = history.grow(7);
  EXPECT_EQ(last.masses, eel.masses);
  EXPECT_EQ(last.springs, eel.springs);
  EXPECT_FALSE(std::ranges::equal(materials_of(last), materials_of(eel)));
}

TEST_F(EvolveCommand, BrainsGoOnAsIfTheRunHadNotStopped) {
  const Arguments brains{"--genes", "brain,both", "--target", "1,0,0", "--objective", "-target_distance"};
  succeeded(evolve("whole", joined(small("4"), brains)));
  succeeded(evolve("parts", joined(small("1"), brains)));
  succeeded(evolve("parts", {"--resume", "--generations", "4", "--quiet"}));
  EXPECT_EQ(lineage("parts"), lineage("whole"));
  const RunHistory whole(path("whole")), parts(path("parts"));
  EXPECT_EQ(whole.settings().space.genes, Genes::both | Genes::brain);
  for (std::uint64_t id = 0; id < whole.individuals().size(); ++id) {
    EXPECT_EQ(parts.genome(id)->encode(), whole.genome(id)->encode()) << id;
    const Robot robot = whole.grow(id);
    EXPECT_EQ(robot.brain.has_value(), !actuators_of(robot).empty()) << id;
  }
}

TEST_F(EvolveCommand, ChampionsHaveTheBrainThatEvolved) {
  succeeded(evolve("run", {"--from", "sample:hunter", "--genes", "brain", "--target", "-2,3,0", "--objective",
                           "-target_distance", "--population", "4", "--generations", "1", "--seconds", "0.5",
                           "--trials", "1", "--no-confirm", "--quiet"}));
  const RunHistory history(path("run"));
  std::set<std::filesystem::path> files;
  for (const auto& file : std::filesystem::directory_iterator(path("run/best"))) files.insert(file.path());
  ASSERT_FALSE(files.empty());
  const Robot champion = load_robot(*files.rbegin()), hunter = load_robot(sample_or_path("sample:hunter"));
  EXPECT_EQ(champion.brain, history.grow(history.living().front()).brain);
  EXPECT_EQ(champion.springs, hunter.springs);
  EXPECT_EQ(champion.sensors, hunter.sensors);
  EXPECT_NE(champion.brain, hunter.brain);
}

TEST_F(EvolveCommand, SaysWhyNoRobotCanBeTried) {
  const Outcome outcome =
      evolve("run", {"--from", "shell", "--damage", "0.1", "--population", "4", "--seconds", "0.1", "--quiet"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.messages,
            "mercury: generation 0: no robot can be tried: damage: only robots of voxels can lose some\n");
}

struct BadOptions {
  Arguments options;
  std::string message;
};
void PrintTo(const BadOptions& bad, std::ostream* out) {
  for (const std::string& option : bad.options) *out << option << ' ';
}
class EvolveOptions : public FolderTest, public testing::WithParamInterface<BadOptions> {};

TEST_P(EvolveOptions, AreRefusedInOneLineBeforeAnythingIsMade) {
  EXPECT_THAT(mercury(joined({"evolve", path("run")}, GetParam().options)),
              Ends(2, testing::StartsWith(GetParam().message)));
  EXPECT_EQ(listing(), std::vector<std::string>{});
}

INSTANTIATE_TEST_SUITE_P(
    Bad, EvolveOptions,
    testing::Values(
        BadOptions{{"--from", "fish:3"}, "--from: \"fish:3\" is neither a file or folder nor a kind"},
        BadOptions{{"--from", "voxel:6x4"}, "--from: \"6x4\" is not accepted"},
        BadOptions{{"--algorithm", "luck"}, "--algorithm: "},
        BadOptions{{"--objective", "distance -"}, "--objective: "},
        BadOptions{{"--objective", "elegance"}, "--objective: "},
        BadOptions{{"--objective", "distance", "--objective", "-work", "--algorithm", "ga"},
                   "--algorithm: ga takes one objective"},
        BadOptions{{"--axis", "charm"}, "--axis: \"charm\" is not a quantity"},
        BadOptions{{"--axis", "masses", "--algorithm", "ga"}, "--axis: goes with"},
        BadOptions{{"--axis", "masses:5:2"}, "--axis: masses needs two finite ends"},
        BadOptions{{"--axis", "masses:1:2:0"}, "--axis: masses needs at least one cell"},
        BadOptions{{"--axis", "masses:1:2:5000", "--axis", "work:1:2:5000"}, "--axis: the map has more"},
        BadOptions{{"--population", "0"}, "--population: "}, BadOptions{{"--settle", "20"}, "--settle: "},
        BadOptions{{"--trials", "0"}, "--trials: "}, BadOptions{{"--racing", "--trials", "2"}, "--racing: "},
        BadOptions{{"--damage", "1"}, "--damage: "}, BadOptions{{"--mutation", "-1"}, "--mutation: "},
        BadOptions{{"--generations", "-1"}, "--generations: "},
        BadOptions{{"--genes", "soul"}, "--genes: \"soul\" is not accepted; give body, muscles, both, brain"},
        BadOptions{{"--genes", "brain"}, "--genes: brain alone needs robots that have one, and voxel robots"},
        BadOptions{{"--from", "sample:eel", "--genes", "brain"},
                   "--genes: brain alone needs robots that have one, and robot eel has none; start from"},
        BadOptions{{"--children", "18446744073709551615"},
                   "--children: 18446744073709551615 is not accepted; give 0 to 1000000"},
        BadOptions{{"--generations", "2147483647"}, "--generations: 2147483647 is not accepted; give 0 to 1000000000"},
        BadOptions{{"--noise", "1.5"}, "--noise: 1.5 is not accepted; give 0 to 1"},
        BadOptions{{"--noise", "nan"}, "--noise: "},
        BadOptions{{"--axis", "masses", "--axis", "masses:0:9"}, "--axis: masses is given twice"},
        BadOptions{{"--shard", "0/4"}, "--shard: \"0/4\" is not accepted"}, BadOptions{{"--resume"}, ""}));

}  // namespace
}  // namespace mercury::test
