// SPDX-License-Identifier: Apache-2.0
// Motions: which frames, in which order, and what happens when the work is stopped.
#include <gmock/gmock.h>

#include <limits>
#include <sstream>

#include "app/export/export.h"
#include "mercury/csv.h"
#include "mercury/error.h"
#include "mercury/file_links.h"
#include "tests/app/export/export_bodies.h"
#include "tests/app/program.h"
#include "tests/app/recording/recording_bodies.h"
#include "tests/refusal.h"

namespace mercury::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

// Two robots, frames at 0, 0.01, ..., 0.1 s.
class ExportMotion : public FolderTest {
 protected:
  ExportMotion() {
    Simulation simulation(on_cpu(), std::vector{small_voxel_robot(0), small_voxel_robot(1)});
    record(simulation, path("run.h5"), 100, 10);
    recording_ = std::make_shared<TrajectoryReader>(path("run.h5"));
  }
  RecordedMotion motion(const FrameRange& range = {}) const { return {recording_, 1, range}; }

  std::shared_ptr<TrajectoryReader> recording_;
};

TEST_F(ExportMotion, PointCacheHasItsHeaderAndEveryFrame) {
  RecordedMotion moves = motion();
  write_pc2(moves.robot(), moves, path("run.pc2"), {});
  const std::string pc2 = read("run.pc2");
  const Robot& robot = moves.robot().robot;
  std::vector<bool> on_skin(robot.masses.size());
  for (const Face& face : robot.faces) on_skin[face.a] = on_skin[face.b] = on_skin[face.c] = true;
  const auto points = static_cast<std::size_t>(std::ranges::count(on_skin, true));
  EXPECT_EQ(pc2.substr(0, 12), std::string("POINTCACHE2\0", 12));
  EXPECT_EQ(number_at<std::int32_t>(pc2, 12), 1);
  EXPECT_EQ(static_cast<std::size_t>(number_at<std::int32_t>(pc2, 16)), points);
  EXPECT_EQ(number_at<float>(pc2, 20), 0);
  EXPECT_EQ(number_at<float>(pc2, 24), 1);
  EXPECT_EQ(number_at<std::int32_t>(pc2, 28), 11);
  ASSERT_EQ(pc2.size(), 32 + 11 * points * 12);
  std::size_t place = 32;
  for (std::size_t frame = 0; frame < 11; ++frame) {
    const auto all = recording_->positions(frame);
    for (std::size_t mass = 0; mass < on_skin.size(); ++mass) {
      if (!on_skin[mass]) continue;
      ASSERT_EQ(number_at<Vec3>(pc2, place), all[recording_->mass_offsets()[1] + mass]);
      place += 12;
    }
  }
}

TEST_F(ExportMotion, TableHasTheCenterOfMassAndWhatTheBrainSensedAndDid) {
  Robot thinker = thinking_pair("thinker");
  thinker.mass = {1, 3};
  thinker.sensors[2] = {.kind = SensorKind::depth, .masses = {1}};  // a second depth
  Simulation simulation(on_cpu(), std::vector{small_voxel_robot(0), thinker});
  record(simulation, path("think.h5"), 100, 10, {.brains = true});
  const auto recording = std::make_shared<TrajectoryReader>(path("think.h5"));
  RecordedMotion moves(recording, 1);
  write_csv(moves.robot(), moves, path("think.csv"), {});
  std::istringstream table(read("think.csv"));
  std::string line;
  std::getline(table, line);
  EXPECT_EQ(line,
            "time [s],x [m],y [m],z [m],velocity x [m/s],velocity y [m/s],velocity z [m/s],sense clock sine,"
            "sense clock cosine,sense depth,sense depth 2,neuron hidden 0,neuron hidden 1,neuron motor 0");
  for (std::size_t frame = 0; frame < 11; ++frame) {
    ASSERT_TRUE(std::getline(table, line));
    std::vector<double> numbers;
    for (const std::string& field : csv_fields(line)) numbers.push_back(std::stod(field));
    ASSERT_EQ(numbers.size(), 14u);
    EXPECT_EQ(numbers[0], recording->time(frame));
    const auto positions = recording->positions_of(1, frame), velocities = recording->velocities_of(1, frame);
    EXPECT_NEAR(numbers[1], (positions[0].x + 3 * positions[1].x) / 4, 1e-7);
    EXPECT_NEAR(numbers[4], (velocities[0].x + 3 * velocities[1].x) / 4, 1e-7);
    for (std::size_t i = 0; i < 4; ++i)
      EXPECT_EQ(static_cast<float>(numbers[7 + i]), recording->senses_of(1, frame)[i]);
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_EQ(static_cast<float>(numbers[11 + i]), recording->neurons_of(1, frame)[i]);
  }
  EXPECT_FALSE(std::getline(table, line));

  RecordedMotion other(recording, 0, {.every = 5});
  write_csv(other.robot(), other, path("other.csv"), {});
  EXPECT_EQ(std::ranges::count(read("other.csv"), '\n'), 4);
  EXPECT_EQ(std::ranges::count(read("other.csv"), ','), 4 * 6) << "a robot without a brain";
}

