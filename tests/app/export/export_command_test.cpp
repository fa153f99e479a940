// SPDX-License-Identifier: Apache-2.0
// mercury export as users call it: what is written where, and one line for what cannot be used.
#include <gmock/gmock.h>

#include "app/export/export_format.h"
#include "tests/app/export/export_bodies.h"
#include "tests/app/program.h"

namespace mercury::test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

class ExportCommand : public FolderTest {
 protected:
  ExportCommand() {
    succeeded(mercury({"new", "voxel", "--count", "2", "--seed", "7", "--voxels", "2x2x2", "-o", path("robots")}));
    robot_ = path("robots/voxel-7-0.json");
  }
  std::string recording() const {
    const std::string file = path("run.h5");
    succeeded(
        mercury({"run", path("robots"), "--seconds", "0.2", "--every", "20", "--device", "cpu", "--record", file}));
    return file;
  }
  static void refuses(const Arguments& arguments, const std::string& message) {
    EXPECT_THAT(mercury(joined({"export"}, arguments)), Ends(2, message)) << message;
  }
  std::string robot_;
};

TEST_F(ExportCommand, ExtensionSaysTheFormatAndNamesArePrinted) {
  for (const ExportFormat& format : export_formats()) {
    if (!holds_pose(format)) continue;
    const std::string file = path("eel" + std::string(format.extension));
    const Outcome outcome = succeeded(mercury({"export", robot_, "-o", file}));
    EXPECT_EQ(outcome.output, file + "\n");
    EXPECT_TRUE(std::filesystem::exists(file));
  }
}

TEST_F(ExportCommand, EveryMotionFormatTakesARecording) {
  const std::string file = recording();
  for (const ExportFormat& format : export_formats()) {
    if (!holds_motion(format)) continue;
    const std::string target = path("out/swim" + std::string(format.extension));
    const Outcome outcome = succeeded(mercury({"export", file, "--robot", "1", "--every", "2", "-o", target}));
    EXPECT_EQ(outcome.output, target + "\n");
  }
}

TEST_F(ExportCommand, SeriesHasTheChosenFramesWithTheirTimes) {
  const std::string file = recording();  // frames at 0, 0.02, ..., 0.2 s
  succeeded(mercury({"export", file, "--robot", "voxel-7-1", "--from", "0.04", "--to", "0.17", "--every", "2", "-o",
                     path("swim.pvd")}));
  EXPECT_THAT(listing("swim-frames"), ElementsAre("0.vtu", "1.vtu", "2.vtu", "3.vtu"));
  const std::string list = read("swim.pvd");
  for (const char* entry : {"timestep=\"0.04\" part=\"0\" file=\"swim-frames/0.vtu\"", "timestep=\"0.08\"",
                            "timestep=\"0.12\"", "timestep=\"0.16\" part=\"0\" file=\"swim-frames/3.vtu\""})
    EXPECT_THAT(list, HasSubstr(entry));
}

TEST_F(ExportCommand, ShorterSeriesRemovesTheFurtherFramesOfAnEarlierOne) {
  const std::string file = recording();
  succeeded(mercury({"export", file, "--robot", "0", "-o", path("swim.pvd")}));
  EXPECT_EQ(listing("swim-frames").size(), 11u);
  write("swim-frames/notes.txt", "mine");
  refuses({file, "--robot", "0", "--to", "0.02", "-o", path("swim.pvd")},
          "-o: " + path("swim.pvd") + " exists already; use --force to replace it, or give another name");
  succeeded(mercury({"export", file, "--robot", "0", "--to", "0.02", "--force", "-o", path("swim.pvd")}));
  EXPECT_THAT(listing("swim-frames"), ElementsAre("0.vtu", "1.vtu", "notes.txt"));
}

TEST_F(ExportCommand, SeveralRobotsGoIntoAFolder) {
  succeeded(mercury({"export", path("robots"), "--format", "stl", "-o", path("printed")}));
  EXPECT_THAT(listing("printed"), ElementsAre("voxel-7-0.stl", "voxel-7-1.stl"));
  refuses({path("robots"), "-o", path("all.stl")},
          "-o: " + path("all.stl") +
              " is one file, and there are 2 robots; give a folder with --format, or choose one with --robot");
  EXPECT_EQ(mercury({"export", path("robots"), "--robot", "voxel-7-1", "-o", path("one.stl")}).status, 0);
}

