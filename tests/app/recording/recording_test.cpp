// SPDX-License-Identifier: Apache-2.0
// A recording has the simulation bit for bit, and enough to simulate it again.
#include <gmock/gmock.h>
#include <sys/stat.h>

#include <array>

#include "app/recording/trajectory_hdf5.h"
#include "app/recording/trajectory_playback.h"
#include "app/recording/trajectory_reader.h"
#include "tests/app/program.h"
#include "tests/app/recording/recording_bodies.h"
#include "tests/refusal.h"
#include "tests/same_bits.h"

namespace mercury::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<Vec3> all_positions(const Simulation& simulation) {
  std::vector<Vec3> all(simulation.mass_count());
  simulation.read_positions(all);
  return all;
}

std::vector<Vec3> all_velocities(const Simulation& simulation) {
  std::vector<Vec3> all(simulation.mass_count());
  simulation.read_velocities(all);
  return all;
}

std::vector<Robot> robots_of(const TrajectoryReader& reader) {
  std::vector<Robot> robots;
  for (const RecordedRobot& recorded : reader.robots()) robots.push_back(recorded.robot);
  return robots;
}

class Recording : public FolderTest {
 protected:
  std::string file() const { return path("a.h5"); }
};

TEST_F(Recording, FramesOfOneRobotAreItsPartOfAllFrames) {
  Simulation simulation(on_cpu(), std::vector{small_voxel_robot(0), pair("pair"), small_voxel_robot(1)});
  record(simulation, file(), 200, 2);  // two blocks of frames
  TrajectoryReader reader(file());
  const auto offsets = reader.mass_offsets();
  for (const std::size_t robot : {2u, 0u, 1u})
    for (std::size_t frame = 0; frame < reader.frames(); ++frame) {
      const std::size_t first = offsets[robot], masses = offsets[robot + 1] - first;
      ASSERT_TRUE(same_bits(reader.positions_of(robot, frame), reader.positions(frame).subspan(first, masses)));
      ASSERT_TRUE(same_bits(reader.velocities_of(robot, frame), reader.velocities(frame).subspan(first, masses)));
    }
  EXPECT_THROW(reader.positions_of(3, 0), std::out_of_range);
  EXPECT_THROW(reader.positions_of(0, reader.frames()), std::out_of_range);
}

TEST_F(Recording, FramesAreThoseOfTheSimulation) {
  const std::vector<Robot> robots{small_voxel_robot(0), small_voxel_robot(1), pair("pair")};
  Simulation simulation(on_cpu(), robots);
  record(simulation, file(), 200, 20);

  TrajectoryReader reader(file());
  Simulation again(on_cpu(), robots);
  ASSERT_EQ(reader.frames(), 11u);
  ASSERT_EQ(reader.mass_count(), again.mass_count());
  for (std::size_t frame = 0; frame < reader.frames(); ++frame) {
    EXPECT_EQ(reader.step(frame), again.steps());
    EXPECT_EQ(reader.time(frame), again.time());
    EXPECT_TRUE(same_bits(reader.positions(frame), all_positions(again))) << frame;
    EXPECT_TRUE(same_bits(reader.velocities(frame), all_velocities(again))) << frame;
    again.step(20);
  }
}

// Steps of 1/90 s and 35 frames per second: frame k is at 18 k / 7 steps.
TEST_F(Recording, FramesPerSecondAreInterpolatedBetweenSteps) {
  Configuration configuration = on_cpu();
  configuration.dt = 1.0 / 90;
  const std::vector<Robot> robots{small_voxel_robot(0), pair("pair")};
  Simulation simulation(configuration, robots);
  record(simulation, file(), 90, 1, {.rate = 35});
  TrajectoryReader reader(file());
  ASSERT_EQ(reader.frames(), 36u);
  EXPECT_EQ(reader.frame_rate(), 35);
  EXPECT_EQ(reader.every(), 3);
  Simulation again(configuration, robots);
  for (std::size_t frame = 0; frame < 36; ++frame) {
    EXPECT_DOUBLE_EQ(reader.time(frame), static_cast<double>(frame) / 35);
    const auto step = static_cast<std::int64_t>(18 * frame / 7);
    EXPECT_EQ(reader.step(frame), step);
    const auto share = static_cast<float>(18 * frame % 7) / 7;
    again.step(step - again.steps());
    const std::vector<Vec3> before = all_positions(again), slow = all_velocities(again);
    const auto expect_between = [&](std::span<const Vec3> recorded, const std::vector<Vec3>& a,
                                    const std::vector<Vec3>& b) {
      for (std::size_t i = 0; i < a.size(); ++i)
        EXPECT_NEAR(length(recorded[i] - ((1 - share) * a[i] + share * b[i])), 0, 1e-6f) << frame;
    };
    if (share == 0) {
      EXPECT_TRUE(same_bits(reader.positions(frame), before));
      continue;
    }
    again.step(1);
    expect_between(reader.positions(frame), before, all_positions(again));
    expect_between(reader.velocities(frame), slow, all_velocities(again));
  }
}

