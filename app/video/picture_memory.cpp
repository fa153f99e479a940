// SPDX-License-Identifier: Apache-2.0
#include "app/video/picture_memory.h"

#include <fmt/format.h>

#include <cmath>

#include "mercury/error.h"
#include "mercury/host_memory.h"

namespace mercury {
namespace {

constexpr std::size_t frames = 14;                    // waiting, spare and being read back (video_stages.h)
constexpr std::size_t bytes_per_pixel = 3;            // of a frame
constexpr std::size_t texels_per_pixel = 90;          // of the renderer [bytes]
constexpr std::size_t software_renderer = 200 << 20;  // shaders, compiled, and its threads [bytes]

double pixels(PictureSize size) { return static_cast<double>(size.width) * static_cast<double>(size.height); }

}  // namespace

std::size_t picture_memory(PictureSize size, bool software) {
  const std::size_t per_pixel = frames * bytes_per_pixel + (software ? texels_per_pixel : 0);
  return static_cast<std::size_t>(pixels(size)) * per_pixel + (software ? software_renderer : 0);
}

void require_memory_for_pictures(PictureSize size, bool software, std::size_t usable) {
  constexpr double small = 1 << 20;  // [pixels]
  const std::size_t needed = picture_memory(size, software), fixed = picture_memory({0, 0}, software);
  if (needed <= usable || pixels(size) <= small) return;
  const double share = usable <= fixed ? 0 : static_cast<double>(usable - fixed) / static_cast<double>(needed - fixed);
  const double scale = std::max(std::sqrt(share), std::sqrt(small / pixels(size)));
  const auto even = [scale](int side) { return std::max(2, static_cast<int>(scale * side) / 2 * 2); };
  throw ParameterError("size",
                       memory_line(needed, usable, fmt::format("up to {}x{}", even(size.width), even(size.height))));
}

}  // namespace mercury