TEST_F(ExportCommand, StillTakesThePoseOfTheNearestFrame) {
  const std::string file = recording();
  succeeded(mercury({"export", file, "--still", "0.111", "--robot", "0", "-o", path("still.obj")}));
  succeeded(mercury({"export", file, "--still", "0.12", "--robot", "0", "-o", path("exact.obj")}));
  const auto vertices = [](const std::string& obj) { return obj.substr(obj.find("\nv ")); };
  const auto without_materials = [&](std::string obj) { return vertices(obj); };
  EXPECT_EQ(without_materials(read("still.obj")), without_materials(read("exact.obj")));
  succeeded(mercury({"export", robot_, "-o", path("rest.obj")}));
  EXPECT_NE(vertices(read("rest.obj")), vertices(read("exact.obj")));
}

TEST_F(ExportCommand, RobotsAreSimulatedForAMotion) {
  // A frame is 20 steps.
  const Arguments options{"--seconds", "0.1", "--dt", "0.0016666666666666668", "--device", "cpu"};
  const auto with_options = [&](const Arguments& words) { return mercury(joined(words, options)); };
  ASSERT_EQ(with_options({"run", robot_, "--every", "20", "--record", path("run.h5")}).status, 0);
  succeeded(mercury({"export", path("run.h5"), "-o", path("recorded.pc2")}));
  const Outcome outcome = succeeded(with_options({"export", robot_, "-o", path("simulated.pc2")}));
  EXPECT_EQ(outcome.output, path("simulated.pc2") + "\n");
  EXPECT_EQ(read("simulated.pc2"), read("recorded.pc2"));
  EXPECT_THAT(listing("."), Not(Contains(HasSubstr(".simulated"))));  // no recording is left
  refuses({robot_, "-o", path("eel.stl"), "--seconds", "1"},
          "--seconds: stl holds one pose; give " + format_names(holds_simulated_motion));
  refuses({robot_, "-o", path("eel.html"), "--seconds", "0"}, "--seconds: 0 is not accepted for a motion; give more");
  refuses({robot_, "-o", path("eel.stl"), "--dt", "0.002"},
          "--dt: goes with a motion, and stl is written at rest; give --seconds, too, and " +
              format_names(holds_simulated_motion));
  refuses({path("run.h5"), "-o", path("eel.pc2"), "--dt", "0.002"},
          "--dt: a recording has its own configuration; give robots to simulate");
}

// Frames on steps are the steps' states, and those between them lie between them.
TEST_F(ExportCommand, TheFrameRateOfASimulatedMotionIsChosen) {
  const Arguments options{"--seconds", "0.1", "--dt", "0.005", "--device", "cpu"};
  const auto exported = [&](const std::string& file, const std::string& rate) {
    succeeded(mercury(joined({"export", robot_, "-o", path(file), "--fps", rate}, options)));
    return read(file);
  };
  const std::string steps = exported("steps.pc2", "200"), between = exported("between.pc2", "80");
  ASSERT_EQ(number_at<std::int32_t>(steps, 28), 21);
  ASSERT_EQ(number_at<std::int32_t>(between, 28), 9);
  const auto floats = static_cast<std::size_t>(3 * number_at<std::int32_t>(steps, 16));
  // Frame 1 of 80 Hz is half way between steps 2 and 3, frame 2 is step 5.
  for (std::size_t i = 0; i < floats; ++i) {
    const auto at_step = [&](std::size_t step) { return number_at<float>(steps, 32 + 4 * (step * floats + i)); };
    const auto at_frame = [&](std::size_t frame) { return number_at<float>(between, 32 + 4 * (frame * floats + i)); };
    EXPECT_NEAR(at_frame(1), (at_step(2) + at_step(3)) / 2, 1e-6f);
    EXPECT_EQ(at_frame(2), at_step(5));
  }
  refuses({robot_, "-o", path("a.pc2"), "--dt", "0.005", "--fps", "201"},
          "--fps: 201 is not accepted; give more than 0 and at most 200 frames/s, one per step");
  refuses({robot_, "-o", path("a.pc2"), "--fps", "nan"},
          "--fps: nan is not accepted; give more than 0 and at most 1000 frames/s, one per step");
  refuses({robot_, "-o", path("a.obj"), "--fps", "25"},
          "--fps: goes with a motion, and obj is written at rest; give --seconds, too, and " +
              format_names(holds_simulated_motion));
}

