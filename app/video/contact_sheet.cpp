// SPDX-License-Identifier: Apache-2.0
#include "app/video/contact_sheet.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/video/picture_file.h"
#include "mercury/error.h"
#include "mercury/robot_file.h"

namespace mercury {

PictureSize size_of_sheet(Grid grid, PictureSize frame, int gap) {
  const auto side = [&](int cells, int pixels) { return std::int64_t{cells} * (std::int64_t{pixels} + gap) - gap; };
  const std::int64_t width = side(grid.columns, frame.width), height = side(grid.rows, frame.height);
  if (width < 1 || height < 1 || width > 32768 || height > 32768)
    throw ParameterError(
        "size", fmt::format("the picture would be {}x{}; give a size that leads to 1x1 to 32768x32768", width, height));
  return {static_cast<int>(width), static_cast<int>(height)};
}

void require_picture_name(const std::string& output) {
  if (extension_of(output) != ".png")
    throw ParameterError("output", output + ": a picture is written as .png; give such a name");
}

ContactSheet::ContactSheet(const std::string& output, Grid grid, PictureSize frame, int gap, std::string comment,
                           double dpi)
    : output_(output), comment_(std::move(comment)), grid_(grid), frame_(frame), gap_(gap), dpi_(dpi) {
  require_picture_name(output);
  const auto [width, height] = size_of_sheet(grid, frame, gap);
  make_parent_folder(output);
  sheet_ = {.width = width, .height = height, .format = render::PixelFormat::rgb, .bytes = {}};
  sheet_.bytes.assign(render::image_size(sheet_.format, width, height), 0x10);
}

void ContactSheet::write(const render::Image& frame) {
  const int left = count_ % grid_.columns * (frame_.width + gap_),
            top = count_ / grid_.columns * (frame_.height + gap_);
  if (top + frame_.height > sheet_.height) return;
  const auto row_bytes = static_cast<std::ptrdiff_t>(3 * frame_.width);
  for (int row = 0; row < frame_.height; ++row) {
    const std::ptrdiff_t to = 3 * (static_cast<std::ptrdiff_t>(top + row) * sheet_.width + left);
    std::copy_n(frame.bytes.begin() + row * row_bytes, row_bytes, sheet_.bytes.begin() + to);
  }
  ++count_;
}

void ContactSheet::finish() { write_picture(output_, sheet_, comment_, dpi_); }

std::string ContactSheet::description() const {
  return grid_.columns * grid_.rows == 1 ? "a PNG picture"
                                         : fmt::format("a PNG picture of {}x{} moments", grid_.columns, grid_.rows);
}

}  // namespace mercury
