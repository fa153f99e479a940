// SPDX-License-Identifier: Apache-2.0
// mercury run --checkpoint and --resume: a run that was killed ends as if it had not been; mercury verify.
#include <gmock/gmock.h>
#include <hdf5.h>
#include <sys/stat.h>

#include <csignal>

#include "app/recording/trajectory_reader.h"
#include "tests/app/program.h"
#include "tests/nap.h"

namespace mercury::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

json robots_of(const Outcome& outcome) {
  EXPECT_EQ(outcome.status, 0) << outcome.messages;
  return json::parse(outcome.output, nullptr, false)["robots"];
}

class Checkpoint : public FolderTest {
 protected:
  const Arguments run_{"run",     "--random",  "voxel:3", "--seed",        "4",   "--seconds",
                       "1.23",    "--settle",  "0.1",     "--device",      "cpu", "--json",
                       "--quiet", "--threads", "1",       "--environment", "land"};
  // The same run, killed as soon as it has saved a checkpoint.
  void kill(const Arguments& more) {
    ChildProcess child(MERCURY_PROGRAM, joined(run_, {"--checkpoint", path("c.h5"), "--checkpoint-every", "0"}, more));
    while (!std::filesystem::exists(path("c.h5")) && child.running()) nap();
    child.kill();
  }
  const Arguments resume_{"run", "--resume", "--checkpoint", path("c.h5"), "--json", "--quiet"};
  Outcome refused(const Arguments& arguments) {
    const Outcome outcome = mercury(arguments);
    EXPECT_EQ(outcome.status, 2) << outcome.messages;
    EXPECT_EQ(std::ranges::count(outcome.messages, '\n'), 1) << outcome.messages;
    return outcome;
  }
  // Expects two recordings to hold the same.
  void expect_same(const std::string& a, const std::string& b) {
    TrajectoryReader first(a), second(b);
    ASSERT_EQ(first.frames(), second.frames());
    ASSERT_EQ(first.robots().size(), second.robots().size());
    EXPECT_EQ(first.every(), second.every());
    EXPECT_EQ(first.configuration(), second.configuration());
    for (std::size_t i = 0; i < first.robots().size(); ++i)
      EXPECT_EQ(first.robots()[i].robot, second.robots()[i].robot);
    for (std::size_t i = 0; i < first.frames(); ++i) {
      EXPECT_EQ(first.step(i), second.step(i));
      EXPECT_EQ(first.time(i), second.time(i));
      EXPECT_TRUE(std::ranges::equal(first.positions(i), second.positions(i))) << "frame " << i;
      EXPECT_TRUE(std::ranges::equal(first.velocities(i), second.velocities(i))) << "frame " << i;
      EXPECT_TRUE(std::ranges::equal(first.senses(i), second.senses(i))) << "frame " << i;
      EXPECT_TRUE(std::ranges::equal(first.neurons(i), second.neurons(i))) << "frame " << i;
    }
  }
};

TEST_F(Checkpoint, ARunThatWasKilledEndsAsOneThatWasNot) {
  const json whole = robots_of(mercury(run_));
  kill({});
  EXPECT_EQ(robots_of(mercury(resume_)), whole);
}

TEST_F(Checkpoint, ItChangesNoResultAndTheLastOneHoldsTheEnd) {
  const json whole = robots_of(mercury(run_));
  EXPECT_EQ(robots_of(mercury(joined(run_, {"--checkpoint", path("c.h5"), "--checkpoint-every", "0"}))), whole);
  EXPECT_EQ(robots_of(mercury(resume_)), whole);
  EXPECT_EQ(TrajectoryReader(path("c.h5")).step(0), 1230);
  EXPECT_THAT(listing(), SizeIs(1));
}

// The start around a target and the push are those of the run that was killed; how near it came is kept.
TEST_F(Checkpoint, ATargetAndAPushArePartOfTheRun) {
  const Arguments more{"--target-radius", "0.3",         "--target-spread", "0.9", "--turned", "--reach", "0.1",
                       "--push",          "0.3,0.1,0.2", "--push-at",       "0.6", "--upright"};
  const json whole = robots_of(mercury(joined(run_, more)));
  EXPECT_NE(whole, robots_of(mercury(run_)));
  for (const json& robot : whole) EXPECT_TRUE(robot["reached"] == 0 || robot["reached"] == 1) << robot["reached"];
  kill(more);
  EXPECT_EQ(robots_of(mercury(resume_)), whole);
  succeeded(mercury(joined(run_, more, {"--record", path("r.h5")})));
  EXPECT_EQ(mercury({"verify", path("r.h5"), "--quiet"}).status, 0);
}

