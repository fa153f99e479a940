// SPDX-License-Identifier: Apache-2.0
#include "mercury/run_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <csignal>

#include "evolution/run_folder/derived_files.h"
#include "evolution/run_folder/journal.h"
#include "mercury/random_voxel.h"
#include "mercury/robot_file.h"
#include "tests/evolution/run_folder/test_run.h"

namespace mercury {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
namespace fs = std::filesystem;

using RunFolders = RunFolderTest;

TEST_F(RunFolders, AResumedRunEndsAsOneThatWasNotInterrupted) {
  make_run("whole", test_settings(10));
  create("parts", test_settings(10));
  for (int i = 0; i <= 10; ++i) {
    RunFolder run = open("parts");
    evolve(run, 1);
  }
  expect_same_run(history("whole"), history("parts"));
}

TEST_F(RunFolders, AllAlgorithmsResume) {
  for (std::size_t i = 0; i < 2 * algorithms().size(); ++i) {
    const AlgorithmDescription& algorithm = algorithms()[i / 2];
    const bool pipelined = i % 2;
    if (pipelined && algorithm.learns) continue;
    const std::string name = std::string(algorithm.name) + (pipelined ? "-pipelined" : "");
    RunSettings settings = test_settings(6);
    settings.evolution.pipelined = pipelined;
    settings.evolution.algorithm.name = algorithm.name;
    settings.evolution.algorithm.axes = {{.quantity = std::string(quantities()[0].name), .lowest = -1, .highest = 1}};
    if (algorithm.many_objectives) settings.evolution.objectives = {"distance", "-distance"};
    make_run(name, settings);
    RunFolder run = create(name + "-parts", settings);
    evolve(run, 3);
    { const RunFolder closed = std::move(run); }
    RunFolder again = open(name + "-parts");
    evolve(again);
    expect_same_run(history(name), again.history());
  }
}

TEST_F(RunFolders, IslandsResume) {
  for (const bool pipelined : {false, true}) {
    const std::string name = pipelined ? "pipelined" : "run";
    RunSettings settings = island_settings(8);
    settings.evolution.pipelined = pipelined;
    make_run(name, settings);
    create(name + "-parts", settings);
    for (int i = 0; i <= 8; ++i) {
      RunFolder run = open(name + "-parts");
      evolve(run, 1);
    }
    expect_same_run(history(name), history(name + "-parts"));
    EXPECT_EQ(std::ranges::count_if(history(name).individuals(), &Individual::is_migrant), 4 * 3);
  }
}

TEST_F(RunFolders, TablesHaveTheIslands) {
  RunFolder run = create("run", island_settings(4));
  evolve(run);
  run.write_all();
  const std::string lineage = read("run/lineage.csv"), generations = read("run/generations.csv");
  EXPECT_THAT(lineage, HasSubstr(",seed,fate,island,score,"));
  EXPECT_THAT(generations.substr(0, generations.find('\n')),
              EndsWith(",device,best_of_island_0,best_of_island_1,best_of_island_2"));
  std::vector<double> best(3, worst_score);
  for (const std::uint64_t id : run.history().living()) {
    const Individual& individual = run.history().individuals()[id];
    best[individual.island] = std::max(best[individual.island], individual.score());
  }
  EXPECT_EQ(run.history().generations().back().best_of_islands, best);
  // A copy has not been mutated.
  const auto all = run.history().individuals();
  const auto migrant = std::ranges::find_if(all, &Individual::is_migrant);
  EXPECT_THAT(run.history().grow(migrant->id).origin, testing::Not(HasSubstr("mutation_seed")));
  make_run("one", test_settings(2));
  RunFolder one = open("one");
  one.write_all();
  EXPECT_THAT(read("one/lineage.csv"), testing::Not(HasSubstr("island")));
  EXPECT_THAT(read("one/generations.csv"), testing::Not(HasSubstr("island")));
}

// A process is killed while it writes, at moments that differ.
TEST_F(RunFolders, AKilledRunEndsAsOneThatWasNotInterrupted) {
  const RunSettings settings = island_settings(40);
  make_run("whole", settings);
  create("killed", settings);
  const std::size_t whole = history("whole").generations().size();
  int kills = 0;
  for (std::uint64_t moment = 1; history("killed").generations().size() < whole; ++moment) {
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      // SIGKILL by a timer of the kernel, so that it also comes within a write.
      struct sigevent event {};
      event.sigev_notify = SIGEV_SIGNAL;
      event.sigev_signo = SIGKILL;
      timer_t timer{};
      itimerspec when{};
      when.it_value.tv_nsec = static_cast<long>(200'000 + Random(moment).below(6'000'000 * moment));
      timer_create(CLOCK_MONOTONIC, &event, &timer);
      timer_settime(timer, 0, &when, nullptr);
      try {
        RunFolder run = open("killed");
        evolve(run);
      } catch (...) {
        _exit(1);
      }
      _exit(0);
    }
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    if (WIFEXITED(status)) {
      ASSERT_EQ(WEXITSTATUS(status), 0);
      break;
    }
    ++kills;
  }
  EXPECT_GT(kills, 0);
  expect_same_run(history("whole"), history("killed"));
}

TEST_F(RunFolders, GenerationsCanBeRaised) {
  make_run("whole", test_settings(8));
  make_run("raised", test_settings(3));
  {
    RunFolder run = open("raised");
    run.set_generations(8);
    EXPECT_EQ(run.history().settings().evolution.generations, 8);
    evolve(run);
  }
  expect_same_run(history("whole"), history("raised"));
  EXPECT_EQ(history("raised").settings().evolution.generations, 8);
}

TEST_F(RunFolders, ReadersSeeWhatIsAppended) {
  RunFolder run = create("run", test_settings(3));
  RunHistory reader = history("run");
  EXPECT_FALSE(reader.refresh());
  evolve(run, 2);
  EXPECT_EQ(reader.generations().size(), 0u);
  EXPECT_TRUE(reader.refresh());
  EXPECT_EQ(reader.generations().size(), 2u);
  expect_same_run(reader, run.history());
  EXPECT_FALSE(reader.refresh());
}

TEST_F(RunFolders, KnowsLinesChampionsAndDeaths) {
  RunSettings settings = test_settings(20);
  settings.evolution.algorithm.name = "ga";
  make_run("run", settings);
  const RunHistory run = history("run");
  for (const GenerationSummary& generation : run.generations()) {
    double best = worst_score;
    for (const Individual& individual : run.individuals()) {
      const std::optional<int> died = run.died(individual.id);
      const bool lived = individual.generation <= generation.number && (!died || *died > generation.number);
      if (lived) best = std::max(best, individual.score());
    }
    const std::uint64_t champion = run.champion(generation.number);
    EXPECT_EQ(run.individuals()[champion].score(), best);
    EXPECT_EQ(generation.scores[0].highest, best);
    EXPECT_EQ(generation.median_score, generation.scores[0].median);
    EXPECT_EQ(generation.born, 12u);
  }
  const std::vector<std::uint64_t> line = run.line_of(run.champion(20));
  EXPECT_GT(line.size(), 2u);
  EXPECT_TRUE(run.individuals()[line.front()].parents.empty());
  EXPECT_EQ(line.back(), run.champion(20));
  for (std::size_t i = 1; i < line.size(); ++i) EXPECT_EQ(run.individuals()[line[i]].parents.front(), line[i - 1]);
}

TEST_F(RunFolders, ChampionsAreRobotFiles) {
  make_run("run", test_settings(10));
  RunFolder folder = open("run");
  folder.write_all();
  const RunHistory& run = folder.history();
  std::optional<std::uint64_t> previous;
  std::size_t champions = 0;
  for (int generation = 0; generation <= 10; ++generation) {
    const std::uint64_t id = run.champion(generation);
    if (id == previous) continue;
    previous = id;
    ++champions;
    char name[64];
    std::snprintf(name, sizeof name, "run/best/%05d-%07d.json", generation, static_cast<int>(id));
    EXPECT_EQ(load_robot(path(name)), run.grow(id)) << name;
    EXPECT_EQ(run.grow(id).name, "run-" + std::to_string(id));
  }
  EXPECT_EQ(static_cast<std::size_t>(std::distance(fs::directory_iterator(path("run/best")), {})), champions);
}

TEST_F(RunFolders, DerivedFilesAreMadeAgainTheSame) {
  make_run("run", test_settings(4));
  open("run").write_all();
  std::vector<std::string> before;
  for (const std::string_view name : derived_file_names) before.push_back(read("run/" + std::string(name)));
  const std::string champion = fs::directory_iterator(path("run/best"))->path().filename().string();
  const std::string robot = read("run/best/" + champion);
  for (const std::string_view name : derived_file_names) fs::remove(path("run/" + std::string(name)));
  fs::remove_all(path("run/best"));
  open("run").write_all();
  for (std::size_t i = 0; i < before.size(); ++i)
    EXPECT_EQ(read("run/" + std::string(derived_file_names[i])), before[i]) << derived_file_names[i];
  EXPECT_EQ(read("run/best/" + champion), robot);
}

TEST_F(RunFolders, TwoProcessesCannotWriteTheSameRun) {
  RunFolder first = create("run");
  evolve(first, 2);
  const std::string expected = path("run").string() + ": another process is evolving in this folder; give another one";
  EXPECT_EQ(error_of([&] { open("run"); }), expected);
  EXPECT_EQ(error_of([&] { create("run", test_settings(), true); }), expected);
  EXPECT_EQ(history("run").generations().size(), 2u);
  evolve(first);
  EXPECT_EQ(history("run").generations().size(), 6u);
}

// As left by a process that was killed while it made the folder.
TEST_F(RunFolders, ThatWereNotMadeToTheEndAreMadeAgain) {
  make_run("whole", test_settings(1));
  const std::string journal = read("whole/genomes");
  for (const std::size_t size : {std::size_t{0}, std::size_t{20}, journal_header_size}) {
    fs::create_directories(path("run") / "founders");
    write("run/genomes", journal.substr(0, size));
    write("run/founders/0000.json", "{");
    make_run("run", test_settings(1));
    expect_same_run(history("run"), history("whole"));
    fs::remove_all(path("run"));
  }
  fs::create_directories(path("run"));
  write("run/genomes", journal);  // with a generation
  EXPECT_THAT(error_of([&] { create("run"); }), EndsWith("is not empty; give a new folder"));
  EXPECT_EQ(read("run/genomes"), journal);
}

TEST_F(RunFolders, ThatWereReplacedAreNotWrittenTo) {
  RunFolder run = create("run", test_settings(4));
  evolve(run, 2);
  fs::rename(path("run"), path("moved"));
  EXPECT_EQ(error_of([&] { evolve(run, 1); }),
            path("run/genomes").string() + ": the run was replaced, moved or removed; open it again");
  EXPECT_EQ(error_of([&] { run.write_all(); }),
            path("run/genomes").string() + ": the run was replaced, moved or removed; open it again");
  EXPECT_FALSE(fs::exists(path("run")));
  EXPECT_EQ(history("moved").generations().size(), 2u);
}

TEST_F(RunFolders, AreNotOverwritten) {
  make_run("run");
  const std::string journal = read("run/genomes");
  EXPECT_THAT(error_of([&] { create("run"); }), HasSubstr("holds a run; give --resume"));
  EXPECT_EQ(read("run/genomes"), journal);
  fs::create_directories(path("full"));
  write("full/notes.txt", "mine");
  EXPECT_THAT(error_of([&] { create("full"); }), EndsWith("is not empty; give a new folder"));
  EXPECT_THAT(error_of([&] { create("full", test_settings(), true); }), EndsWith("is not empty; give a new folder"));
  write("file", "");
  EXPECT_THAT(error_of([&] { create("file"); }), EndsWith("is a file; give a new folder"));
  EXPECT_EQ(error_of([&] { create("a/new/one"); }), "");
}

TEST_F(RunFolders, ForceReplacesARunAndNothingElse) {
  make_run("run");
  open("run").write_all();
  write("run/notes.txt", "mine");
  write("run/best/mine.json", "mine");
  RunHistory before = history("run");
  RunSettings settings = test_settings(2);
  settings.evolution.seed = 7;
  {
    RunFolder run = create("run", settings, true);
    EXPECT_EQ(run.history().generations().size(), 0u);
    evolve(run);
  }
  EXPECT_EQ(history("run").generations().size(), 3u);
  EXPECT_EQ(read("run/notes.txt"), "mine");
  EXPECT_EQ(read("run/best/mine.json"), "mine");
  // A reader of the old run goes on with what it knows, and learns that there is no more.
  EXPECT_NO_THROW(before.genome(0));
  EXPECT_THAT(error_of([&] { before.refresh(); }), HasSubstr("was replaced"));
}

TEST_F(RunFolders, SettingsThatCannotBeUsedRemoveNothing) {
  make_run("run");
  RunSettings settings = test_settings();
  settings.evolution.algorithm.population = 0;
  EXPECT_NE(error_of([&] { create("run", settings, true); }), "");
  EXPECT_EQ(history("run").generations().size(), 6u);
}

TEST_F(RunFolders, HostileOnesGiveOneLineAndLoseNothing) {
  RunSettings settings = test_settings();
  settings.space.founders = {random_voxel_robot({}, 1)};
  make_run("run", settings);
  const std::string journal = read("run/genomes"), toml = read("run/run.toml");
  const auto refuses = [&](const std::string& part) {
    for (const std::string& error : {error_of([&] { history("run"); }), error_of([&] { open("run"); })}) {
      EXPECT_TRUE(is_one_line(error)) << error;
      EXPECT_THAT(error, HasSubstr(part));
    }
    EXPECT_EQ(read("run/genomes"), journal);
  };
  std::string edited = toml;
  edited.replace(edited.find("seed = 1"), 8, "seed = 2");
  write("run/run.toml", edited);
  refuses("differs from the settings that the run began with");
  fs::remove(path("run/run.toml"));
  refuses("is not the folder of a run: it has no run.toml");
  write("run/run.toml", "# a note\n" + toml);
  EXPECT_EQ(error_of([&] { open("run"); }), "");
  fs::rename(path("run/founders/0000.json"), path("elsewhere"));
  refuses("founders/0000.json: No such file or directory");
  save_robot(path("run/founders/0000.json"), random_voxel_robot({}, 2));
  refuses("differs from the settings");
  fs::rename(path("elsewhere"), path("run/founders/0000.json"));
  fs::remove(path("run/genomes"));
  EXPECT_THAT(error_of([&] { open("run"); }), HasSubstr("genomes: No such file or directory"));
  fs::create_directories(path("run/genomes"));
  EXPECT_TRUE(is_one_line(error_of([&] { open("run"); })));
  EXPECT_THAT(error_of([&] { history("nowhere"); }), EndsWith("nowhere: No such file or directory"));
  write("file", "");
  EXPECT_THAT(error_of([&] { history("file"); }), EndsWith("file: is not a folder"));
}

// A received folder might have them.
TEST_F(RunFolders, LinksOutOfThemAreNotFollowed) {
  make_run("run", test_settings(2));
  std::filesystem::create_directory(path("outside"));
  write("outside/mine.csv", "mine");
  for (const char* name : {"lineage.csv", "generations.csv", "progress.svg", "genomes", "run.toml", "best"}) {
    SCOPED_TRACE(name);
    const std::filesystem::path file = path("run/" + std::string(name)), aside = path("aside");
    std::filesystem::rename(file, aside);
    const bool is_folder = std::filesystem::is_directory(aside);
    std::filesystem::create_symlink(is_folder ? path("outside") : path("outside/mine.csv"), file);
    if (!is_folder && (std::string(name) == "genomes" || std::string(name) == "run.toml"))
      std::filesystem::copy_file(aside, path("outside/mine.csv"), std::filesystem::copy_options::overwrite_existing);
    const std::string before = read("outside/mine.csv");
    EXPECT_THAT(error_of([&] { open("run"); }),
                HasSubstr(std::string(name) + ": is a link out of " + path("run").string()));
    EXPECT_EQ(read("outside/mine.csv"), before);
    std::filesystem::remove(file);
    std::filesystem::rename(aside, file);
  }
  std::filesystem::rename(path("run/lineage.csv"), path("run/kept.csv"));
  std::filesystem::create_symlink("kept.csv", path("run/lineage.csv"));  // stays inside
  open("run");
}

// Opening a pipe waits for a process at its other end.
TEST_F(RunFolders, PipesInThemAreRefused) {
  make_run("run", test_settings(2));
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(path("run")))
    if (entry.is_regular_file()) files.push_back(entry.path());
  EXPECT_GE(files.size(), 6u);
  for (const fs::path& file : files) {
    fs::rename(file, path("aside"));
    ASSERT_EQ(mkfifo(file.c_str(), 0600), 0);
    EXPECT_EQ(error_of([&] { open("run"); }), file.string() + ": not a regular file");
    fs::remove(file);
    fs::rename(path("aside"), file);
  }
  open("run");
}

TEST_F(RunFolders, ReadOnlyOnesCanBeReadAndNotWritten) {
  if (geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  make_run("run");
  fs::permissions(path("run/genomes"), fs::perms::owner_read);
  EXPECT_EQ(history("run").generations().size(), 6u);
  EXPECT_THAT(error_of([&] { open("run"); }), EndsWith("genomes: Permission denied"));
}

}  // namespace
}  // namespace mercury