// A recording of straight motion plays as straight motion: what is shown at a step is where the masses were then.
TEST_F(Recording, PlaybackOfFramesPerSecondIsAtTheTimesOfTheFrames) {
  Robot free = pair("free");
  free.springs.clear();
  free.masses = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  free.springs = {{0, 1, 21, 1}, {1, 2, 21, std::sqrt(2.0f)}, {0, 2, 21, 1}};
  free.velocity = {{1, 0, 0}, {1, 0, 0}, {1, 0, 0}};
  Configuration configuration = on_cpu();
  configuration.dt = 0.01;
  configuration.damping = 0;
  configuration.environment = Environment{};
  Simulation simulation(configuration, std::vector{free});
  record(simulation, file(), 100, 1, {.rate = 30});
  Simulation shown = playback(std::make_shared<TrajectoryReader>(file()));
  for (int step = 0; step <= 100; ++step, shown.step(1))
    EXPECT_NEAR(shown.positions(0)[0].x, 0.01 * step, 2e-6) << step;
}

TEST(FramePlaces, AreExactAfterHours) {
  const FramePlaces ten(0, 30, 1.0 / 300), third(5, 30, 1e-3);
  EXPECT_EQ(ten.of(10'000'000).step, 100'000'000);
  EXPECT_FALSE(ten.of(10'000'000).is_between_steps());
  EXPECT_EQ(third.of(3'000'000).step, 100'000'005);
  EXPECT_FALSE(third.of(3'000'000).is_between_steps());
  EXPECT_NEAR(third.of(3'000'001).share, 1.0 / 3, 1e-6);
  EXPECT_EQ(third.count(99), 3);
  EXPECT_EQ(third.count(100), 4);
}

TEST_F(Recording, HoldsTheRobotsAsTheyWere) {
  const std::vector<Robot> robots{own_materials("own"), small_voxel_robot(3), pair("pair")};
  Simulation simulation(on_cpu(), robots);
  record(simulation, file(), 1, 1, {.seed = 0xfedcba9876543210u});
  const TrajectoryReader reader(file());
  EXPECT_EQ(robots_of(reader), robots);
  EXPECT_EQ(reader.seed(), 0xfedcba9876543210u);
  EXPECT_EQ(reader.every(), 1);
  EXPECT_EQ(reader.device_name(), simulation.device_name());
  EXPECT_THAT(reader.program(), testing::StartsWith("mercury "));
}

// Whether the table of a recorded robot has the field.
bool has_half_wave(const std::string& path, const std::string& robot) {
  const hdf5::Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT));
  const hdf5::Handle dataset(H5Dopen2(file, ("/particles/" + robot + "/materials").c_str(), H5P_DEFAULT));
  const hdf5::Handle type(H5Dget_type(dataset));
  return H5Tget_member_index(type, "half_wave") >= 0;
}

TEST_F(Recording, HalfWavesComeBackAndAreWrittenOnlyWhereThereAreAny) {
  Robot whole = own_materials("whole"), half = own_materials("half");
  whole.materials[1].half_wave = false;
  const std::vector<Robot> robots{whole, half, pair("defaults")};
  Simulation simulation(on_cpu(), robots);
  record(simulation, file(), 400, 400);  // sin(3 t + 0.5) is below 0 at its end
  TrajectoryReader reader(file());
  EXPECT_EQ(robots_of(reader), robots);
  EXPECT_FALSE(same_bits(simulation.positions(0), simulation.positions(1)));
  Simulation again(reader.configuration(), robots_of(reader));
  again.step(400);
  EXPECT_TRUE(same_bits(reader.positions(1), all_positions(again)));
  EXPECT_TRUE(has_half_wave(file(), "half"));
  EXPECT_FALSE(has_half_wave(file(), "whole"));
  EXPECT_FALSE(has_half_wave(file(), "defaults"));
}