TEST_F(ExportCommand, APageHoldsAllRobots) {
  const Outcome outcome =
      mercury({"export", path("robots"), "--seconds", "0.1", "--device", "cpu", "-o", path("two.html")});
  EXPECT_EQ(outcome.status, 0) << outcome.messages;
  EXPECT_EQ(outcome.output, path("two.html") + "\n");
  const std::string page = read("two.html");
  for (const char* text : {"voxel-7-0", "voxel-7-1", "mercury export", "id=\"robot-1\""})
    EXPECT_THAT(page, HasSubstr(text));
  // Nothing comes from a network; only the name of SVG looks like an address.
  const std::string name_of_svg = "http://www.w3.org/2000/svg";
  for (std::size_t at = page.find("http"); at != std::string::npos; at = page.find("http", at + 1))
    EXPECT_EQ(page.substr(at, name_of_svg.size()), name_of_svg);
  EXPECT_THAT(page, Not(HasSubstr("{{")));  // every part is filled in
  refuses({path("robots"), "--lineage", "best", "-o", path("a.html")},
          "--lineage: chooses robots of a run of mercury evolve; give its folder");
}

TEST_F(ExportCommand, WhatCannotBeUsedIsOneLine) {
  const std::string names = format_names();
  refuses({robot_, "-o", path("eel.xyz")}, "-o: " + path("eel.xyz") + ": \".xyz\" is no format; give a file of " +
                                               names + ", or a folder with --format");
  refuses({robot_, "-o", path("eel")}, "--format: a folder does not say it; give " + names);
  refuses({robot_, "-o", path("eel.obj"), "--format", "stl"},
          "-o: " + path("eel.obj") + " is a name of obj files; give one that ends in .stl");
  refuses({robot_, "-o", path("eel.stl"), "--springs"},
          "--springs: a .stl file holds no springs; give " + format_names(holds_springs));
  refuses({robot_, "-o", path("eel.stl"), "--still", "1"},
          "--still: chooses frames of a recording (.h5), and there is none");
  refuses({robot_, "-o", path("eel.xdmf")},
          "--format: xdmf holds a motion, which comes from a recording: mercury run ROBOT --seconds 5 --record run.h5; "
          "for one pose give " +
              format_names(holds_pose));
  refuses({robot_, "-o", path("eel.stl"), "--robot", "eel"},
          "--robot: no robot is named \"eel\"; give a name, or a number from 0 to 0");
}

TEST_F(ExportCommand, WhatARecordingCannotGiveIsOneLine) {
  const std::string file = recording();
  refuses({file, "--robot", "0", "-o", path("eel.stl")},
          "--format: stl holds one pose of a recording; choose its moment (--still), or give " +
              format_names(holds_motion));
  refuses({file, "--robot", "0", "-o", path("eel.glb"), "--from", "3"},
          "--from: 3 is not accepted; the recording has 0 to 0.2 s");
  refuses({file, "--robot", "0", "-o", path("eel.glb"), "--from", "0.1", "--to", "0.02"},
          "--to: 0.02 is before the first moment, 0.1; give a later one");
  refuses({file, "--robot", "0", "-o", path("eel.glb"), "--every", "0"}, "--every: 0 is not accepted; give 1 or more");
  refuses({file, "--robot", "0", "-o", path("eel.glb"), "--still", "nan"},
          "--still: nan is not accepted; the recording has 0 to 0.2 s");
}

TEST_F(ExportCommand, FilesAreReplacedOnlyWithForce) {
  write("eel.mtl", "mine");
  refuses({robot_, "-o", path("eel.obj")},
          "-o: " + path("eel.mtl") + " exists already; use --force to replace it, or give another name");
  EXPECT_EQ(read("eel.mtl"), "mine");
  EXPECT_EQ(mercury({"export", robot_, "-o", path("eel.obj"), "--force"}).status, 0);
  EXPECT_THAT(read("eel.mtl"), HasSubstr("newmtl"));
}

TEST_F(ExportCommand, DryRunWritesNothing) {
  const Outcome outcome = succeeded(mercury({"export", robot_, "-o", path("new/eel.obj"), "--dry-run"}));
  EXPECT_THAT(outcome.output, HasSubstr("nothing was written"));
  EXPECT_THAT(outcome.output, HasSubstr("eel.mtl"));
  EXPECT_THAT(listing(), ElementsAre("robots"));
}

TEST_F(ExportCommand, HelpListsEveryFormat) {
  const std::string help = mercury({"export", "--help"}).output;
  for (const ExportFormat& format : export_formats()) EXPECT_THAT(help, HasSubstr("  " + std::string(format.name)));
}

}  // namespace
}  // namespace mercury::test
