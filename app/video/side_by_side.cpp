// SPDX-License-Identifier: Apache-2.0
#include "app/video/side_by_side.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "mercury/error.h"

namespace mercury {
namespace {

// A rectangle of bytes in an image: all of it, or one of the planes of yuv420.
struct PixelPlane {
  std::size_t begin, row_bytes, rows;
};

std::vector<PixelPlane> planes_of(const render::Image& image) {
  const auto width = static_cast<std::size_t>(image.width), height = static_cast<std::size_t>(image.height);
  if (image.format != render::PixelFormat::yuv420)
    return {{0, (image.format == render::PixelFormat::rgb ? 3 : 4) * width, height}};
  const std::size_t bright = width * height, tint = bright / 4;
  return {{0, width, height}, {bright, width / 2, height / 2}, {bright + tint, width / 2, height / 2}};
}

}  // namespace

std::vector<PictureSize> columns_of(PictureSize whole, int columns) {
  const int width = whole.width / (2 * columns) * 2;
  if (width == 0)
    throw ParameterError("size", fmt::format("{}x{} is not accepted; {} sides need at least {} pixels across",
                                             whole.width, whole.height, columns, 2 * columns));
  std::vector<PictureSize> sizes(static_cast<std::size_t>(columns), PictureSize{width, whole.height});
  sizes.back().width = whole.width - (columns - 1) * width;
  return sizes;
}

void join(std::span<const render::Image> parts, render::Image& into) {
  into.format = parts.front().format;
  into.height = parts.front().height;
  into.width = 0;
  for (const render::Image& part : parts) into.width += part.width;
  into.bytes.resize(render::image_size(into.format, into.width, into.height));
  const std::vector<PixelPlane> whole = planes_of(into);
  std::vector<std::size_t> filled(whole.size(), 0);  // bytes of each row
  for (const render::Image& part : parts) {
    const std::vector<PixelPlane> planes = planes_of(part);
    for (std::size_t p = 0; p < planes.size(); ++p) {
      for (std::size_t row = 0; row < planes[p].rows; ++row)
        std::copy_n(
            part.bytes.begin() + static_cast<std::ptrdiff_t>(planes[p].begin + row * planes[p].row_bytes),
            planes[p].row_bytes,
            into.bytes.begin() + static_cast<std::ptrdiff_t>(whole[p].begin + row * whole[p].row_bytes + filled[p]));
      filled[p] += planes[p].row_bytes;
    }
  }
}

}  // namespace mercury
