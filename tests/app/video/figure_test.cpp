// SPDX-License-Identifier: Apache-2.0
// What two pictures of a scene over two backdrops say about it.
#include "app/video/figure.h"

#include <gmock/gmock.h>
#include <zlib.h>

#include "app/base/output_files.h"
#include "app/video/picture_file.h"
#include "mercury/file_links.h"
#include "tests/app/program.h"

namespace mercury::test {
namespace {

using testing::HasSubstr;

// What a pixel shows: light of its own, and the share of the backdrop that it leaves.
struct Seen {
  float own, left;
};

std::array<render::Image, 2> drawn(const std::vector<Seen>& pixels) {
  std::array<render::Image, 2> pictures;
  for (std::size_t i = 0; i < 2; ++i) {
    pictures.at(i) = {.width = static_cast<int>(pixels.size()), .height = 1, .bytes = {}};
    for (const Seen& pixel : pixels) {
      const float light = pixel.own + pixel.left * figure_backdrops.at(i);
      const render::Color color = render::color_of_linear({light, light, light});
      pictures.at(i).bytes.insert(pictures.at(i).bytes.end(), {color.r, color.g, color.b});
    }
  }
  return pictures;
}

// Nothing, a body, its shadow, an edge of the body.
const std::vector<Seen> scene{{0, 1}, {0.4f, 0}, {0, 0.3f}, {0.2f, 0.5f}};

TEST(Figure, OverAColorIsWhatThatBackdropWouldGive) {
  for (const render::Color background : {render::Color{}, render::rgb(0x000000), render::rgb(0x3070c0)}) {
    const render::Image image = matted(drawn(scene), background);
    ASSERT_EQ(image.format, render::PixelFormat::rgb);
    const auto light = render::linear_of(background);
    for (std::size_t i = 0; i < scene.size(); ++i)
      for (std::size_t channel = 0; channel < 3; ++channel) {
        const float expected = scene[i].own + scene[i].left * light[channel];
        EXPECT_NEAR(image.bytes[3 * i + channel], render::color_of_linear({expected, 0, 0}).r, 4) << i;
      }
  }
  EXPECT_EQ(matted(drawn(scene), {}).bytes[0], 255);  // exactly the background where nothing is
}

TEST(Figure, TransparentPixelsLookTheSameOverBlackAndOverWhite) {
  const auto pictures = drawn(scene);
  const render::Image image = matted(pictures, {0, 0, 0, 0});
  ASSERT_EQ(image.format, render::PixelFormat::rgba);
  const render::Image white = matted(pictures, {}), black = matted(pictures, render::rgb(0x000000));
  for (std::size_t i = 0; i < scene.size(); ++i) {
    const float opacity = static_cast<float>(image.bytes[4 * i + 3]) / 255;
    for (std::size_t channel = 0; channel < 3; ++channel) {
      const float own = opacity * static_cast<float>(image.bytes[4 * i + channel]);
      EXPECT_NEAR(own, black.bytes[3 * i + channel], 1.5);
      EXPECT_NEAR(own + 255 * (1 - opacity), white.bytes[3 * i + channel], 1.5);
    }
  }
  EXPECT_EQ(image.bytes[3], 0);
  EXPECT_EQ(image.bytes[7], 255);
}

TEST(Figure, IsCutOffAroundWhatItShows) {
  std::vector<Seen> row(20, Seen{0, 1});
  row[8] = {0.4f, 0};
  row[10] = {0, 0.5f};
  const PixelBox box = content_of(drawn(row), 2);
  EXPECT_EQ(box.left, 6);
  EXPECT_EQ(box.right, 13);
  EXPECT_EQ(cropped(matted(drawn(row), {}), box).width, 7);
  EXPECT_EQ(content_of(drawn(std::vector<Seen>(5, Seen{0, 1})), 2).right, 5);  // nothing to see: all of it
}

TEST(Figure, TextOfAnSvgIsText) {
  render::Overlay text(640, 480, 0, render::style_of(render::Surroundings::none, render::Theme::light));
  text.caption("A < B & C");
  text.legend({.title = "strain", .scale = render::Scale{}});
  const render::Image image{.width = 640, .height = 480, .bytes = std::vector<std::uint8_t>(640 * 480 * 3, 200)};
  const std::string svg = figure_svg({image, text, {10, 0, 640, 480}, 300, "a \"comment\""});
  EXPECT_THAT(svg, HasSubstr("width=\"2.1in\" height=\"1.6in\" viewBox=\"10 0 630 480\""));
  EXPECT_THAT(svg, HasSubstr(">A &lt; B &amp; C</text>"));
  EXPECT_THAT(svg, HasSubstr(">strain</text>"));
  EXPECT_THAT(svg, HasSubstr("<desc>a &quot;comment&quot;</desc>"));
  EXPECT_THAT(svg, HasSubstr("url(#scale-1)"));
  EXPECT_THAT(svg, HasSubstr("data:image/png;base64,iVBORw0KGgo"));
}

std::string inflated(std::string_view packed, std::size_t most) {
  std::string content(most, '\0');
  uLongf size = most;
  EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(content.data()), &size, reinterpret_cast<const Bytef*>(packed.data()),
                       packed.size()),
            Z_OK);
  content.resize(size);
  return content;
}

