// SPDX-License-Identifier: Apache-2.0
#include "app/video/figure.h"

#include <algorithm>
#include <cmath>

namespace mercury {
namespace {

// The light of each code of a byte.
const std::array<float, 256>& light_of_code() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> light{};
    for (int i = 0; i < 256; ++i)
      light[static_cast<std::size_t>(i)] = render::linear_of({static_cast<std::uint8_t>(i), 0, 0, 255})[0];
    return light;
  }();
  return table;
}

struct Pixel {
  std::array<float, 3> own{}, left{};  // light of bodies; share of the backdrop that is left
};

constexpr std::array everything{1.0f, 1.0f, 1.0f};

// Drawing rounds and dithers by about one code, so that shares are off by a hundredth.
constexpr float noise = 0.02f;

Pixel pixel_of(const std::array<render::Image, 2>& pictures, std::size_t at) {
  Pixel pixel;
  const auto [dark, bright] = figure_backdrops;
  for (std::size_t channel = 0; channel < 3; ++channel) {
    const float low = light_of_code()[pictures[0].bytes[at + channel]],
                high = light_of_code()[pictures[1].bytes[at + channel]];
    float left = std::clamp((high - low) / (bright - dark), 0.0f, 1.0f);
    if (left < noise) left = 0;
    if (left > 1 - noise) left = 1;
    pixel.left[channel] = left;
    // The mean of both has less noise.
    pixel.own[channel] = left == 1 ? 0 : std::max(0.0f, 0.5f * (low + high - left * (dark + bright)));
  }
  return pixel;
}

std::uint8_t code_of(float light) { return render::color_of_linear({light, 0, 0}).r; }

}  // namespace

render::Image matted(const std::array<render::Image, 2>& pictures, render::Color background) {
  const bool transparent = background.a == 0;
  render::Image image{.width = pictures[0].width,
                      .height = pictures[0].height,
                      .format = transparent ? render::PixelFormat::rgba : render::PixelFormat::rgb,
                      .bytes = {}};
  image.bytes.reserve(render::image_size(image.format, image.width, image.height));
  const std::array<float, 3> light = render::linear_of(background);
  std::vector<std::uint8_t> nothing(4, 0);
  if (!transparent) nothing = {background.r, background.g, background.b};
  for (std::size_t at = 0; at + 2 < pictures[0].bytes.size(); at += 3) {
    const Pixel pixel = pixel_of(pictures, at);
    if (pixel.left == everything) {
      image.bytes.insert(image.bytes.end(), nothing.begin(), nothing.end());
      continue;
    }
    if (!transparent) {
      for (std::size_t channel = 0; channel < 3; ++channel)
        image.bytes.push_back(code_of(pixel.own[channel] + pixel.left[channel] * light[channel]));
      continue;
    }
    std::array<float, 3> over_black{};
    float opacity = 0;
    for (std::size_t channel = 0; channel < 3; ++channel) {
      over_black[channel] = code_of(pixel.own[channel]);
      const float over_white = code_of(pixel.own[channel] + pixel.left[channel]);
      opacity = std::max(opacity, 1 - (over_white - over_black[channel]) / 255);
    }
    for (const float code : over_black)
      image.bytes.push_back(static_cast<std::uint8_t>(opacity > 0 ? std::lround(std::min(255.0f, code / opacity)) : 0));
    image.bytes.push_back(static_cast<std::uint8_t>(std::lround(255 * opacity)));
  }
  return image;
}

PixelBox content_of(const std::array<render::Image, 2>& pictures, int margin) {
  const int width = pictures[0].width, height = pictures[0].height;
  PixelBox box{width, height, 0, 0};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const Pixel pixel = pixel_of(
          pictures, 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)));
      if (pixel.left == everything) continue;
      box = {std::min(box.left, x), std::min(box.top, y), std::max(box.right, x + 1), std::max(box.bottom, y + 1)};
    }
  if (box.left >= box.right) return {0, 0, width, height};
  return {std::max(0, box.left - margin), std::max(0, box.top - margin), std::min(width, box.right + margin),
          std::min(height, box.bottom + margin)};
}

PixelBox joined(PixelBox box, const render::Overlay& text, int margin, PictureSize picture) {
  for (const render::OverlayQuad& quad : text.quads()) {
    const render::Rectangle& area = quad.rectangle;
    box = {std::min(box.left, static_cast<int>(area.x) - margin), std::min(box.top, static_cast<int>(area.y) - margin),
           std::max(box.right, static_cast<int>(std::ceil(area.x + area.width)) + margin),
           std::max(box.bottom, static_cast<int>(std::ceil(area.y + area.height)) + margin)};
  }
  return {std::max(0, box.left), std::max(0, box.top), std::min(picture.width, box.right),
          std::min(picture.height, box.bottom)};
}

render::Image cropped(const render::Image& image, PixelBox box) {
  const std::ptrdiff_t size = image.format == render::PixelFormat::rgba ? 4 : 3;
  render::Image part{
      .width = box.right - box.left, .height = box.bottom - box.top, .format = image.format, .bytes = {}};
  for (int y = box.top; y < box.bottom; ++y) {
    const auto first = image.bytes.begin() + size * (std::ptrdiff_t{y} * image.width + box.left);
    part.bytes.insert(part.bytes.end(), first, first + size * part.width);
  }
  return part;
}

}  // namespace mercury