TEST_F(ExportMotion, MeshBesideAPointCacheHasTheVerticesOfItsFirstFrame) {
  for (const bool springs : {false, true}) {
    RecordedMotion moves = motion({.from = 0.05});
    write_pc2(moves.robot(), moves, path("run.pc2"), {.springs = springs});
    const std::string pc2 = read("run.pc2");
    std::istringstream obj(read("run.obj"));
    std::size_t place = 32;
    for (std::string line; std::getline(obj, line);) {
      if (!line.starts_with("v ")) continue;
      std::istringstream numbers(line.substr(2));
      Vec3 vertex;
      numbers >> vertex.x >> vertex.y >> vertex.z;
      EXPECT_EQ(vertex, number_at<Vec3>(pc2, place));
      place += 12;
    }
    EXPECT_EQ(place, 32 + 12 * static_cast<std::size_t>(number_at<std::int32_t>(pc2, 16)));
  }
}

TEST_F(ExportMotion, RangeTakesTheNearestFrames) {
  const RecordedMotion part = motion({.from = 0.032, .to = 0.078, .every = 2});
  ASSERT_EQ(part.frames(), 3u);
  EXPECT_EQ(part.recorded_frame(0), 3u);
  EXPECT_EQ(part.recorded_frame(2), 7u);
  EXPECT_DOUBLE_EQ(part.frame_rate(), 50);
  EXPECT_EQ(RecordedMotion::still(recording_, 0, 0.049).recorded_frame(0), 5u);
  EXPECT_EQ(motion({.every = std::numeric_limits<std::int64_t>::max()}).frames(), 1u);
  EXPECT_EQ(motion({.from = 0.1, .to = 0.1}).frames(), 1u);
  EXPECT_THROW(motion({.from = -0.01}), ParameterError);
  EXPECT_THROW(motion({.to = 0.2}), ParameterError);
  EXPECT_THROW(motion({.from = std::nan("")}), ParameterError);
}

TEST_F(ExportMotion, StoppedWorkLeavesNothingBehind) {
  struct Stopped {};
  const std::vector<std::string> before = listing();
  for (const ExportFormat& format : export_formats()) {
    if (!holds_motion(format)) continue;
    RecordedMotion moves = motion();
    if (format.folder_beside) std::filesystem::create_directories(format.folder_beside(path("run.pvd")));
    const ExportChoices choices{.watch = [](std::size_t done, std::size_t total) {
      if (done > total / 2) throw Stopped();
    }};
    try {
      format.motion(moves.robot(), moves, path("run" + std::string(format.extension)), choices);
      ADD_FAILURE() << format.name << " was not watched";
    } catch (const Stopped&) {
    }
    EXPECT_EQ(listing(), before) << format.name;
  }
}

TEST_F(ExportMotion, MotionThatIsTooLongForGlbNamesWhatFits) {
  Simulation simulation(on_cpu(), std::vector{small_voxel_robot(0)});
  record(simulation, path("long.h5"), 600, 1);
  RecordedMotion moves(std::make_shared<TrajectoryReader>(path("long.h5")), 0);
  EXPECT_THAT(refusal([&] { write_glb_motion(moves.robot(), moves, path("long.glb"), {}); }),
              testing::AllOf(HasSubstr("601 frames of "), HasSubstr("at most 257 fit; give --every 3, or --to 0.256")));
  for (const FrameRange& range : {FrameRange{.every = 3}, FrameRange{.to = 0.256}}) {
    RecordedMotion fits(std::make_shared<TrajectoryReader>(path("long.h5")), 0, range);
    EXPECT_NO_THROW(write_glb_motion(fits.robot(), fits, path("long.glb"), {}));
  }
}

