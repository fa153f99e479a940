// SPDX-License-Identifier: Apache-2.0
// The second side and the ghosts: each shows, bit for bit, what a simulation of its own would show.
#include <gmock/gmock.h>

#include <algorithm>

#include "app/live/measurements.h"
#include "app/live/scene_comparison.h"
#include "app/live/scene_files.h"
#include "app/live/scene_parameters.h"
#include "app/live/scene_robots.h"
#include "app/live/scene_time.h"
#include "app/scene/side_difference.h"
#include "app/scene/view_words.h"
#include "mercury/error.h"
#include "mercury/random_voxel.h"
#include "tests/app/live/live_scene_setup.h"
#include "tests/app/program.h"
#include "tests/nap.h"
#include "tests/refusal.h"
#include "tests/sim/backend.h"

namespace mercury {
namespace {

using Positions = std::vector<Vec3>;

Positions positions_of(const Snapshot& snapshot) {
  const auto positions = snapshot.positions.host();
  return {positions.begin(), positions.end()};
}
Positions second_positions(const LiveScene& scene) { return positions_of(*scene.snapshot().second); }
Positions ghost_positions(const LiveScene& scene) { return positions_of(*scene.snapshot().ghosts); }

Positions positions_of(const Simulation& simulation) {
  Positions positions(simulation.mass_count());
  simulation.read_positions(positions);
  return positions;
}

// A simulation of the scene's robots in another configuration.
Simulation alone(const LiveScene& scene, const Configuration& configuration) {
  Simulation simulation(configuration);
  for (const DocumentRobot& robot : scene.document().robots) simulation.add(whole_robot(robot));
  return simulation;
}

void stiffen(LiveScene& scene, RobotId robot) {
  scene.parameters().scale_materials({robot}, {.stiffness = 1.7f, .frequency = 1.3f});
}

class ComparisonOn : public BackendTest {
 protected:
  LiveSceneOptions options(Environment environment = Ocean{}) const {
    return {.configuration = {.environment = environment, .device = device()}};
  }
};
INSTANTIATE_TEST_SUITE_P(All, ComparisonOn, every_device, BackendTest::name);

TEST_P(ComparisonOn, SecondSideIsARunOfItsOwnWithThatConfiguration) {
  test::RobotScene scene(3, options());
  for (const char* text : {"solver=xpbd", "environment=land", "damping=0.7,density=400", "dt=0.00025"}) {
    scene.time().reset();
    scene.comparison().set_second(SideDifference(text));
    test::step_and_wait(scene, 120);
    Simulation second = alone(scene, SideDifference(text).over(scene.document().configuration));
    second.step(std::llround(scene.snapshot().time / second.configuration().dt));
    ASSERT_TRUE(scene.snapshot().second) << text;
    EXPECT_TRUE(second_positions(scene) == positions_of(second)) << text;
    EXPECT_NEAR(scene.snapshot().second->time, scene.snapshot().time, 1e-9) << text;
    Simulation first = alone(scene, scene.document().configuration);
    first.step(120);
    EXPECT_TRUE(positions_of(scene.snapshot()) == positions_of(first)) << text;
  }
}

TEST_P(ComparisonOn, BothSidesBeginInTheSameStates) {
  test::RobotScene scene(2, options());
  test::step_and_wait(scene, 70);
  scene.comparison().set_second(SideDifference("solver=xpbd"));
  scene.wait_until_done();
  EXPECT_TRUE(second_positions(scene) == positions_of(scene.snapshot()));
  EXPECT_TRUE(scene.snapshot().second->velocities == scene.snapshot().velocities);
  Simulation both = alone(scene, scene.document().configuration);
  both.step(70);
  Configuration xpbd = scene.document().configuration;
  xpbd.solver = Solver::xpbd;
  both.configure(xpbd);
  both.step(50);
  test::step_and_wait(scene, 50);
  EXPECT_TRUE(second_positions(scene) == positions_of(both));
  EXPECT_EQ(scene.snapshot().second->steps, scene.snapshot().steps);
}

TEST_P(ComparisonOn, GhostHasTheBitsOfTheUnchangedRobotAlone) {
  test::RobotScene scene(3, options());
  const std::vector<RobotId> robots = test::ids_of(scene);
  test::step_and_wait(scene, 40);
  EXPECT_EQ(scene.comparison().show_ghosts({robots[1]}), 1u);
  stiffen(scene, robots[1]);
  test::step_and_wait(scene, 60);
  Simulation unchanged(scene.document().configuration,
                       std::span(scene.document().find(robots[1])->body.robot.get(), 1));
  unchanged.step(100);
  EXPECT_TRUE(ghost_positions(scene) == positions_of(unchanged));
  EXPECT_TRUE(ghost_positions(scene) !=
              Positions(scene.snapshot().positions_of(1).begin(), scene.snapshot().positions_of(1).end()));
}

// Its muscles follow a clock and what they did before.
Robot thinking_robot() {
  Robot robot = random_voxel_robot({}, 9);
  const std::size_t muscles = actuators_of(robot).size();
  robot.sensors = {{.kind = SensorKind::clock, .frequency = 9}, {.kind = SensorKind::up}};
  Brain& brain = robot.brain.emplace();
  brain.period = 0.01f;
  brain.layers = {{.name = "motor", .neurons = static_cast<std::uint32_t>(muscles), .alpha = {0.5f}}};
  NeuronInput input{.from = "senses"};
  for (std::size_t i = 0; i < 5 * muscles; ++i) input.weights.push_back(i % 5 == i / 5 % 2 ? 0.9f : 0.2f);
  brain.layers[0].inputs = {input};
  return robot;
}

TEST_P(ComparisonOn, GhostOfARobotWithAHeldNeuronHasItsWholeBrain) {
  const Robot thinker = thinking_robot();
  test::RobotScene scene(1, options());
  scene.robots().add({thinker});
  const RobotId robot = test::ids_of(scene)[1];
  test::step_and_wait(scene, 40);
  scene.parameters().clamp_neuron(robot, 3, 0.5f);
  scene.end_edit();
  EXPECT_EQ(scene.comparison().show_ghosts({robot}), 1u);
  test::step_and_wait(scene, 60);
  Simulation held(scene.document().configuration, std::span(&thinker, 1)),
      whole(scene.document().configuration, std::span(&thinker, 1));
  held.step(40);
  held.clamp_neuron(0, 3, 0.5f);
  held.step(60);
  // It begins in the state of the robot now, in which the neuron has that value.
  whole.step(40);
  whole.clamp_neuron(0, 3, 0.5f);
  whole.clamp_neuron(0, 3, std::nullopt);
  whole.step(60);
  const auto now = [&] {
    const auto positions = scene.snapshot().positions_of(1);
    return Positions(positions.begin(), positions.end());
  };
  EXPECT_TRUE(now() == positions_of(held));
  EXPECT_TRUE(ghost_positions(scene) == positions_of(whole));
  EXPECT_TRUE(positions_of(held) != positions_of(whole));
  // The timeline shows it again, and undo releases it.
  test::seek_and_wait(scene, scene.document().configuration.dt * 20);
  test::seek_and_wait(scene, scene.document().configuration.dt * 100);
  EXPECT_TRUE(now() == positions_of(held));
  scene.time().go_on();
  scene.undo();
  test::step_and_wait(scene, 60);
  held.clamp_neuron(0, 3, std::nullopt);
  held.step(60);
  EXPECT_TRUE(now() == positions_of(held));
  scene.parameters().clamp_neuron(robot, 1000, 1.0f);  // it does not have this one
  EXPECT_FALSE(scene.document().find(robot)->body.by_hand);
}

TEST_P(ComparisonOn, GhostOfAMutantIsItsParent) {
  test::RobotScene scene(1, options());
  const RobotId parent = test::ids_of(scene)[0];
  scene.robots().mutate({parent}, {.seed = 3});
  scene.wait_until_done();
  const RobotId child = test::ids_of(scene)[1];
  EXPECT_EQ(scene.comparison().show_ghosts({child}), 1u);
  EXPECT_TRUE(scene.comparison().ghosts()[0].of_parent);
  test::step_and_wait(scene, 90);
  const auto first = scene.snapshot().positions_of(0);
  EXPECT_TRUE(ghost_positions(scene) == Positions(first.begin(), first.end()));
  // Once the mutant is changed, its ghost is the mutant as it was made, unless the parent is asked for.
  stiffen(scene, child);
  scene.comparison().show_ghosts({child});
  EXPECT_FALSE(scene.comparison().ghosts()[0].of_parent);
  scene.comparison().show_ghosts({child}, GhostOf::parent);
  EXPECT_TRUE(scene.comparison().ghosts()[0].of_parent);
  EXPECT_EQ(scene.comparison().show_ghosts({parent}, GhostOf::parent), 0u);
}

TEST_P(ComparisonOn, TheTimelineShowsEveryMomentOfBothAgain) {
  test::RobotScene scene(2, options());
  const RobotId robot = test::ids_of(scene)[0];
  test::step_and_wait(scene, 30);
  const Positions common = positions_of(scene.snapshot());
  test::step_and_wait(scene, 10);
  scene.comparison().set_second(SideDifference("solver=xpbd"));
  scene.comparison().show_ghosts({robot});
  stiffen(scene, robot);
  struct Moment {
    double time;
    Positions first, second, ghosts;
  };
  std::vector<Moment> moments;
  const auto keep = [&] {
    moments.push_back(
        {scene.snapshot().time, positions_of(scene.snapshot()), second_positions(scene), ghost_positions(scene)});
  };
  test::step_and_wait(scene, 25);
  keep();
  Configuration configuration = scene.document().configuration;
  configuration.dt = 7e-4;
  scene.parameters().set_configuration(configuration);
  test::step_and_wait(scene, 35);
  keep();
  test::step_and_wait(scene, 5);
  scene.robots().duplicate({robot});
  test::step_and_wait(scene, 20);
  keep();
  for (const std::size_t i : {0u, 1u, 0u, 2u, 1u}) {
    test::seek_and_wait(scene, moments[i].time);
    EXPECT_TRUE(positions_of(scene.snapshot()) == moments[i].first) << i;
    EXPECT_TRUE(second_positions(scene) == moments[i].second) << i;
    EXPECT_TRUE(ghost_positions(scene) == moments[i].ghosts) << i;
  }
  // Before the comparison began, both sides were one.
  test::seek_and_wait(scene, 0.03);
  EXPECT_TRUE(positions_of(scene.snapshot()) == common);
  EXPECT_TRUE(second_positions(scene) == common);
  // Playing on from there comes to the same moments.
  test::step_and_wait(scene, 35);
  EXPECT_TRUE(second_positions(scene) == moments[0].second);
  EXPECT_TRUE(ghost_positions(scene) == moments[0].ghosts);
}

TEST_P(ComparisonOn, AComparisonThatBeginsAtAnEarlierMomentKeepsWhatCameAfter) {
  test::RobotScene scene(2, options());
  test::step_and_wait(scene, 100);
  const Positions end = positions_of(scene.snapshot());
  test::seek_and_wait(scene, 0.04);
  scene.comparison().set_second(SideDifference("damping=2"));
  scene.wait_until_done();
  EXPECT_TRUE(scene.snapshot().timeline.viewing);
  test::seek_and_wait(scene, 0.1);
  EXPECT_TRUE(positions_of(scene.snapshot()) == end);
  Simulation second = alone(scene, scene.document().configuration);
  second.step(40);
  second.configure(SideDifference("damping=2").over(scene.document().configuration));
  second.step(60);
  EXPECT_TRUE(second_positions(scene) == positions_of(second));
}

TEST(Comparison, BothSidesAreAtTheSameStepAfterEachPause) {
  test::RobotScene scene(2);
  scene.comparison().set_second(SideDifference("solver=xpbd"));
  scene.time().set_speed(unlimited_speed);
  for (int i = 0; i < 4; ++i) {
    const std::int64_t before = scene.snapshot().steps;
    scene.time().play();
    while (scene.snapshot().steps < before + 50) {
      scene.frame();
      ASSERT_TRUE(!scene.snapshot().second || scene.snapshot().second->steps == scene.snapshot().steps);
      test::nap();
    }
    scene.time().pause();
    scene.wait_until_done();
    EXPECT_EQ(scene.snapshot().second->steps, scene.snapshot().steps);
  }
}

TEST(Comparison, EditsActOnBothSides) {
  test::RobotScene scene(2);
  scene.comparison().set_second(SideDifference("damping=1"));
  const std::vector<RobotId> robots = test::ids_of(scene);
  test::step_and_wait(scene, 20);
  stiffen(scene, robots[0]);
  scene.robots().remove({robots[1]});
  Configuration configuration = scene.document().configuration;
  configuration.solver = Solver::xpbd;
  scene.parameters().set_configuration(configuration);
  scene.wait_until_done();
  const Snapshot& second = *scene.snapshot().second;
  ASSERT_EQ(second.robots->size(), 1u);
  EXPECT_EQ(second.robots->robots[0].materials, scene.document().robots[0].body.materials);
  EXPECT_EQ(second.configuration.solver, Solver::xpbd);
  EXPECT_EQ(second.configuration.damping, 1);
  scene.undo();
  test::undo_and_wait(scene);
  EXPECT_EQ(scene.snapshot().second->robots->size(), 2u);
}

TEST(Comparison, GhostsCountNowhere) {
  test::RobotScene scene(2);
  const std::vector<RobotId> robots = test::ids_of(scene);
  test::step_and_wait(scene, 30);
  const std::vector<render::Bounds> boxes(scene.drawn().camera_boxes().begin(), scene.drawn().camera_boxes().end());
  scene.comparison().show_ghosts({robots[0]});
  test::step_and_wait(scene, 1);
  EXPECT_EQ(scene.drawn().scene().ghosts.size(), 1u);
  EXPECT_EQ(scene.robots().count(), 2u);
  EXPECT_EQ(scene.robots().entries().size(), 2u);
  EXPECT_EQ(scene.measurements().ranking().size(), 2u);
  EXPECT_EQ(scene.drawn().camera_boxes().size(), boxes.size());
  EXPECT_EQ(scene.snapshot().robots->size(), 2u);
  EXPECT_EQ(scene.history().undo_name(), "make 2 robots");

  scene.comparison().hide_ghosts();
  scene.wait_until_done();
  EXPECT_FALSE(scene.snapshot().ghosts);
  EXPECT_TRUE(scene.drawn().scene().ghosts.empty());
}

// The ghost begins at the step at which its robot was made; then the robots go on without it from that step.
TEST(Comparison, AGhostGoesWithARobotThatIsForgotten) {
  test::RobotScene scene(1);
  test::step_and_wait(scene, 100);
  scene.robots().duplicate(test::ids_of(scene));
  scene.wait_until_done();
  const RobotId robot = test::ids_of(scene)[0], copy = test::ids_of(scene)[1];
  EXPECT_EQ(scene.comparison().show_ghosts({copy}), 1u);
  test::step_and_wait(scene, 50);
  ASSERT_EQ(scene.snapshot().ghosts->robots->size(), 1u);
  scene.time().seek(0.09);
  test::step_and_wait(scene, 10);
  ASSERT_EQ(scene.snapshot().robots->size(), 1u);
  scene.time().go_on();
  test::step_and_wait(scene, 50);
  EXPECT_EQ(scene.snapshot().steps, 150);
  EXPECT_EQ(scene.snapshot().ghosts->robots->size(), 0u);
  ASSERT_EQ(scene.measurements().ranking().size(), 1u);
  EXPECT_EQ(scene.measurements().ranking()[0].robot, robot);
  EXPECT_TRUE(scene.comparison().ghost_series(copy).times.empty());
}

TEST(Comparison, AGhostIsAsFarAheadInThePictureAsInTheWorld) {
  LiveSceneOptions options = test::on_cpu();
  options.view.layout = Layout::grid;
  test::RobotScene scene(1, options);
  const RobotId robot = test::ids_of(scene)[0];
  scene.comparison().show_ghosts({robot});
  stiffen(scene, robot);
  test::step_and_wait(scene, 400);
  const render::Ghost& ghost = scene.drawn().scene().ghosts[0];
  EXPECT_EQ(ghost.offset, scene.drawn().offsets()[0]);
  EXPECT_EQ(ghost.positions.size(), scene.drawn().scene().positions.size());
  const std::vector<GhostFigures> figures = scene.comparison().ghost_figures();
  ASSERT_EQ(figures.size(), 1u);
  EXPECT_TRUE(figures[0].same_age);
  EXPECT_NEAR(figures[0].age, scene.snapshot().time, 1e-9);
  EXPECT_NEAR(figures[0].robot_distance, scene.measurements().ranking()[0].distance, 1e-12);
  EXPECT_NE(figures[0].robot_distance, figures[0].ghost_distance);
}

TEST(Comparison, SeriesAreSharedUntilTheComparisonBegins) {
  test::RobotScene scene(1);
  const RobotId robot = test::ids_of(scene)[0];
  test::step_and_wait(scene, 200);
  scene.comparison().set_second(SideDifference("solver=xpbd"));
  test::step_and_wait(scene, 200);
  const Series first = scene.measurements().series(robot), second = scene.comparison().second_series(robot);
  ASSERT_EQ(first.times.size(), second.times.size());
  for (std::size_t i = 0; i < first.times.size(); ++i) {
    EXPECT_NEAR(first.times[i], second.times[i], 1e-9);
    if (first.times[i] < 0.2) {
      EXPECT_EQ(first.samples[i].distance, second.samples[i].distance);
    }
  }
  EXPECT_NE(first.samples.back().distance, second.samples.back().distance);
  EXPECT_TRUE(scene.comparison().ghost_series(robot).times.empty());
}

TEST(Comparison, TheSettingOfTheViewIsTheSecondSide) {
  LiveSceneOptions options = test::on_cpu();
  options.view = view_settings({.compare = "solver=xpbd,damping=0.5"});
  test::RobotScene scene(1, options);
  ASSERT_TRUE(scene.snapshot().second);
  EXPECT_EQ(scene.snapshot().second->configuration.solver, Solver::xpbd);
  EXPECT_THAT(scene.files().command().text, testing::HasSubstr("--compare=solver=xpbd,damping=0.5"));
  ViewSettings view = scene.view();
  view.compare.reset();
  scene.set_view(view);
  scene.wait_until_done();
  EXPECT_FALSE(scene.snapshot().second);
  EXPECT_FALSE(scene.comparison().second());
}

TEST(Comparison, ASecondSideThatWouldHoldUpTheWindowEndsWithAMessage) {
  test::RobotScene scene(1);
  scene.comparison().set_second(SideDifference("dt=1e-9"));
  test::step_and_wait(scene, 3);
  EXPECT_FALSE(scene.snapshot().second);
  EXPECT_FALSE(scene.comparison().second()) << "the key that switches it on would be needed twice";
  const std::vector<Message> messages = scene.take_messages();
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_THAT(messages[0].text, testing::HasSubstr("the second view ended: dt: 1e-09 s is less than 1/1000"));
}

TEST(Comparison, TheCommandNamesAValueThatCannotBeUsed) {
  const test::Outcome run = test::mercury({"view", "--compare", "solver=fast"});
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.messages, testing::HasSubstr("--compare: solver: \"fast\""));
}

TEST(SideDifference, NamesWhatCannotBeUsed) {
  const auto problem_of = [](const char* text) {
    const std::string message = refusal<ParameterError>([&] { SideDifference{std::string(text)}; });
    EXPECT_TRUE(message.empty() || message.starts_with("compare: ")) << message;
    return message;
  };
  EXPECT_THAT(problem_of("solver=fast"), testing::HasSubstr("force"));
  EXPECT_THAT(problem_of("xpbd"), testing::HasSubstr("solver=xpbd"));
  EXPECT_THAT(problem_of("speed=3"), testing::HasSubstr("drag_coefficient"));
  EXPECT_THAT(problem_of("dt=0"), testing::HasSubstr("> 0"));
  EXPECT_THAT(problem_of("dt=1ms"), testing::HasSubstr("not a number"));
  EXPECT_THAT(problem_of("flow=1:2"), testing::HasSubstr("three numbers"));
  EXPECT_THAT(problem_of("self_collision=1"), testing::HasSubstr("on or off"));
  EXPECT_EQ(problem_of("solver=xpbd,environment=land,friction=0.2,flow=1:0:0"), "");
}

TEST(SideDifference, ParametersCountWhereTheEnvironmentHasThem) {
  const SideDifference difference("density=500,friction=0.1");
  Configuration first;
  first.damping = 0.3;
  EXPECT_EQ(std::get<FaceDrag>(difference.over(first).environment.water).density, 500);
  EXPECT_EQ(difference.over(first).damping, 0.3);
  first.environment = Land{};
  EXPECT_EQ(std::get<Plane>(difference.over(first).environment.ground).friction, 0.1f);
  EXPECT_EQ(differences(first, difference.over(first)),
            (std::pair<std::string, std::string>("friction 0.8", "friction 0.1")));
  EXPECT_EQ(SideDifference(difference.text()), difference);
}

}  // namespace
}  // namespace mercury