// The objects of a file, by the offsets of its table.
std::vector<std::string> objects_of(const std::string& pdf) {
  const std::size_t table = std::stoul(pdf.substr(pdf.rfind("startxref") + 10));
  EXPECT_EQ(pdf.substr(table, 5), "xref\n");
  const std::size_t count = std::stoul(pdf.substr(table + 7));
  std::vector<std::string> objects(1);
  for (std::size_t i = 1; i < count; ++i) {
    const std::size_t entry = pdf.find('\n', table + 5) + 1 + 20 * i, at = std::stoul(pdf.substr(entry, 10));
    const std::string head = std::to_string(i) + " 0 obj\n";
    EXPECT_EQ(pdf.substr(at, head.size()), head);
    objects.push_back(pdf.substr(at + head.size(), pdf.find("endobj", at) - at - head.size()));
  }
  return objects;
}

TEST(Figure, APdfHoldsThePictureItsOpacitiesAndTextAsText) {
  render::Overlay text(40, 30, 8, render::style_of(render::Surroundings::none, render::Theme::light));
  text.caption("A (b) \xc2\xb5m");
  text.legend({.title = "strain", .scale = render::Scale{}});
  render::Image image{.width = 40, .height = 30, .format = render::PixelFormat::rgba, .bytes = {}};
  for (std::uint8_t i = 0; image.bytes.size() < 40 * 30 * 4; ++i) image.bytes.push_back(i);
  const std::string pdf = figure_pdf({image, text, {10, 0, 40, 30}, 144, "made by a test"});
  ASSERT_TRUE(pdf.starts_with("%PDF-1.4\n"));
  EXPECT_TRUE(pdf.ends_with("%%EOF\n"));
  std::string drawing;
  int pictures = 0;
  for (const std::string& object : objects_of(pdf)) {
    const std::size_t begin = object.find("stream\n");
    if (object.find("/MediaBox") != std::string::npos) {
      EXPECT_THAT(object, HasSubstr("/MediaBox [0 0 15 15]"));
    }
    if (begin == std::string::npos) continue;
    const std::string content = inflated(
        std::string_view(object).substr(begin + 7, object.rfind("\nendstream") - begin - 7), std::size_t{1} << 20);
    if (object.find("/Subtype /Image") == std::string::npos) {
      if (content.find("BT") != std::string::npos) drawing = content;
      continue;
    }
    ++pictures;
    const std::size_t channels = object.find("/DeviceGray") == std::string::npos ? 3 : 1;
    ASSERT_EQ(content.size(), 30u * 30 * channels);
    // The first pixel of the second row of the part is the 50th of the picture.
    EXPECT_EQ(static_cast<std::uint8_t>(content[30 * channels]), image.bytes[4 * 50 + (channels == 1 ? 3 : 0)]);
  }
  EXPECT_EQ(pictures, 2);
  EXPECT_THAT(drawing, HasSubstr("(A \\(b\\) \xb5m) Tj"));
  EXPECT_THAT(drawing, HasSubstr("(strain) Tj"));
  EXPECT_THAT(drawing, HasSubstr(" sh Q"));
}

// As in outputs.md: the first to finish has the name.
class PictureFile : public FolderTest {};

TEST_F(PictureFile, ANewPictureIsNotReplacedByTheSecondToFinish) {
  OutputFiles outputs(false, false);
  outputs.add_stream("-o", path("a.png"));
  outputs.check();
  write("a.png", "theirs");
  const render::Image image{.width = 1, .height = 1, .bytes = {1, 2, 3}};
  EXPECT_THROW(write_picture(path("a.png"), image), NameTaken);
  EXPECT_EQ(read("a.png"), "theirs");
  EXPECT_THAT(read("a-2.png"), HasSubstr("IHDR"));
  EXPECT_EQ(listing(), (std::vector<std::string>{"a-2.png", "a.png"}));
}

}  // namespace
}  // namespace mercury::test