TEST_F(Checkpoint, ItCanGoOnForLonger) {
  Arguments longer = run_;
  *(std::ranges::find(longer, "1.23")) = "1.5";
  const json whole = robots_of(mercury(longer));
  succeeded(mercury(joined(run_, {"--checkpoint", path("c.h5")})));
  EXPECT_EQ(robots_of(mercury(joined(resume_, {"--seconds", "1.5"}))), whole);
}

// Its throughput is that of the steps that it made itself, not of those before the checkpoint.
TEST_F(Checkpoint, ThroughputIsOfTheStepsOfThisSession) {
  const auto steps_of = [&](const Arguments& arguments) {
    const Outcome outcome = succeeded(mercury(arguments));
    const json report = json::parse(outcome.output, nullptr, false);
    double springs = 0;
    for (const auto& robot : report["robots"]) springs += robot["springs"].get<double>();
    return report["springs_per_second"].get<double>() * report["wall_seconds"].get<double>() / springs;
  };
  EXPECT_NEAR(steps_of(joined(run_, {"--checkpoint", path("c.h5")})), 1230, 0.01);
  EXPECT_NEAR(steps_of(joined(resume_, {"--seconds", "1.5"})), 270, 0.01);
}

TEST_F(Checkpoint, ASignalSavesTheLastStepAndTheRunGoesOnFromThere) {
  const json whole = robots_of(mercury(run_));
  for (const int signal : {SIGINT, SIGTERM}) {
    std::filesystem::remove(path("c.h5"));
    ChildProcess child(MERCURY_PROGRAM, joined(run_, {"--checkpoint", path("c.h5"), "--checkpoint-every", "0"}));
    while (!std::filesystem::exists(path("c.h5")) && child.running()) nap();
    child.signal(signal);
    const Outcome outcome = outcome_of(child);
    ASSERT_EQ(outcome.status, 128 + signal) << outcome.messages;
    EXPECT_THAT(outcome.messages, Not(HasSubstr("no checkpoint")));
    EXPECT_EQ(TrajectoryReader(path("c.h5")).step(0), json::parse(outcome.output)["steps"]);
    EXPECT_EQ(robots_of(mercury(resume_)), whole);
  }
}

TEST_F(Checkpoint, ARunThatWasStoppedTwiceGoesOn) {
  const json whole = robots_of(mercury(run_));
  kill({});
  ChildProcess child(MERCURY_PROGRAM, joined(resume_, {"--checkpoint", path("c.h5"), "--checkpoint-every", "0"}));
  const auto first = std::filesystem::last_write_time(path("c.h5"));
  while (std::filesystem::last_write_time(path("c.h5")) == first && child.running()) nap();
  child.kill();
  EXPECT_EQ(robots_of(mercury(resume_)), whole);
}

TEST_F(Checkpoint, ARecordingIsContinued) {
  const Arguments record{"--record", path("a.h5"), "--every", "7"};
  robots_of(mercury(joined(run_, {"--record", path("whole.h5"), "--every", "7"})));
  kill(record);
  robots_of(mercury(joined(resume_, {"--record", path("a.h5")})));
  expect_same(path("a.h5"), path("whole.h5"));
}

TEST_F(Checkpoint, ARecordingBetweenStepsIsContinued) {
  const Arguments rate{"--fps", "700"};  // most frames are between steps
  robots_of(mercury(joined(run_, {"--record", path("whole.h5")}, rate)));
  kill(joined({"--record", path("a.h5")}, rate));
  robots_of(mercury(joined(resume_, {"--record", path("a.h5")})));
  expect_same(path("a.h5"), path("whole.h5"));
  EXPECT_EQ(TrajectoryReader(path("a.h5")).frame_rate(), 700);
}

TEST_F(Checkpoint, ARecordingWithBrainsIsContinued) {
  const Arguments brains{"sample:hunter", "--target", "1,2,0", "--physics", "real", "--brains", "--every", "7"};
  robots_of(mercury(joined(run_, {"--record", path("whole.h5")}, brains)));
  kill(joined({"--record", path("a.h5")}, brains));
  EXPECT_THAT(refused(joined(resume_, {"--record", path("a.h5"), "--brains"})).messages,
              HasSubstr("--brains: is that of " + path("c.h5") + " in a resumed run; leave it out"));
  robots_of(mercury(joined(resume_, {"--record", path("a.h5")})));
  expect_same(path("a.h5"), path("whole.h5"));
  EXPECT_TRUE(TrajectoryReader(path("a.h5")).has_brains());
  EXPECT_EQ(mercury({"verify", path("a.h5"), "--quiet"}).status, 0);
}