TEST_F(ExportMotion, MotionOfARobotThatExplodedEndsBeforeItsPositionsAreNoNumbers) {
  const Robot robot = pair("pair");
  const std::vector<Material> materials(max_materials);
  {
    const Robot* robots[] = {&robot};
    TrajectoryWriter writer(path("exploded.h5"), {.configuration = on_cpu()}, robots, materials, "--record");
    for (int frame = 0; frame < 4; ++frame) {
      const TrajectoryWriter::Frame next = writer.add(frame, 0.001 * frame);
      for (Vec3& position : next.positions)
        position = {frame < 3 ? 0.5f : std::numeric_limits<float>::infinity(), 0, 0};
      writer.commit();
    }
    Telemetry telemetry;
    telemetry.exploded = true;
    telemetry.exploded_at = 0.0015;
    writer.finish(std::span(&telemetry, 1));
  }
  const auto exploded = std::make_shared<TrajectoryReader>(path("exploded.h5"));
  const RecordedMotion moves(exploded, 0);
  EXPECT_EQ(moves.frames(), 3u);
  EXPECT_EQ(moves.problem(), "pair explodes: its motion ends at 0.002 s");
  EXPECT_THROW(RecordedMotion(exploded, 0, {.from = 0.003}), InputError);
}

// Another program writes a file of the same new name between the check and the end of the work.
class NewNameOfTwo : public ExportMotion, public testing::WithParamInterface<std::string> {
 protected:
  void export_as(const ExportFormat& format, const std::string& file) {
    RecordedMotion moves = motion();
    if (holds_motion(format))
      format.motion(moves.robot(), moves, path(file), {});
    else
      format.pose(moves.robot(), moves.pose(0), path(file), {});
  }
};

TEST_P(NewNameOfTwo, BothKeepTheirFiles) {
  const ExportFormat& format = export_format(GetParam());
  const std::string extension(format.extension), file = "run" + extension, other = "run-2" + extension;
  OutputFiles outputs(false, false);
  add_outputs(format, path(file), outputs, "-o");
  outputs.check();
  const auto files = [&](const std::string& name) {
    std::vector<std::filesystem::path> all{path(name)};
    if (format.files_beside) std::ranges::copy(format.files_beside(path(name)), std::back_inserter(all));
    if (format.folder_beside) all.push_back(format.folder_beside(path(name)));
    return all;
  };
  for (const std::filesystem::path& theirs : files(file)) write(theirs.filename().string(), "theirs");
  try {
    export_as(format, file);
    FAIL() << "replaced a file of another program";
  } catch (const NameTaken& taken) {
    EXPECT_EQ(taken.name, path(other));
    EXPECT_EQ(taken.what(), path(file) + " was written by another program in the meantime; this one is " + path(other));
  }
  for (const std::filesystem::path& theirs : files(file)) EXPECT_EQ(read(theirs.filename().string()), "theirs");
  for (const std::filesystem::path& ours : files(other)) EXPECT_TRUE(std::filesystem::exists(ours)) << ours;
  EXPECT_EQ(listing().size(), 1 + 2 * files(file).size()) << "temporary files are left";
  // Files name those beside them.
  const std::string content = read(other);
  EXPECT_EQ(content.find("run-frames"), std::string::npos);
  EXPECT_EQ(content.find("run.frames"), std::string::npos);
  EXPECT_EQ(content.find("mtllib run.mtl"), std::string::npos);
  // What this program has written it may replace.
  std::filesystem::rename(path(file), path("theirs"));
  if (!format.files_beside && !format.folder_beside) {
    export_as(format, file);
    export_as(format, file);
  }
}

INSTANTIATE_TEST_SUITE_P(Export, NewNameOfTwo, testing::ValuesIn([] {
                           std::vector<std::string> names;
                           for (const ExportFormat& format : export_formats()) names.emplace_back(format.name);
                           return names;
                         }()),
                         [](const auto& format) { return format.param; });

}  // namespace
}  // namespace mercury::test
