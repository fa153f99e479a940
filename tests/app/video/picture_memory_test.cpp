// SPDX-License-Identifier: Apache-2.0
#include "app/video/picture_memory.h"

#include <gtest/gtest.h>

#include <string>

#include "mercury/error.h"
#include "tests/refusal.h"

namespace mercury::test {
namespace {

std::string refusal(PictureSize size, bool software, std::size_t usable) {
  return mercury::refusal<ParameterError>([&] { require_memory_for_pictures(size, software, usable); });
}

TEST(PictureMemoryTest, TheSizeThatIsOfferedFits) {
  const PictureSize size{15360, 8640};
  for (const bool software : {false, true})
    for (const std::size_t usable : {std::size_t(2) << 30, std::size_t(3) << 30, std::size_t(5) << 30}) {
      const std::string text = refusal(size, software, usable);
      const std::size_t at = text.find("up to ");
      ASSERT_NE(at, text.npos) << text;
      PictureSize offered;
      ASSERT_EQ(std::sscanf(text.c_str() + at, "up to %dx%d", &offered.width, &offered.height), 2) << text;
      EXPECT_EQ(refusal(offered, software, usable), "") << text;
      EXPECT_LE(picture_memory(offered, software), usable);
      EXPECT_GT(picture_memory({offered.width + 64, offered.height + 36}, software), usable) << "smaller than needed";
    }
}

TEST(PictureMemoryTest, SmallPicturesAreAlwaysAccepted) { EXPECT_EQ(refusal({1280, 720}, true, 0), ""); }

TEST(PictureMemoryTest, PicturesInTheHostsMemoryAreLarger) {
  EXPECT_GT(picture_memory({1920, 1080}, true), picture_memory({1920, 1080}, false));
}

}  // namespace
}  // namespace mercury::test