TEST_F(Checkpoint, ARecordingThatIsNotThereIsReported) {
  kill({"--record", path("a.h5")});
  for (const std::string& name : listing())
    if (name.ends_with(".part")) std::filesystem::remove(path(name));
  EXPECT_THAT(refused(joined(resume_, {"--record", path("a.h5")})).messages, HasSubstr("cannot be continued"));
  const Outcome without = succeeded(mercury(resume_));
  EXPECT_THAT(without.messages, HasSubstr("is not continued"));
}

TEST_F(Checkpoint, OptionsThatItHasAreRefused) {
  succeeded(mercury(joined(run_, {"--checkpoint", path("c.h5")})));
  EXPECT_THAT(refused(joined(resume_, {"--random", "voxel:2"})).messages, HasSubstr("give no others"));
  EXPECT_THAT(refused(joined(resume_, {"--dt", "0.01"})).messages, HasSubstr("its own configuration"));
  EXPECT_THAT(refused(joined(resume_, {"--seconds", "0.5"})).messages, HasSubstr("has come to 1.23 s"));
  EXPECT_THAT(refused(joined(resume_, {"--record", path("a.h5")})).messages, HasSubstr("without a recording"));
  EXPECT_THAT(refused(joined(run_, {"--checkpoint-every", "5"})).messages, HasSubstr("goes with --checkpoint"));
  EXPECT_THAT(refused(joined(run_, {"--checkpoint", path("c.h5")})).messages, HasSubstr("exists"));
}

