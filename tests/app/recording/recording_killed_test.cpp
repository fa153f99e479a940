// SPDX-License-Identifier: Apache-2.0
// A program that is killed leaves a recording that opens with all frames that it had flushed, bit for bit.
#include <gmock/gmock.h>
#include <hdf5.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <exception>
#include <new>
#include <set>

#include "app/recording/trajectory_layout.h"
#include "app/recording/trajectory_reader.h"
#include "app/recording/trajectory_writer.h"
#include "mercury/error.h"
#include "mercury/random.h"
#include "tests/app/program.h"
#include "tests/app/recording/file_operations.h"
#include "tests/app/recording/recording_bodies.h"
#include "tests/size_limit.h"

namespace mercury::test {
namespace {

// What writers believe: a second per call, unless a test changes it.
double now = 0;
double own_clock() { return now; }

Vec3 value(std::int64_t frame, std::size_t mass, float sign) {
  return {sign * static_cast<float>(frame + 1), 0.37f * static_cast<float>(mass), 1 / static_cast<float>(frame + 3)};
}

// The robots of a recording, and the recording.
class Source {
 public:
  explicit Source(int robots) {
    for (int i = 0; i < robots; ++i) robots_.push_back(small_voxel_robot(static_cast<std::uint64_t>(i)));
    robots_.back().sensors = thinking_pair("").sensors;
    robots_.back().actuators = {{"muscle", {1}}};
    robots_.back().brain = thinking_pair("").brain;
    for (const Robot& robot : robots_) {
      pointers_.push_back(&robot);
      std::vector<Material> table(materials_of(robot).begin(), materials_of(robot).end());
      table.resize(max_materials);
      materials_.insert(materials_.end(), table.begin(), table.end());
    }
  }

  TrajectoryWriter writer(const std::string& path, TrajectoryHeader header) const {
    header.configuration = on_cpu();
    header.clock = own_clock;
    header.brains = true;
    return TrajectoryWriter(path, header, pointers_, materials_, "--record");
  }

  // Each frame takes that many seconds.
  static void add(TrajectoryWriter& writer, std::int64_t frames, double seconds) {
    while (frames-- > 0) {
      const std::int64_t number = writer.frames();
      const TrajectoryWriter::Frame frame = writer.add(10 * number, 0.01 * static_cast<double>(number));
      for (std::size_t i = 0; i < frame.positions.size(); ++i) {
        frame.positions[i] = value(number, i, 1);
        frame.velocities[i] = value(number, i, -1);
      }
      for (std::size_t i = 0; i < frame.senses.size(); ++i) frame.senses[i] = value(number, i, 1).z;
      for (std::size_t i = 0; i < frame.neurons.size(); ++i) frame.neurons[i] = value(number, i, -1).x;
      now += seconds;
      writer.commit();
    }
  }

  // All robots explode, so that as much as possible is written at the end.
  void finish(TrajectoryWriter& writer) const {
    std::vector<Telemetry> telemetry(robots_.size());
    for (Telemetry& robot : telemetry) {
      robot.exploded = true;
      robot.culprit_spring = 1;
    }
    writer.finish(telemetry);
  }

 private:
  std::vector<Robot> robots_;
  std::vector<const Robot*> pointers_;
  std::vector<Material> materials_;
};

// Expects all frames of a file to be those that were written. Returns their number.
std::size_t expect_frames(TrajectoryReader& reader) {
  const auto same = [](std::span<const Vec3> found, std::int64_t frame, float sign) {
    for (std::size_t i = 0; i < found.size(); ++i)
      if (found[i] != value(frame, i, sign)) return false;
    return true;
  };
  for (std::size_t i = 0; i < reader.frames(); ++i) {
    const auto number = static_cast<std::int64_t>(i);
    EXPECT_EQ(reader.step(i), 10 * number);
    EXPECT_EQ(reader.time(i), 0.01 * static_cast<double>(number));
    EXPECT_TRUE(same(reader.positions(i), number, 1)) << "positions of frame " << i;
    EXPECT_TRUE(same(reader.velocities(i), number, -1)) << "velocities of frame " << i;
    EXPECT_THAT(reader.senses(i), testing::AllOf(testing::SizeIs(4), testing::Each(value(number, 0, 1).z)));
    EXPECT_THAT(reader.neurons(i), testing::AllOf(testing::SizeIs(3), testing::Each(value(number, 0, -1).x)));
  }
  return reader.frames();
}

class KilledRecording : public FolderTest {
 protected:
  KilledRecording() {
    now = 0;
    keep_freed_memory();
  }