TEST_F(Recording, MassesVelocitiesAndFixedPointsComeBack) {
  Robot ones = pair("explicitly 1 kg"), slow = own_materials("slow");
  ones.mass = {1, 1};
  slow.materials[2].relaxation_time = 0.5f;
  slow.materials[1].half_wave = false;
  const std::vector<Robot> robots{own_points("own"), pair("pair"), ones, slow};
  Simulation simulation(on_cpu(), robots);
  record(simulation, file(), 100, 100);
  TrajectoryReader reader(file());
  EXPECT_EQ(robots_of(reader), robots);
  EXPECT_EQ(reader.velocities(0)[1], robots[0].velocity[1]);
  Simulation again(reader.configuration(), robots_of(reader));
  again.step(100);
  EXPECT_TRUE(same_bits(reader.positions(1), all_positions(again)));
  EXPECT_EQ(reader.positions(1)[2], robots[0].masses[2]) << "fixed";
}

TEST_F(Recording, ActuatorsComeBackInTheirOrder) {
  Robot robot = pair("many");
  robot.actuators = {{"längs", {9, 3}}, {"b", {1}}, {"a", {200, 7, 8}}};
  Simulation simulation(on_cpu(), std::vector{robot, pair("none")});
  record(simulation, file(), 1, 1);
  EXPECT_EQ(robots_of(TrajectoryReader(file())), (std::vector{robot, pair("none")}));
}

class RecordedConfiguration : public Recording, public testing::WithParamInterface<Environment> {};

TEST_P(RecordedConfiguration, IsReadBackWhole) {
  Configuration configuration{.dt = 1.25e-3, .damping = 0.3, .solver = Solver::xpbd, .environment = GetParam()};
  configuration.device = {.kind = DeviceKind::cpu, .threads = 2};
  Simulation simulation(configuration, std::vector{pair("pair")});
  record(simulation, file(), 1, 1);
  EXPECT_EQ(TrajectoryReader(file()).configuration(), configuration);
}

// No value is a default, so that a value that is not read makes the test fail.
INSTANTIATE_TEST_SUITE_P(
    EveryEnvironment, RecordedConfiguration,
    testing::Values(Environment(Ocean{998.2f, 1.1f, 0.3f, 0.4f, {0.1f, 0.2f, 0.3f}, {0.4f, 0.5f, -0.6f}, 1.7f}),
                    Environment(OceanSimple{0.7f, {0.1f, 0.2f, 0.3f}, {0.4f, 0.5f, -0.6f}, 1.7f}),
                    Environment(Land{{0.1f, 0, -1.62f}, 0.55f, false, 123, 150}),
                    Environment{.water = FaceDrag{998.2f, 1.1f, 0.3f, 0.4f, {0.1f, 0.2f, 0.3f}},
                                .ground = Plane{0.55f},
                                .contacts = Contacts{false, 123},
                                .gravity = {0.4f, 0.5f, -0.6f},
                                .stiffness_scale = 1.7f},
                    Environment{.water = PointDrag{0.7f, {0.1f, 0.2f, 0.3f}}, .ground = Plane{0.55f}},
                    Environment(Water{
                        {998.2f, 1.1f, 0.03f, 0.4f, {0.1f, 0.2f, 0.3f}}, {0.4f, 0.5f, -0.6f}, {true, 123, 0.7f, 0.9f}}),
                    Environment{.water = ResistiveDrag{998.2f, 1.1f, 0.03f, 0.4f, {0.1f, 0.2f, 0.3f}},
                                .ground = Plane{0.55f}}));

TEST_F(Recording, SimulatesAgainFromTheFileAlone) {
  Configuration configuration = on_cpu();
  configuration.environment = Land{};
  const std::vector<Robot> robots{small_voxel_robot(4), own_materials("own")};
  Simulation simulation(configuration, robots);
  record(simulation, file(), 300, 300);

  TrajectoryReader reader(file());
  Simulation again(reader.configuration(), robots_of(reader));
  EXPECT_TRUE(same_bits(reader.positions(0), all_positions(again)));  // set down on the ground
  again.step(reader.step(1));
  EXPECT_TRUE(same_bits(reader.positions(1), all_positions(again)));
}