TEST_F(Checkpoint, AFileThatIsNoneIsRefusedInOneLine) {
  write("text.h5", "nothing");
  EXPECT_THAT(refused({"run", "--resume"}).messages, HasSubstr("goes on from the file of --checkpoint"));
  EXPECT_THAT(refused({"run", "--resume", "--checkpoint", path("text.h5")}).messages, HasSubstr("is not an HDF5 file"));
  EXPECT_THAT(refused({"run", "--resume", "--checkpoint", path("missing.h5")}).messages, HasSubstr("missing.h5"));
  succeeded(mercury(joined(run_, {"--record", path("r.h5")})));
  EXPECT_THAT(refused({"run", "--resume", "--checkpoint", path("r.h5")}).messages,
              HasSubstr("is a recording, not a checkpoint"));
  succeeded(mercury(joined(run_, {"--checkpoint", path("c.h5")})));
  const std::string whole = read("c.h5");
  write("half.h5", whole.substr(0, whole.size() / 2));
  refused({"run", "--resume", "--checkpoint", path("half.h5")});
  const hid_t file = H5Fopen(path("c.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const hid_t group = H5Gopen2(file, "checkpoint", H5P_DEFAULT);
  H5Adelete(group, "version");
  const hid_t one = H5Screate(H5S_SCALAR),
              version = H5Acreate2(group, "version", H5T_STD_I32LE, one, H5P_DEFAULT, H5P_DEFAULT);
  const int newer = 2;
  H5Awrite(version, H5T_NATIVE_INT, &newer);
  H5Aclose(version);
  H5Sclose(one);
  H5Gclose(group);
  H5Fclose(file);
  EXPECT_THAT(refused(resume_).messages, HasSubstr("is a checkpoint of version 2; this program reads version 1"));
}

TEST_F(Checkpoint, LinksOutOfItAreNotFollowed) {
  succeeded(mercury(joined(run_, {"--checkpoint", path("c.h5")})));
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);  // whoever opens it waits
  std::filesystem::create_symlink(path("pipe"), path("link.h5"));
  EXPECT_THAT(refused({"run", "--resume", "--checkpoint", path("link.h5")}).messages,
              HasSubstr("link.h5: is not a regular file"));
  const std::string whole = read("c.h5");
  for (const std::string member : {"/checkpoint", "/checkpoint/robots", "/checkpoint/measures", "/parameters/step"}) {
    write("c.h5", whole);
    const hid_t file = H5Fopen(path("c.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    H5Ldelete(file, member.c_str(), H5P_DEFAULT);
    H5Lcreate_external(path("pipe").c_str(), "/", file, member.c_str(), H5P_DEFAULT, H5P_DEFAULT);
    H5Fclose(file);
    EXPECT_THAT(refused(resume_).messages, HasSubstr("is a link, which is not followed")) << member;
  }
  write("c.h5", whole);
  const hid_t file = H5Fopen(path("c.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const hid_t old = H5Dopen2(file, "/checkpoint/measures", H5P_DEFAULT), space = H5Dget_space(old);
  H5Ldelete(file, "/checkpoint/measures", H5P_DEFAULT);
  const hid_t elsewhere = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_external(elsewhere, path("pipe").c_str(), 0, H5F_UNLIMITED);
  H5Dclose(H5Dcreate2(file, "/checkpoint/measures", H5T_IEEE_F64LE, space, H5P_DEFAULT, elsewhere, H5P_DEFAULT));
  H5Pclose(elsewhere);
  H5Sclose(space);
  H5Dclose(old);
  H5Fclose(file);
  EXPECT_THAT(refused(resume_).messages, HasSubstr("has its values in other files"));
}

class Verify : public Checkpoint {
 protected:
  void record(const Arguments& more = {}) { succeeded(mercury(joined(run_, {"--record", path("r.h5")}, more))); }
};

TEST_F(Verify, ARecordingIsTheSameOnItsDevice) {
  record();
  const Outcome outcome = succeeded(mercury({"verify", path("r.h5"), "--quiet"}));
  EXPECT_THAT(outcome.output, HasSubstr("same: positions and velocities are identical, bit for bit"));
  const json report = json::parse(mercury({"verify", path("r.h5"), "--json", "--quiet"}).output);
  EXPECT_EQ(report["identical"], true);
  EXPECT_EQ(report["frames"].size(), TrajectoryReader(path("r.h5")).frames());
  EXPECT_TRUE(report["first_difference"].is_null());
}

TEST_F(Verify, FramesBetweenStepsAreTheSame) {
  record({"--fps", "30"});
  TrajectoryReader recording(path("r.h5"));
  ASSERT_EQ(recording.frames(), 37u);
  EXPECT_DOUBLE_EQ(recording.time(36), 1.2);
  EXPECT_EQ(recording.step(1), 33);
  const json report = json::parse(mercury({"verify", path("r.h5"), "--json", "--quiet"}).output);
  EXPECT_EQ(report["identical"], true);
  EXPECT_EQ(report["frames"].size(), 37u);
}

// A mass is moved by 1 mm in one frame.
TEST_F(Verify, ADifferenceIsFound) {
  record();
  const std::string group = TrajectoryReader(path("r.h5")).robots()[1].group;
  const hid_t file = H5Fopen(path("r.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const hid_t values = H5Dopen2(file, ("particles/" + group + "/position/value").c_str(), H5P_DEFAULT);
  const hid_t space = H5Dget_space(values), one = H5Screate(H5S_SCALAR);
  const hsize_t start[] = {5, 2, 0}, count[] = {1, 1, 1};
  H5Sselect_hyperslab(space, H5S_SELECT_SET, start, nullptr, count, nullptr);
  float x = 0;
  H5Dread(values, H5T_NATIVE_FLOAT, one, space, H5P_DEFAULT, &x);
  x += 1e-3f;
  H5Dwrite(values, H5T_NATIVE_FLOAT, one, space, H5P_DEFAULT, &x);
  for (const hid_t id : {space, one}) H5Sclose(id);
  H5Dclose(values);
  H5Fclose(file);
  const Outcome outcome = mercury({"verify", path("r.h5"), "--json", "--quiet"});
  EXPECT_EQ(outcome.status, 1);
  const json report = json::parse(outcome.output);
  EXPECT_EQ(report["identical"], false);
  EXPECT_NEAR(report["largest_difference"], 1e-3, 1e-6);
  EXPECT_EQ(report["first_difference"]["robot"], 1);
  EXPECT_EQ(report["first_difference"]["step"], 5 * 33);
  EXPECT_EQ(mercury({"verify", path("r.h5"), "--tolerance", "0.01", "--quiet"}).status, 0);
  EXPECT_EQ(mercury({"verify", path("r.h5"), "--tolerance", "0.0001", "--quiet"}).status, 1);
}

TEST_F(Verify, FilesThatAreNoRecordingsAreRefused) {
  write("text.h5", "nothing");
  EXPECT_THAT(refused({"verify", path("text.h5")}).messages, HasSubstr("is not an HDF5 file"));
  EXPECT_THAT(refused({"verify", path("missing.h5")}).messages, HasSubstr("missing.h5"));
  record();
  EXPECT_THAT(refused({"verify", path("r.h5"), "--tolerance", "-1"}).messages, HasSubstr("--tolerance"));
}

}  // namespace
}  // namespace mercury::test