  std::string part() const {
    for (const std::string& name : listing())
      if (name.ends_with(".part")) return path(name);
    return "";
  }

  // The frames of a file with these bytes, of which a reader must find at least as many as before.
  std::size_t read_frames(const std::string& bytes, std::size_t before) {
    write("copy.h5.1-0.part", bytes);
    TrajectoryReader reader(path("copy.h5.1-0.part"));
    const std::size_t found = expect_frames(reader);
    EXPECT_GE(found, before);
    return found;
  }

  // Replays what the program did to the file. After each operation, also one that is cut short, a reader of the file
  // must find all frames that the operations before had shown.
  void expect_readable_after_every(const FileOperations& operations, std::size_t from) {
    std::string bytes;
    std::size_t frames = 0;
    for (std::size_t i = 0; i < operations.size(); ++i) {
      SCOPED_TRACE("operation " + std::to_string(i));
      for (const std::size_t end : i < from ? std::vector<std::size_t>() : operations.breaks(i)) {
        SCOPED_TRACE("cut short after byte " + std::to_string(end));
        std::string torn = bytes;
        operations.apply(i, torn, end);
        read_frames(torn, frames);
      }
      operations.apply(i, bytes);
      if (i < from) continue;
      frames = read_frames(bytes, frames);
      ASSERT_FALSE(HasFailure());
    }
    EXPECT_EQ(TrajectoryReader(path("copy.h5.1-0.part")).unfinished(), false);
    frames_ = frames;
  }

  // Of the file as another process sees it.
  std::size_t shown_frames() const {
    std::filesystem::copy_file(part(), path("seen.h5"), std::filesystem::copy_options::overwrite_existing);
    try {
      return TrajectoryReader(path("seen.h5")).frames();
    } catch (const InputError&) {
      return 0;  // before the first block
    }
  }