TEST_F(Recording, MaterialsAreThoseOfTheSimulation) {
  Simulation simulation(on_cpu(), std::vector{pair("pair"), pair("other")});
  simulation.set_material(0, 1, {80, 0.1f, 2, 1});
  record(simulation, file(), 50, 50);
  TrajectoryReader reader(file());
  Simulation again(reader.configuration(), robots_of(reader));
  again.step(50);
  EXPECT_EQ(again.material(0, 1), (Material{80, 0.1f, 2, 1}));
  EXPECT_EQ(reader.robots()[1].robot, pair("other"));
  EXPECT_TRUE(same_bits(reader.positions(1), all_positions(again)));
}

TEST_F(Recording, ReadsFramesInAnyOrderWhenMemoryHoldsOnlyAFew) {
  Simulation simulation(on_cpu(), std::vector{pair("a"), small_voxel_robot(0)});
  std::vector<std::vector<Vec3>> expected;
  {
    Recorder recorder(simulation, file(), {.every = 1});  // its end not known
    expected.push_back(all_positions(simulation));
    for (int step = 0; step < 150; ++step) {
      simulation.step();
      recorder.observe();
      expected.push_back(all_positions(simulation));
    }
    recorder.finish();
  }
  TrajectoryReader reader(file());
  ASSERT_EQ(reader.frames(), 151u);
  for (const std::size_t frame : {150u, 0u, 63u, 64u, 65u, 127u, 128u, 1u})
    EXPECT_TRUE(same_bits(reader.positions(frame), expected[frame])) << frame;
  EXPECT_THROW(reader.positions(151), std::out_of_range);
}

TEST_F(Recording, CompressionLosesNothing) {
  for (const int deflate : {0, 1}) {
    Simulation simulation(on_cpu(), std::vector{small_voxel_robot(0)});
    record(simulation, path("deflate" + std::to_string(deflate) + ".h5"), 100, 10, {.deflate = deflate});
  }
  TrajectoryReader plain(path("deflate0.h5")), packed(path("deflate1.h5"));
  for (std::size_t frame = 0; frame < plain.frames(); ++frame)
    EXPECT_TRUE(same_bits(plain.velocities(frame), packed.velocities(frame)));
  EXPECT_LT(std::filesystem::file_size(path("deflate1.h5")), std::filesystem::file_size(path("deflate0.h5")));
}

TEST_F(Recording, FrameAtATimeIsTheLastOneBefore) {
  Simulation simulation(on_cpu(), std::vector{pair("pair")});
  record(simulation, file(), 30, 10);
  const TrajectoryReader reader(file());
  EXPECT_EQ(reader.frame_at(-1), 0u);
  EXPECT_EQ(reader.frame_at(0.0199), 1u);
  EXPECT_EQ(reader.frame_at(reader.time(2)), 2u);
  EXPECT_EQ(reader.frame_at(1e9), 3u);
}

TEST_F(Recording, MarksExplodedRobotsAndKeepsNonFiniteValues) {
  Configuration configuration = on_cpu();
  configuration.dt = 1;  // omega = sqrt(2 k / m) = 10 rad/s is unstable beyond 0.2 s
  Robot steady = pair("steady");
  steady.springs[0].material = 2;
  steady.materials = {{}, {}, {0.1f, 0, 0, 0}};
  Simulation simulation(configuration, std::vector{pair("wild"), steady});
  record(simulation, file(), 40, 1);
  const Telemetry wild = simulation.telemetry(0);
  ASSERT_TRUE(wild.exploded);

  TrajectoryReader reader(file());
  EXPECT_EQ(reader.robots()[0].exploded_at, wild.exploded_at);
  EXPECT_EQ(reader.robots()[0].culprit_spring, wild.culprit_spring);
  EXPECT_EQ(reader.robots()[1].exploded_at, std::nullopt);
  EXPECT_TRUE(same_bits(reader.positions(40), all_positions(simulation)));
}

