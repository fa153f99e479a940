// SPDX-License-Identifier: Apache-2.0
// Motions that voxcraft-sim recorded: masses are the corners of its voxels.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "tests/robots/importers/documents.h"

namespace mercury {
namespace {

constexpr const char* head =
    "1 GPU found.\n"
    "{{{setting}}}<rescale>0.001</rescale>\n"
    "{{{setting}}}<voxel_size>0.010000</voxel_size>\n"
    "real_stepsize: 42 ; recommendedTimeStep 0.000265; d_v3->DtFrac 0.900000 . \n";

// Voxels of 10 mm. The lengths are in mm, the turn in degrees around an axis.
std::string voxel(double x, double y, double z, const std::string& turn, double half_x, int material) {
  const auto number = [](double value) { return std::to_string(value) + ","; };
  return number(x) + number(y) + number(z) + turn + number(-half_x) + "-5.0,-5.0," + number(half_x) + "5.0,5.0," +
         std::to_string(material) + ",0.0,;";
}

// Two voxels side by side along x, and one apart.
std::string frame(int step, double time, const std::string& first, const std::string& second,
                  const std::string& third) {
  return "<<<Step" + std::to_string(step) + " Time:" + std::to_string(time) + ">>>" + first + second + third +
         "<<<>>>\n";
}

const std::string still = "0.0,0.00,0.00,0.00,";
const std::string at_rest =
    frame(0, 0.001, voxel(0, 0, 0, still, 5, 1), voxel(10, 0, 0, still, 5, 3), voxel(50, 0, 20, still, 5, 1));

Import history(const std::string& frames) { return import_text(head + frames, "history", "bot"); }

TEST(History, VoxelsBecomeBodiesAtTenTimesTheirSize) {
  const Import import = history(at_rest);
  EXPECT_EQ(import.report.robots, (std::vector<std::string>{"bot", "bot-2"}));
  EXPECT_EQ(import.robots[0].masses.size(), 12u);
  EXPECT_EQ(import.robots[1].masses.size(), 8u);
  EXPECT_DOUBLE_EQ(import.report.length_scale, 10);
  ASSERT_TRUE(import.motion);
  ASSERT_EQ(import.motion->positions.size(), 1u);
  const auto [low, high] = std::ranges::minmax(import.robots[0].masses, {}, &Vec3::x);
  EXPECT_NEAR(low.x, -0.05, 1e-6);
  EXPECT_NEAR(high.x, 0.15, 1e-6);
  EXPECT_NEAR(std::ranges::min(import.robots[0].masses, {}, &Vec3::z).z, 0, 1e-6);  // on the floor
  EXPECT_EQ(import.robots[0].material_names, (std::vector<std::string>{"air", "material 1", "material 3"}));
}

TEST(History, VoxelsThatGoTooFarAwayAreRefused) {
  for (const double x : {1e20, 1e300, -1e300}) {
    const std::string far =
        frame(42, 0.011, voxel(x, 0, 0, still, 5, 1), voxel(10, 0, 0, still, 5, 3), voxel(50, 0, 20, still, 5, 1));
    EXPECT_EQ(refusal_of(head + at_rest + far, "history"), "a voxel is too far away");
  }
}

// The first voxel is stretched to 12 mm along its own x axis, and turned by 90 degrees around z.
TEST(History, CornersAreTurnedAndSharedOnesAreMeans) {
  const Import import = history(at_rest + frame(42, 0.011, voxel(1, 0, 0, "90.0,0.00,0.00,0.71,", 6, 1),
                                                voxel(10, 0, 0, still, 5, 3), voxel(50, 0, 20, still, 5, 1)));
  ASSERT_EQ(import.motion->positions.size(), 2u);
  EXPECT_NEAR(import.motion->times[1] - import.motion->times[0], 0.01 * import.report.time_scale, 1e-9);
  const auto& before = import.motion->positions[0];
  const auto& after = import.motion->positions[1];
  for (std::size_t mass = 0; mass < 12; ++mass) {
    const Vec3 p = before[mass], q = after[mass];
    // In units of the first voxel's corners, which are at -1 or 1 before; at 3 are those of the second voxel alone.
    const int x = static_cast<int>(std::lround(p.x / 0.05)), y = static_cast<int>(std::lround(p.y / 0.05));
    const double own_x = 0.01 - 0.05 * y, own_y = 0.06 * x;  // a corner (x, y) of the turned voxel
    const double other_x = 0.05, other_y = 0.05 * y;         // the same corner of the second one
    const Vec3 expected =
        x < 0   ? Vec3{static_cast<float>(own_x), static_cast<float>(own_y), p.z}
        : x > 1 ? p
                : Vec3{static_cast<float>((own_x + other_x) / 2), static_cast<float>((own_y + other_y) / 2), p.z};
    EXPECT_NEAR(q.x, expected.x, 1e-5) << mass;
    EXPECT_NEAR(q.y, expected.y, 1e-5) << mass;
    EXPECT_NEAR(q.z, expected.z, 1e-5) << mass;
  }
}

TEST(History, EndsWhereVoxelsComeOrGo) {
  const Import import = history(at_rest + "<<<Step42 Time:0.011>>>" + voxel(0, 0, 0, still, 5, 1) + "<<<>>>\n");
  EXPECT_EQ(import.motion->times.size(), 1u);
  EXPECT_NE(import.report.decisive.at(0).find("where voxels come or go"), std::string::npos);
}

TEST(History, AFrameThatBreaksOffIsLeftOut) {
  const std::string text = at_rest + at_rest.substr(0, at_rest.size() - 40);
  EXPECT_EQ(history(text).motion->times.size(), 1u);
}

TEST(BadHistory, IsRefusedWithItsLine) {
  const auto refusal = [](const std::string& text) { return refusal_of(text, "history"); };
  EXPECT_EQ(refusal(""), "holds no frame with voxels (<<<Step...>>>)");
  EXPECT_EQ(refusal(at_rest), "does not say the size of its voxels (<voxel_size>)");
  EXPECT_EQ(refusal(head + at_rest + at_rest), "line 6: times do not rise");
  EXPECT_EQ(refusal(std::string(head) + "<<<Step0 Time:0>>>1,2,3;<<<>>>\n"), "line 5: a voxel is not 14 numbers");
  EXPECT_EQ(refusal(std::string(head) + "<<<Step0>>>1,2,3;<<<>>>\n"), "line 5: the frame has no time");
  EXPECT_EQ(refusal(head + frame(0, 1, voxel(0, 0, 0, still, 5, 1), voxel(1, 0, 0, still, 5, 1), "")),
            "two voxels of the first frame are at one place");
  EXPECT_EQ(refusal(head + frame(0, 1, voxel(1e12, 0, 0, still, 5, 1), "", "")), "a voxel is too far away");
}

}  // namespace
}  // namespace mercury
