// SPDX-License-Identifier: Apache-2.0
// The evolution that the window has open: what it reads while the folder changes, and the process that it starts.
#include "app/live/live_run.h"

#include <gmock/gmock.h>

#include "app/live/live_scene.h"
#include "tests/app/live/live_scene_setup.h"
#include "tests/app/live/run_setup.h"
#include "tests/app/program.h"
#include "tests/nap.h"

namespace mercury {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using Activity = LiveRun::Activity;

class LiveRunTest : public test::FolderTest {
 protected:
  static std::vector<std::string> texts(LiveRun& run) {
    std::vector<std::string> texts;
    for (const Message& message : run.take_messages()) texts.push_back(message.text);
    return texts;
  }
  static void read_again(LiveRun& run) {
    run.refresh();
    run.wait();
  }
  // Waits until the process of `run` has ended.
  static void finish(LiveRun& run) {
    for (; run.activity() != Activity::none; test::nap()) run.frame();
    run.wait();
  }
  static std::vector<LiveRobot> founders(std::size_t count) {
    LiveScene scene(test::on_cpu());
    test::make_robots(scene, count);
    std::vector<LiveRobot> robots;
    for (const DocumentRobot& robot : scene.document().robots) robots.push_back(robot.body);
    return robots;
  }
  EvolveRequest request() const {
    EvolveRequest request{.folder = path("run")};
    request.settings.configuration = configuration_;
    request.settings.algorithm.population = 4;
    request.settings.generations = 3;
    request.settings.trials.seconds = 0.05;
    return request;
  }
  // A program that prints its words into the file "words" and then does what `script` says.
  std::string program(const std::string& script) const {
    write("program", "#!/bin/sh\nfor word; do echo \"$word\"; done > " + path("words") + "\n" + script + "\n", true);
    return path("program");
  }
  const Configuration configuration_ = test::on_cpu().configuration;
};

TEST_F(LiveRunTest, TheBestRobotsAreShownOnceAsSoonAsThereIsAGeneration) {
  test::SmallRun evolution(path("swim"));
  LiveRun run;
  std::vector<std::string> names;
  int shown = 0;
  run.open(path("swim"), [&](const std::vector<Robot>& robots, const RunView& view) {
    ++shown;
    EXPECT_EQ(view.generation(), 0);
    for (const Robot& robot : robots) names.push_back(robot.name);
  });
  run.wait();
  ASSERT_TRUE(run.view());
  EXPECT_EQ(run.name(), "swim");
  EXPECT_EQ(shown, 0);
  evolution.advance(1);
  read_again(run);
  EXPECT_EQ(shown, 1);
  ASSERT_FALSE(names.empty());
  EXPECT_EQ(names.front(), "swim-" + std::to_string(run.view()->best.front()));
  evolution.advance(1);
  read_again(run);
  EXPECT_EQ(run.view()->generation(), 1);
  EXPECT_EQ(shown, 1);
  EXPECT_THAT(texts(run), IsEmpty());
}

TEST_F(LiveRunTest, AFolderThatVanishesIsReportedOnceAndReadAgainWhenItIsBack) {
  test::SmallRun evolution(path("swim"));
  evolution.advance(2);
  LiveRun run;
  run.open(path("swim"));
  run.wait();
  std::filesystem::rename(path("swim"), path("elsewhere"));
  for (int i = 0; i < 3; ++i) read_again(run);
  EXPECT_THAT(texts(run), ElementsAre(HasSubstr(path("swim"))));
  EXPECT_THAT(run.problem(), HasSubstr("no run.toml"));
  ASSERT_TRUE(run.view());
  EXPECT_EQ(run.view()->generation(), 1);
  std::filesystem::rename(path("elsewhere"), path("swim"));
  read_again(run);
  EXPECT_EQ(run.problem(), "");
  EXPECT_THAT(texts(run), IsEmpty());
}

TEST_F(LiveRunTest, ADamagedRunIsReportedAndARobotOfItCannotBeGrown) {
  {
    test::SmallRun evolution(path("swim"));
    evolution.advance(2);
  }
  LiveRun run;
  run.open(path("swim"));
  run.wait();
  const std::string journal = read("swim/genomes");
  write("swim/genomes", std::string(journal.size(), 'x'));
  std::filesystem::resize_file(path("swim/run.toml"), 10);
  read_again(run);
  EXPECT_THAT(texts(run), SizeIs(1));
  EXPECT_NE(run.problem(), "");
  run.grow(0, [](const Robot&) { FAIL() << "grown from a damaged run"; });
  run.wait();
  EXPECT_THAT(texts(run), SizeIs(1));
}

TEST_F(LiveRunTest, AFamilyAndARobotAreReadInTheBackground) {
  test::SmallRun evolution(path("swim"));
  evolution.advance(3);
  LiveRun run;
  run.open(path("swim"));
  run.read_family(20);
  std::string name;
  run.grow(20, [&](const Robot& robot) { name = robot.name; });
  run.wait();
  ASSERT_TRUE(run.family());
  EXPECT_EQ(run.family()->line.front().individual.id, 20u);
  EXPECT_EQ(name, "swim-20");
  run.read_family(1000);
  run.wait();
  EXPECT_THAT(texts(run), ElementsAre(HasSubstr("1000")));
  run.close();
  EXPECT_FALSE(run.family());
  EXPECT_FALSE(run.view());
}

TEST_F(LiveRunTest, TheProcessGetsTheRobotsAndTheSettings) {
  LiveRun run(program("ls \"$(sed -n 's/--from=//p' " + path("words") + ")\" > " + path("founders")));
  EvolveRequest wanted = request();
  wanted.settings.objectives = {"distance - 0.1 * strain"};
  wanted.settings.trials.strain_limit = 1;
  wanted.settings.configuration.environment = Land{};
  wanted.settings.configuration.dt = 2e-3;
  run.evolve(wanted, founders(2));
  finish(run);
  const std::string words = read("words");
  for (const char* word :
       {"--algorithm=afpo", "--genes=body", "--objective=distance - 0.1 * strain", "--population=4", "--generations=3",
        "--seconds=0.05", "--strain-limit=1", "--environment=land", "--dt=0.002", "--device=cpu"})
    EXPECT_THAT(words, HasSubstr(word + std::string("\n")));
  EXPECT_TRUE(words.starts_with("evolve\n" + path("run") + "\n")) << words;
  EXPECT_EQ(read("founders"), "0000-voxel-5-0.json\n0001-voxel-5-1.json\n");
  const std::string from = words.substr(words.find("--from=") + 7);
  EXPECT_FALSE(std::filesystem::exists(from.substr(0, from.find('\n'))));
}

TEST_F(LiveRunTest, TheLastLineOfAProcessThatFailsIsReported) {
  LiveRun run(program("printf 'progress 1\\rmercury: something\\nmercury: --objective: nonsense\\n' >&2; exit 2"));
  run.evolve(request(), founders(1));
  finish(run);
  EXPECT_THAT(texts(run), ElementsAre("--objective: nonsense"));
  EXPECT_EQ(run.problem(), "--objective: nonsense");
  EXPECT_FALSE(run.is_open());
}

TEST_F(LiveRunTest, AProcessThatIsKilledIsReported) {
  LiveRun run(program("kill -9 $$"));
  run.evolve(request(), founders(1));
  finish(run);
  EXPECT_THAT(texts(run), ElementsAre(HasSubstr("killed")));
}

TEST_F(LiveRunTest, AProgramThatIsMissingIsReported) {
  LiveRun run(path("no-such-program"));
  run.evolve(request(), founders(1));
  finish(run);
  EXPECT_THAT(texts(run), ElementsAre(HasSubstr("no-such-program")));
}

TEST_F(LiveRunTest, TheEndOfTheWindowStopsTheProcessInAnOrderlyWay) {
  {
    LiveRun run(program("trap 'echo orderly > " + path("end") + "; exit 1' TERM; echo > " + path("ready") +
                        "; while :; do sleep 0.01; done"));
    run.evolve(request(), founders(1));
    for (; !std::filesystem::exists(path("ready")); test::nap()) run.frame();
  }
  EXPECT_EQ(read("end"), "orderly\n");
}

TEST_F(LiveRunTest, AProcessThatIsLeftRunningOutlivesTheWindow) {
  {
    LiveRun run(program("echo > " + path("ready") + "; while [ ! -e " + path("go") +
                        " ]; do sleep 0.01; done; echo > " + path("end")));
    run.evolve(request(), founders(1));
    for (; !std::filesystem::exists(path("ready")); test::nap()) run.frame();
    run.leave_running();
    EXPECT_EQ(run.activity(), Activity::none);
  }
  write("go", "");
  while (!std::filesystem::exists(path("end"))) test::nap();
}

}  // namespace
}  // namespace mercury
