// SPDX-License-Identifier: Apache-2.0
// Recorded senses and neurons are those of the simulation at the same frames, on every backend.
#include <gmock/gmock.h>

#include <cmath>

#include "app/recording/trajectory_hdf5.h"
#include "app/recording/trajectory_reader.h"
#include "mercury/error.h"
#include "mercury/robot_file.h"
#include "tests/app/program.h"
#include "tests/app/recording/recording_bodies.h"
#include "tests/refusal.h"
#include "tests/same_bits.h"
#include "tests/sim/backend.h"

namespace mercury::test {
namespace {

constexpr std::size_t senses = 4, neurons = 3;  // of thinking_pair()
constexpr std::int64_t thought_steps = 4;

// Each test has a folder, and one simulation per backend whose robots sink.
class RecordedBrainsOn : public FolderTest, public testing::WithParamInterface<DeviceKind> {
 protected:
  void SetUp() override { BackendTest::skip_without(GetParam()); }

  Simulation simulation() const {
    const std::vector robots{thinking_pair("a"), pair("no brain"), thinking_pair("b")};
    return Simulation({.environment = OceanSimple{.flow = {0, 0, -1}}, .device = {.kind = GetParam()}}, robots);
  }
  std::string file() const { return path("a.h5"); }
};

INSTANTIATE_TEST_SUITE_P(All, RecordedBrainsOn, every_device, BackendTest::name);

std::vector<float> of_all(const Simulation& simulation, std::vector<float> BrainState::*numbers, std::size_t count) {
  std::vector<float> all;
  for (const BrainState& state : simulation.brain_states())
    if (!(state.*numbers).empty())
      all.insert(all.end(), (state.*numbers).begin(), (state.*numbers).begin() + static_cast<std::ptrdiff_t>(count));
  return all;
}

TEST_P(RecordedBrainsOn, AreThoseOfTheSimulation) {
  Simulation recorded = simulation(), again = simulation();
  recorded.clamp_neuron(2, 1, 0.5f);
  again.clamp_neuron(2, 1, 0.5f);
  record(recorded, file(), 700, 7, {.brains = true});  // several blocks

  TrajectoryReader reader(file());
  ASSERT_EQ(reader.frames(), 101u);
  EXPECT_TRUE(reader.has_brains() && reader.has_brains(0) && !reader.has_brains(1) && reader.has_brains(2));
  for (std::size_t frame = 0; frame < reader.frames(); ++frame) {
    EXPECT_TRUE(same_bits(reader.senses(frame), of_all(again, &BrainState::senses, senses))) << frame;
    EXPECT_TRUE(same_bits(reader.neurons(frame), of_all(again, &BrainState::neurons, neurons))) << frame;
    again.step(7);
  }
  for (const std::size_t robot : {2u, 0u})
    for (std::size_t frame = 0; frame < reader.frames(); ++frame) {
      const std::size_t place = robot == 0 ? 0 : 1;
      EXPECT_TRUE(same_bits(reader.senses_of(robot, frame), reader.senses(frame).subspan(place * senses, senses)));
      EXPECT_TRUE(same_bits(reader.neurons_of(robot, frame), reader.neurons(frame).subspan(place * neurons, neurons)));
    }
  EXPECT_TRUE(reader.senses_of(1, 5).empty() && reader.neurons_of(1, 5).empty());
  EXPECT_EQ(reader.neurons_of(2, 5)[1], 0.5f);
  EXPECT_THROW(reader.senses_of(3, 0), std::out_of_range);
  EXPECT_THROW(reader.neurons(101), std::out_of_range);
}

// A frame at step n has what was felt before the last step that the brain thought before.
TEST_P(RecordedBrainsOn, AreWhatTheClockAndTheDepthWereAtTheLastThought) {
  Simulation recorded = simulation();
  record(recorded, file(), 300, 1, {.brains = true});
  TrajectoryReader reader(file());
  EXPECT_THAT(reader.senses_of(0, 0), testing::Each(0.0f)) << "before the first thought";
  for (std::size_t frame = 1; frame < reader.frames(); ++frame) {
    const std::size_t thought = (frame - 1) / thought_steps * thought_steps;
    const double angle = 30 * 0.001 * static_cast<double>(thought) + static_cast<double>(0.3f);
    const auto felt = reader.senses_of(0, frame);
    EXPECT_NEAR(felt[0], std::sin(angle), 1e-6);
    EXPECT_NEAR(felt[1], std::cos(angle), 1e-6);
    const auto positions = reader.positions_of(0, thought);
    EXPECT_NEAR(felt[2], -(positions[0].z + positions[1].z) / 2, 1e-6);
  }
  EXPECT_GT(reader.senses_of(0, 300)[2], 0.03f) << "it sinks";
}

TEST_P(RecordedBrainsOn, OfAFrameBetweenTwoStepsAreThoseOfTheLaterOne) {
  Simulation recorded = simulation(), again = simulation();
  record(recorded, file(), 200, 1, {.rate = 300, .brains = true});
  TrajectoryReader reader(file());
  ASSERT_EQ(reader.frames(), 61u);
  const FramePlaces places = reader.places();
  for (std::size_t frame = 0; frame < reader.frames(); ++frame) {
    const FramePlace place = places.of(static_cast<std::int64_t>(frame));
    again.step(place.step + (place.is_between_steps() ? 1 : 0) - again.steps());
    EXPECT_TRUE(same_bits(reader.senses(frame), of_all(again, &BrainState::senses, senses))) << frame;
    EXPECT_TRUE(same_bits(reader.neurons(frame), of_all(again, &BrainState::neurons, neurons))) << frame;
  }
}

// These brains neither learn nor delay nor add noise, so a frame has all of their state.
TEST_P(RecordedBrainsOn, AreEnoughToGoOnFromAnyFrame) {
  Simulation recorded = simulation();
  record(recorded, file(), 300, 50, {.brains = true});
  TrajectoryReader reader(file());
  Simulation again = simulation();
  again.restore(reader.state(3));
  again.step(150);
  for (std::size_t robot = 0; robot < 3; ++robot) EXPECT_EQ(again.hash(robot), recorded.hash(robot)) << robot;
  EXPECT_EQ(again.brain_state(0).neurons, recorded.brain_state(0).neurons);
}

class RecordedBrains : public FolderTest {};

TEST_F(RecordedBrains, AreThereOnRequestOnly) {
  Simulation simulation(on_cpu(), std::vector{thinking_pair("a")});
  record(simulation, path("a.h5"), 20, 10);
  TrajectoryReader reader(path("a.h5"));
  EXPECT_FALSE(reader.has_brains());
  EXPECT_TRUE(reader.senses(1).empty() && reader.neurons_of(0, 1).empty());
  EXPECT_TRUE(reader.state(1).brains.empty());

  Simulation without(on_cpu(), std::vector{pair("a")});
  EXPECT_EQ(refusal<ParameterError>([&] { record(without, path("b.h5"), 20, 10, {.brains = true}); }),
            "brains: none of the robots has a brain");
  EXPECT_THAT(listing(), testing::ElementsAre("a.h5"));
}

TEST_F(RecordedBrains, CompressionLosesNothing) {
  Simulation plain(on_cpu(), std::vector{thinking_pair("a")}), small(on_cpu(), std::vector{thinking_pair("a")});
  record(plain, path("a.h5"), 500, 5, {.brains = true});
  record(small, path("b.h5"), 500, 5, {.brains = true, .deflate = 1});
  TrajectoryReader a(path("a.h5")), b(path("b.h5"));
  for (std::size_t frame = 0; frame < a.frames(); ++frame) {
    EXPECT_TRUE(same_bits(a.senses(frame), b.senses(frame)));
    EXPECT_TRUE(same_bits(a.neurons(frame), b.neurons(frame)));
  }
}

// The program, from the recording to its checks.
class RunBrains : public FolderTest {
 protected:
  RunBrains() {
    Robot thinker = thinking_pair("thinker");
    save_robot(path("thinker.json"), thinker);
    save_robot(path("pair.json"), pair("pair"));
  }
  Outcome run(const Arguments& more) const {
    return mercury(joined({"run", path("thinker.json"), path("pair.json"), "--seconds", "0.5", "--device", "cpu",
                           "--quiet", "--record", path("a.h5"), "--threads", "1", "--force"},
                          more));
  }
};

TEST_F(RunBrains, AreRecordedDescribedAndVerified) {
  for (const std::vector<std::string>& rhythm : {std::vector<std::string>{"--every", "7"}, {"--fps", "130"}}) {
    succeeded(run({"--brains", rhythm[0], rhythm[1]}));
    const Outcome same = mercury({"verify", path("a.h5"), "--quiet"});
    EXPECT_EQ(same.status, 0) << same.output << same.messages;
    EXPECT_THAT(same.output,
                testing::HasSubstr("same: positions, velocities, senses and neurons are identical, bit for bit"));
  }
  EXPECT_THAT(mercury({"info", path("a.h5")}).output, testing::HasSubstr("4 senses and 3 neurons recorded"));
  const auto info = nlohmann::json::parse(mercury({"info", path("a.h5"), "--json"}).output)["recordings"][0]["robots"];
  EXPECT_THAT(info[0]["senses"], testing::ElementsAre("clock sine", "clock cosine", "depth", "strain muscle"));
  EXPECT_THAT(info[0]["neurons"], testing::ElementsAre("hidden 0", "hidden 1", "motor 0"));
  EXPECT_TRUE(info[1]["senses"].empty() && info[1]["neurons"].empty());
}

TEST_F(RunBrains, AChangedSenseIsADifference) {
  succeeded(run({"--brains"}));
  {
    hdf5::prepare();
    const hdf5::Handle file(H5Fopen(path("a.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT)),
        dataset(H5Dopen2(file, "/observables/thinker/senses/value", H5P_DEFAULT)), stored(H5Dget_space(dataset));
    const hsize_t at[] = {8, 2}, one[] = {1, 1};
    hdf5::checked(H5Sselect_hyperslab(stored, H5S_SELECT_SET, at, nullptr, one, nullptr));
    const hdf5::Handle held = hdf5::space_of({1, 1});
    const float depth = 0.25f;  // it is 0: nothing moves the robot
    hdf5::checked(H5Dwrite(dataset, H5T_NATIVE_FLOAT, held, stored, H5P_DEFAULT, &depth));
  }
  const Outcome different = mercury({"verify", path("a.h5"), "--quiet", "--json"});
  EXPECT_EQ(different.status, 1);
  const auto report = nlohmann::json::parse(different.output);
  EXPECT_EQ(report["first_difference"]["brain"], 0.25);
  EXPECT_EQ(report["first_difference"]["position"], 0.0);
  EXPECT_EQ(report["frames"][8]["identical"], false);
  EXPECT_EQ(report["frames"][9]["identical"], true);
  EXPECT_THAT(mercury({"verify", path("a.h5"), "--quiet"}).output, testing::HasSubstr("brain"));
}

TEST_F(RunBrains, OptionsThatCannotBeAreRefused) {
  const auto refused = [](const Outcome& outcome) {
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(std::ranges::count(outcome.messages, '\n'), 1) << outcome.messages;
    return outcome.messages;
  };
  EXPECT_THAT(refused(mercury({"run", path("thinker.json"), "--brains"})),
              testing::HasSubstr("--brains: goes with --record FILE.h5"));
  EXPECT_THAT(refused(mercury({"run", path("pair.json"), "--brains", "--record", path("b.h5")})),
              testing::HasSubstr("--brains: none of the robots has a brain"));
}

}  // namespace
}  // namespace mercury::test
