// SPDX-License-Identifier: Apache-2.0
// Stills for papers: robots, their shadows and text alone, over a color or over nothing; and text as text (SVG, PDF).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/video/frame_writer.h"
#include "render/text/overlay.h"

namespace mercury {

// The light of the two backdrops over which a figure is drawn (render::Scene::flat_backdrop); below the tone curve's
// bend, so that it comes out as it is.
inline constexpr std::array<float, 2> figure_backdrops{0.02f, 0.5f};

// What both pictures of one scene have in common, over `background`; where that has no opacity, rgba. A pixel is
//
//   c + t backdrop     in linear light: what bodies give, and how much of the backdrop they and their shadows leave
//
// so c and t follow from two backdrops. Transparent pixels are such that they look the same over white and over black
// where programs blend bytes, as almost all do.
render::Image matted(const std::array<render::Image, 2>& pictures, render::Color background);

// In pixels from the upper left corner; the upper left one belongs to it, the lower right one does not.
struct PixelBox {
  int left = 0, top = 0, right = 0, bottom = 0;
};
// What differs from the backdrop in pictures as those of matted(), and `margin` pixels around it; the whole picture if
// nothing does.
PixelBox content_of(const std::array<render::Image, 2>& pictures, int margin);
PixelBox joined(PixelBox box, const render::Overlay& text, int margin, PictureSize picture);
render::Image cropped(const render::Image& image, PixelBox box);

// The part of a picture as a document, with what is written on it as text, boxes and scales that a drawing program can
// change: SVG, or PDF of one page. `dpi`: of the picture [pixels per inch]; 0 = 96, as browsers have it.
struct Figure {
  const render::Image& image;
  const render::Overlay& text;
  PixelBox box;
  double dpi = 0;
  std::string_view comment;
};
std::string figure_svg(const Figure& figure);
std::string figure_pdf(const Figure& figure);

// Keeps the last frame.
class PictureKeeper final : public FrameWriter {
 public:
  void write(const render::Image& frame) override { picture_ = frame; }
  void finish() override {}
  std::string description() const override { return "a picture"; }
  const render::Image& picture() const { return picture_; }

 private:
  render::Image picture_;
};

}  // namespace mercury
