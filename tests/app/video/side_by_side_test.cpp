// SPDX-License-Identifier: Apache-2.0
#include "app/video/side_by_side.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mercury/error.h"

namespace mercury::test {
namespace {

using render::Image;
using render::PixelFormat;
using testing::ElementsAre;

TEST(Halves, FillThePictureWithEvenWidths) {
  for (const int width : {4, 6, 160, 162, 1278, 1280}) {
    const auto even = columns_of({width, 90});
    ASSERT_EQ(even.size(), 2u);
    EXPECT_EQ(even[0].width + even[1].width, width);
    for (const PictureSize& half : even) {
      EXPECT_EQ(half.width % 2, 0) << width;
      EXPECT_GT(half.width, 0) << width;
      EXPECT_EQ(half.height, 90);
    }
    EXPECT_LE(even[1].width - even[0].width, 2);
  }
  EXPECT_THROW(columns_of({2, 90}), ParameterError);
  const auto three = columns_of({100, 90}, 3);
  EXPECT_EQ(three.size(), 3u);
  EXPECT_EQ(three[0].width + three[1].width + three[2].width, 100);
  for (const PictureSize& column : three) EXPECT_EQ(column.width % 2, 0);
}

TEST(SideBySide, RowsOfColorsFollowEachOther) {
  const std::vector<Image> parts{{1, 2, PixelFormat::rgb, {1, 2, 3, 7, 8, 9}},
                                 {2, 2, PixelFormat::rgb, {11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22}}};
  Image whole;
  join(parts, whole);
  EXPECT_EQ(whole.width, 3);
  EXPECT_EQ(whole.height, 2);
  EXPECT_THAT(whole.bytes, ElementsAre(1, 2, 3, 11, 12, 13, 14, 15, 16, 7, 8, 9, 17, 18, 19, 20, 21, 22));
}

TEST(SideBySide, EachPlaneIsJoinedByItself) {
  // 2x2 and 4x2 pixels: Y, then U and V of half the width and height.
  const std::vector<Image> parts{{2, 2, PixelFormat::yuv420, {1, 2, 3, 4, 50, 60}},
                                 {4, 2, PixelFormat::yuv420, {11, 12, 13, 14, 15, 16, 17, 18, 51, 52, 61, 62}}};
  Image whole;
  join(parts, whole);
  EXPECT_THAT(whole.bytes, ElementsAre(1, 2, 11, 12, 13, 14, 3, 4, 15, 16, 17, 18, 50, 51, 52, 60, 61, 62));
  EXPECT_EQ(whole.bytes.size(), render::image_size(PixelFormat::yuv420, 6, 2));
}

}  // namespace
}  // namespace mercury::test
