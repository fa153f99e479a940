// SPDX-License-Identifier: Apache-2.0
// mercury info: descriptions of files and of the machine.
#include <gmock/gmock.h>

#include "tests/app/program.h"

namespace mercury::test {
namespace {

using testing::HasSubstr;

class InfoCommand : public FolderTest {};

TEST_F(InfoCommand, DescribesAFile) {
  // One voxel has 8 masses, a spring per pair of them (28), and 6 sides of two triangles.
  ASSERT_EQ(mercury({"new", "voxel", "--voxels", "1x1x1", "--air", "0", "--symmetry", "none", "-o", path("cube.json")})
                .status,
            0);
  const Outcome outcome = mercury({"info", path("cube.json")});
  EXPECT_EQ(outcome.status, 0) << outcome.messages;
  EXPECT_THAT(outcome.output, testing::ContainsRegex("masses +8\n"));
  EXPECT_THAT(outcome.output, testing::ContainsRegex("springs +28, "));
  EXPECT_THAT(outcome.output, HasSubstr("closed, Euler characteristic 2, 0.06 m2, 0.001 m3"));
  EXPECT_THAT(outcome.output, testing::ContainsRegex("faces +12"));
  EXPECT_THAT(outcome.output, testing::ContainsRegex("size +0.1 x 0.1 x 0.1 m\n"));
  // One tile of 32 masses with 36 bytes each, 256 materials at 8, 256 rest lengths at 4, and 16.
  EXPECT_THAT(outcome.output, HasSubstr("needs 4.1 kB of a CUDA block's memory in water: fits every CUDA device"));
}

TEST_F(InfoCommand, ListsNamedActuators) {
  write("chain.json", R"({"format":"mercury-robot","version":1,"masses":[[0,0,0],[1,0,0],[2,0,0],[3,0,0]],"faces":[],
    "springs":[[0,1,1],[1,2,2],[2,3,1]],"actuators":[{"name":"ends","materials":[1,3]},{"name":"mid","springs":[1]}]})");
  const Outcome outcome = mercury({"info", path("chain.json")});
  EXPECT_EQ(outcome.status, 0) << outcome.messages;
  EXPECT_THAT(outcome.output, testing::ContainsRegex("actuators +ends: 2 springs of material 1, 3\n"
                                                     " +mid: 1 spring of material 2\n"));
  ASSERT_EQ(mercury({"run", path("chain.json"), "--seconds", "0.01", "--record", path("chain.h5")}).status, 0);
  EXPECT_THAT(mercury({"info", path("chain.h5")}).output,
              HasSubstr("chain: 4 masses, 3 springs, 0 faces, 2 actuators"));
}

TEST_F(InfoCommand, WithoutAFileDescribesTheMachine) {
  const Outcome outcome = mercury({"info"});
  EXPECT_EQ(outcome.status, 0);
  for (const char* what : {"processor", "memory", "GPU", "drawing (egl)", "drawing (osmesa)", "encoder"})
    EXPECT_THAT(outcome.output, HasSubstr(what));
  EXPECT_THAT(outcome.output, HasSubstr("writes .mp4 .webm .gif"));
}

TEST_F(InfoCommand, AdvisesOnAMissingEncoder) {
  const Outcome outcome = mercury({"info", "--ffmpeg", path("none")});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.output, HasSubstr(path("none") + " does not run"));
  EXPECT_THAT(outcome.output, HasSubstr("apt install ffmpeg"));
}

TEST_F(InfoCommand, BadFileIsBadInput) {
  write("a.json", "{}");
  const Outcome outcome = mercury({"info", path("a.json")});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.messages, testing::StartsWith("mercury: " + path("a.json") + ": "));
}

}  // namespace
}  // namespace mercury::test
