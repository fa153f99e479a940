// SPDX-License-Identifier: Apache-2.0
#include "render/png.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "tests/folder.h"

namespace mercury::render {
namespace {

class Png : public test::TestWithFolder {};

TEST_F(Png, ReadsWhatItWrote) {
  Image image{3, 2, PixelFormat::rgb, {}};
  for (int i = 0; i < 18; ++i) image.bytes.push_back(std::uint8_t(13 * i));
  const std::string path = folder_ / "a.png";
  write_png(path, image);
  const Image back = read_png(path);
  EXPECT_EQ(back.width, 3);
  EXPECT_EQ(back.height, 2);
  EXPECT_EQ(back.bytes, image.bytes);
}

TEST_F(Png, ACommentIsATextThatReadersSkip) {
  const Image image{2, 1, PixelFormat::rgb, {1, 2, 3, 4, 5, 6}};
  const std::vector<std::uint8_t> plain = png_bytes(image), with_comment = png_bytes(image, "paper physics");
  constexpr std::string_view chunk("\0\0\0\x15tEXtComment\0paper physics", 29);
  EXPECT_EQ(with_comment.size(), plain.size() + chunk.size() + 4);
  EXPECT_FALSE(std::ranges::search(with_comment, chunk).empty());
  const std::string path = folder_ / "a.png";
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(with_comment.data()), static_cast<std::streamsize>(with_comment.size()));
  EXPECT_EQ(read_png(path).bytes, image.bytes);  // libpng checks the checksum
}

TEST_F(Png, LeavesNothingBehindWhenItCannotWrite) {
  const Image image{1, 1, PixelFormat::rgb, {1, 2, 3}};
  const std::string path = folder_ / "missing" / "a.png";
  EXPECT_THAT([&] { write_png(path, image); },
              testing::ThrowsMessage<std::runtime_error>(path + ": No such file or directory"));
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

TEST_F(Png, PlanarPicturesThrow) {
  EXPECT_THROW(write_png(folder_ / "a.png", Image{2, 2, PixelFormat::yuv420, {0, 0, 0, 0, 0, 0}}),
               std::invalid_argument);
}

}  // namespace
}  // namespace mercury::render
