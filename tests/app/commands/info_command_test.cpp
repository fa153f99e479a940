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