  std::size_t frames_ = 0;
};

TEST(FlushIsDue, AfterAPeriodOrBeforeALongFrameWouldMissTwo) {
  EXPECT_FALSE(flush_is_due(4.9, 0.1, 5));
  EXPECT_TRUE(flush_is_due(5, 0.1, 5));
  EXPECT_FALSE(flush_is_due(3, 3, 5));
  EXPECT_TRUE(flush_is_due(4, 6, 5));
  EXPECT_TRUE(flush_is_due(0, 60, 5));  // each frame takes a minute
}

TEST_F(KilledRecording, OpensAfterEveryWriteOfTheProgram) {
  const Source source(2);
  const FileOperations operations;
  TrajectoryWriter writer = source.writer(path("a.h5"), {});
  source.add(writer, 1, 5);
  const std::size_t started = operations.size();
  source.add(writer, 12, 5);
  source.finish(writer);
  expect_readable_after_every(operations, started);
  EXPECT_EQ(frames_, 13u);
}

// The simulation becomes slower, so that blocks are flushed before they are complete.
TEST_F(KilledRecording, OpensAlsoWhenBlocksAreWrittenAgainWithMoreFrames) {
  for (const int deflate : {0, 1}) {
    const Source source(2);
    const FileOperations operations;
    TrajectoryWriter writer = source.writer(path("a.h5"), {.deflate = deflate});
    source.add(writer, 6, 1);  // a flush after five frames, the length of a block
    const std::size_t started = operations.size();
    source.add(writer, 12, 3);
    source.finish(writer);
    expect_readable_after_every(operations, started);
    EXPECT_EQ(frames_, 18u);
  }
}

// A write that is cut short: the kernel may stop between two pages when the program is killed.
TEST_F(KilledRecording, AChunkThatIsHalfWrittenAgainKeepsItsOldFrames) {
  const Source source(1);
  const FileOperations operations;
  TrajectoryWriter writer = source.writer(path("a.h5"), {});
  source.add(writer, 5, 1);
  source.add(writer, 1, 6);
  const std::size_t before = operations.size();
  source.add(writer, 1, 6);
  std::string bytes;
  std::set<std::size_t> found;
  for (std::size_t i = 0; i < operations.size(); ++i) {
    if (i >= before && operations.length(i) > 1000) {
      std::string torn = bytes;
      operations.apply(i, torn, operations.length(i) - 100);  // new rows, but not their checksum
      write("torn.h5", torn);
      TrajectoryReader reader(path("torn.h5"));
      found.insert(expect_frames(reader));
    }
    operations.apply(i, bytes);
  }
  EXPECT_THAT(found, testing::ElementsAre(6u));
}

TEST_F(KilledRecording, HoldsAtLeastTheFramesOfTenSecondsBefore) {
  for (const double seconds : {0.1, 0.7, 3.0, 4.9, 5.1, 20.0}) {
    const Source source(1);
    TrajectoryWriter writer = source.writer(path("a.h5"), {});
    for (int i = 0; i < 20; ++i) {
      source.add(writer, 1 + static_cast<std::int64_t>(1 / seconds), seconds);
      const auto shown = static_cast<std::int64_t>(shown_frames());
      // The oldest frame that is missing must not be older than ten seconds when the next frame comes.
      if (shown < writer.frames()) {
        EXPECT_LE(static_cast<double>(writer.frames() - shown) * seconds, 10) << seconds;
      }
    }
  }
}

TEST_F(KilledRecording, AFullDiskKeepsTheFramesOfTheLastFlush) {
  const Source source(2);
  std::set<std::size_t> kept;
  for (rlim_t limit = 0; limit < 200'000; limit += 9'001) {
    SCOPED_TRACE(limit);
    std::filesystem::remove(path("a.h5"));
    std::string message;
    {
      const SizeLimit limited(limit);
      try {
        TrajectoryWriter writer = source.writer(path("a.h5"), {.flush_period = 3});
        try {
          source.add(writer, 400, 1);
          source.finish(writer);
        } catch (const RecordingFailure&) {
          EXPECT_TRUE(writer.failed());
          throw;
        }
      } catch (const RecordingFailure& failure) {
        message = failure.what();
      }
    }
    ASSERT_THAT(message,
                testing::StartsWith(path("a.h5") + ": the file grew beyond the size allowed here (ulimit -f); "));
    EXPECT_EQ(part(), "");
    // What it did not let go of would lie in the way of the next recording.
    ASSERT_EQ(H5Fget_obj_count(static_cast<hid_t>(H5F_OBJ_ALL), H5F_OBJ_ALL), 0);
    if (message.ends_with("nothing was kept")) {
      EXPECT_FALSE(std::filesystem::exists(path("a.h5")));
      kept.insert(0);
      continue;
    }
    TrajectoryReader reader(path("a.h5"));
    const std::size_t found = expect_frames(reader);
    // A flush that fails at its very end may have announced its frames already.
    const std::size_t stated = std::stoul(message.substr(message.rfind("first ") + 6));
    EXPECT_GE(found, stated);
    EXPECT_LE(found, stated + 4);
    kept.insert(found);
  }
  EXPECT_GT(kept.size(), 5u);
}

// HDF5 would take too long to flush 2,001 robots.
class LargeKilledRecording : public KilledRecording {};

TEST_F(LargeKilledRecording, AFullDiskKeepsItsFramesToo) {
  const Source source(2001);
  const auto record = [&] {
    std::filesystem::remove(path("a.h5"));
    TrajectoryWriter writer = source.writer(path("a.h5"), {.flush_period = 4});
    source.add(writer, 24, 2);  // blocks of two frames
    source.finish(writer);
  };
  record();
  const auto limit = std::filesystem::file_size(path("a.h5")) - 1;
  std::string message;
  try {
    const SizeLimit limited(limit);
    record();
  } catch (const RecordingFailure& failure) {
    message = failure.what();
  }
  EXPECT_EQ(part(), "");
  EXPECT_LE(std::filesystem::file_size(path("a.h5")), limit);
  TrajectoryReader reader(path("a.h5"));
  EXPECT_FALSE(reader.unfinished());
  const std::size_t found = expect_frames(reader);
  EXPECT_GT(found, 0u);
  EXPECT_LT(found, 24u);
  EXPECT_EQ(message, path("a.h5") + ": the file grew beyond the size allowed here (ulimit -f); the first " +
                         std::to_string(found) + " frames were kept");
}

// A child writes frames as fast as it can, and flushes each. It is killed while it is somewhere in the next ones.
TEST_F(KilledRecording, OpensAfterAKillAtAnyMoment) {
  constexpr int no_memory = 77;
  const Source source(3);
  Random random(1);
  for (int trial = 0; trial < 60; ++trial) {
    std::array<int, 2> pipe{};
    ASSERT_EQ(::pipe(pipe.data()), 0);
    const pid_t child = fork();
    if (child == 0) try {
        TrajectoryWriter writer = source.writer(path("a.h5"), {.flush_period = 0});
        for (;;) {
          source.add(writer, 1, 1);
          const char frame = 0;
          if (::write(pipe[1], &frame, 1) != 1) _exit(1);
        }
      } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        _exit(dynamic_cast<const std::bad_alloc*>(&error) ? no_memory : 1);
      }
    close(pipe[1]);
    const auto acknowledged = 1 + static_cast<std::size_t>(random.below(40));
    char frame = 0;
    std::size_t written = 0;
    while (written < acknowledged && ::read(pipe[0], &frame, 1) == 1) ++written;
    kill(child, SIGKILL);
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    if (WIFEXITED(status) && WEXITSTATUS(status) == no_memory) GTEST_SKIP() << "the machine ran out of memory";
    ASSERT_EQ(written, acknowledged) << "the child ended with the status " << status;
    close(pipe[0]);
    TrajectoryReader reader(part());
    EXPECT_TRUE(reader.unfinished());
    EXPECT_GE(expect_frames(reader), acknowledged);
    std::filesystem::remove(part());
  }
}

TEST_F(KilledRecording, CutAnywhereItIsReadOrReportedInOneLine) {
  const Source source(2);
  TrajectoryWriter writer = source.writer(path("a.h5"), {});
  source.add(writer, 10, 5);
  const std::string whole = read(std::filesystem::path(part()).filename());
  std::size_t reported = 0;
  for (std::size_t length = 0; length < whole.size(); length += 97) {
    write("cut.h5", whole.substr(0, length));
    try {
      TrajectoryReader reader(path("cut.h5"));
      for (std::size_t i = 0; i < reader.frames(); ++i) {
        reader.positions(i);
        reader.velocities(i);
      }
      EXPECT_EQ(expect_frames(reader), 10u) << length;
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
      ++reported;
    }
  }
  EXPECT_GT(reported, whole.size() / 97 / 2);
}

TEST_F(KilledRecording, InfoSaysWhatItHoldsAndHowToUseIt) {
  const Source source(2);
  TrajectoryWriter writer = source.writer(path("a.h5"), {});
  source.add(writer, 3, 2);
  source.add(writer, 1, 1);  // not flushed
  const Outcome outcome = succeeded(mercury({"info", part()}));
  EXPECT_THAT(outcome.output, testing::HasSubstr("unfinished"));
  EXPECT_THAT(outcome.output, testing::HasSubstr("rename it to a.h5"));
  EXPECT_THAT(outcome.output, testing::HasSubstr("3, every 1 steps, 0 s to 0.02 s"));
  EXPECT_THAT(outcome.output, testing::HasSubstr("2, "));
}

TEST(TrajectoryNames, TemporaryNamesAreReadButNotWritten) {
  EXPECT_TRUE(is_readable_trajectory_name("a/swim.h5"));
  EXPECT_TRUE(is_readable_trajectory_name("swim.h5.1234-0.part"));
  EXPECT_TRUE(is_readable_trajectory_name("swim.H5MD.1-10.part"));
  EXPECT_FALSE(is_readable_trajectory_name("swim.mp4.1234-0.part"));
  EXPECT_FALSE(is_readable_trajectory_name("swim.part"));
  EXPECT_FALSE(is_trajectory_name("swim.h5.1234-0.part"));
}

}  // namespace
}  // namespace mercury::test