TEST_F(Recording, RobotsOfAnyNameHaveGroupsOfTheirOwn) {
  const std::vector<std::string> names{"eel",
                                       "eel",
                                       "eel-2",
                                       "a/b",
                                       "",
                                       ".",
                                       "..",
                                       "tab\there",
                                       "\xff\xfe",
                                       "Größe \xe2\x82\xac",
                                       std::string(100'000, 'x'),
                                       std::string("nul\0inside", 10)};
  std::vector<Robot> robots;
  for (const std::string& name : names) robots.push_back(pair(name));
  Simulation simulation(on_cpu(), robots);
  record(simulation, file(), 1, 1);
  const TrajectoryReader reader(file());
  EXPECT_EQ(robots_of(reader), robots);  // in their order, by their own names
  std::vector<std::string> groups;
  for (const RecordedRobot& recorded : reader.robots()) groups.push_back(recorded.group);
  EXPECT_THAT(groups, ElementsAre("eel", "eel-3", "eel-2", "a_b", "robot", "robot-2", "robot-3", "tab_here", "__",
                                  "Größe \xe2\x82\xac", std::string(200, 'x'), "nul_inside"));
}

TEST_F(Recording, HundredsOfRobots) {
  std::vector<Robot> robots(500, pair("pair"));
  Simulation simulation(on_cpu(), robots);
  record(simulation, file(), 4, 2);
  TrajectoryReader reader(file());
  EXPECT_EQ(reader.robots().size(), 500u);
  EXPECT_EQ(reader.robots()[499].group, "pair-500");
  EXPECT_TRUE(same_bits(reader.positions(2), all_positions(simulation)));
  // Thousands of robots take seconds; whoever waits sees how far it is, and can stop it.
  struct Stopped {};
  std::size_t calls = 0;
  const auto watch = [&](const char*, std::size_t done, std::size_t total) {
    EXPECT_EQ(done, ++calls);
    EXPECT_EQ(total, 500u);
    if (done == 100) throw Stopped();
  };
  EXPECT_THROW(TrajectoryReader(file(), watch), Stopped);
  EXPECT_EQ(calls, 100u);
}

TEST_F(Recording, ExistsOnlyOnceComplete) {
  write("a.h5", "as it was");
  Simulation simulation(on_cpu(), std::vector{pair("pair")});
  {
    Recorder recorder(simulation, file(), {.every = 1});
    simulation.step();
    recorder.observe();
    EXPECT_EQ(listing().size(), 2u);
  }
  EXPECT_THAT(listing(), ElementsAre("a.h5"));
  EXPECT_EQ(read("a.h5"), "as it was");
  record(simulation, file(), 2, 1);
  EXPECT_THAT(listing(), ElementsAre("a.h5"));
  EXPECT_EQ(TrajectoryReader(file()).frames(), 2u);
}

TEST_F(Recording, PlaybackRepeatsTheSimulation) {
  Configuration configuration = on_cpu();
  configuration.environment = Land{};
  const std::vector<Robot> robots{small_voxel_robot(1), own_materials("own")};
  Simulation simulation(configuration, robots);
  record(simulation, file(), 100, 20);

  Simulation again(configuration, robots), played = playback(std::make_shared<TrajectoryReader>(file()));
  ASSERT_EQ(played.size(), again.size());
  for (int frame = 0; frame <= 5; ++frame) {
    EXPECT_EQ(played.time(), again.time());
    EXPECT_TRUE(same_bits(all_positions(played), all_positions(again))) << frame;
    EXPECT_EQ(played.hash(0), again.hash(0));
    EXPECT_EQ(played.telemetry(1).elastic_energy, again.telemetry(1).elastic_energy);
    again.step(20);
    played.step(7);
    played.step(13);
  }
  played.step(1000);  // after the end nothing moves
  EXPECT_TRUE(same_bits(all_positions(played), all_positions(simulation)));
  played.reset();
  EXPECT_TRUE(same_bits(all_positions(played), all_positions(Simulation(configuration, robots))));
}

TEST_F(Recording, PlaybackHasTheRobotsOfTheRecording) {
  Simulation simulation(on_cpu(), std::vector{pair("pair"), pair("other")});
  record(simulation, file(), 10, 10);
  Simulation played = playback(std::make_shared<TrajectoryReader>(file()));
  EXPECT_THROW(played.add(pair("third")), std::logic_error);
  EXPECT_THROW(played.keep(std::array<std::size_t, 1>{1}), std::logic_error);
}

TEST_F(Recording, PlaybackInterpolatesBetweenFrames) {
  Simulation simulation(on_cpu(), std::vector{pair("pair")});
  record(simulation, file(), 100, 100);
  Simulation played = playback(std::make_shared<TrajectoryReader>(file()));
  const std::vector<Vec3> first = all_positions(played), last = all_positions(simulation);
  ASSERT_NE(first, last);
  played.step(25);
  const std::vector<Vec3> between = all_positions(played);
  for (std::size_t i = 0; i < between.size(); ++i)
    EXPECT_NEAR(between[i].x, 0.75f * first[i].x + 0.25f * last[i].x, 1e-7f);
}

// At a moment between two steps, the line between two frames holds as well; at the moment of a frame it is that frame.
TEST_F(Recording, PlaybackCanBeBetweenSteps) {
  const double dt = on_cpu().dt;
  for (const bool at_rate : {false, true}) {
    Simulation simulation(on_cpu(), std::vector{small_voxel_robot(1)});
    record(simulation, file(), 100, at_rate ? 1 : 50, {.rate = at_rate ? std::optional(30.0) : std::nullopt});
    auto reader = std::make_shared<TrajectoryReader>(file());
    const auto share = std::make_shared<float>();
    Simulation played = playback(std::make_shared<TrajectoryReader>(file()), share);
    for (int frame = 0; frame < 3; ++frame) {
      const FramePlace place = place_after(0, at_rate ? frame / 30.0 / dt : 50.0 * frame);
      played.step(place.step - played.steps());
      *share = place.share;
      const auto recorded = reader->positions(static_cast<std::size_t>(frame));
      const std::vector<Vec3> expected(recorded.begin(), recorded.end()), shown = all_positions(played);
      for (std::size_t i = 0; i < shown.size(); ++i) EXPECT_LT(length(shown[i] - expected[i]), 1e-6f) << frame;
    }
    played.reset();
    played.step(10);
    *share = 0.5f;
    const auto first = reader->positions(0);
    const std::vector<Vec3> from(first.begin(), first.end());
    const auto second = reader->positions(1);
    const std::vector<Vec3> to(second.begin(), second.end()), shown = all_positions(played);
    const float way = 10.5f / (at_rate ? static_cast<float>(1 / (30 * dt)) : 50.0f);
    for (std::size_t i = 0; i < shown.size(); ++i)
      EXPECT_LT(length(shown[i] - (from[i] + way * (to[i] - from[i]))), 1e-6f);
  }
}

TEST_F(Recording, PlaybackMarksARobotWhenItExploded) {
  Configuration configuration = on_cpu();
  configuration.dt = 1;
  Simulation simulation(configuration, std::vector{pair("wild")});
  record(simulation, file(), 60, 1);
  const Telemetry end = simulation.telemetry(0);
  ASSERT_TRUE(end.exploded);
  Simulation played = playback(std::make_shared<TrajectoryReader>(file()));
  while (played.time() < end.exploded_at) {
    EXPECT_FALSE(played.telemetry(0).exploded) << played.time();
    played.step();
  }
  EXPECT_TRUE(played.telemetry(0).exploded);
  EXPECT_EQ(played.telemetry(0).exploded_at, end.exploded_at);
  EXPECT_EQ(played.telemetry(0).culprit_spring, end.culprit_spring);
}

std::string refusal(const std::string& path) {
  return mercury::refusal([&] { TrajectoryReader reader(path); });
}

TEST_F(Recording, OtherFilesAreRefused) {
  EXPECT_EQ(refusal(path("none.h5")), path("none.h5") + ": No such file or directory");
  EXPECT_EQ(refusal(folder_.string()), folder_.string() + ": is a folder, not a trajectory");
  ASSERT_EQ(mkfifo(path("fifo.h5").c_str(), 0600), 0);
  EXPECT_EQ(refusal(path("fifo.h5")), path("fifo.h5") + ": is not a regular file, as a trajectory must be");
  write("text.h5", "not HDF5 at all");
  EXPECT_EQ(refusal(path("text.h5")), path("text.h5") + ": is not an HDF5 file");
  write("empty.h5", "");
  EXPECT_EQ(refusal(path("empty.h5")), path("empty.h5") + ": is not an HDF5 file");
  hdf5::prepare();
  { const hdf5::Handle other(H5Fcreate(path("other.h5").c_str(), H5F_ACC_EXCL, H5P_DEFAULT, H5P_DEFAULT)); }
  EXPECT_EQ(refusal(path("other.h5")), path("other.h5") + ": is not a trajectory that mercury recorded");
}

}  // namespace
}  // namespace mercury::test
