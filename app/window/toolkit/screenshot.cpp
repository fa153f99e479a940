// SPDX-License-Identifier: Apache-2.0
#include "app/window/toolkit/screenshot.h"

#include <epoxy/gl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <ctime>

#include "render/png.h"

namespace mercury::window {

render::Image read_window(WindowSize pixels, render::PixelFormat format) {
  const int channels = format == render::PixelFormat::rgba ? 4 : 3;
  const auto row = static_cast<std::size_t>(channels) * static_cast<std::size_t>(pixels.width);
  render::Image image{pixels.width, pixels.height, format, {}};
  image.bytes.resize(row * static_cast<std::size_t>(pixels.height));
  glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, pixels.width, pixels.height, channels == 4 ? GL_RGBA : GL_RGB, GL_UNSIGNED_BYTE,
               image.bytes.data());
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  for (int upper = 0, lower = pixels.height - 1; upper < lower; ++upper, --lower)
    std::swap_ranges(image.bytes.begin() + upper * static_cast<std::ptrdiff_t>(row),
                     image.bytes.begin() + (upper + 1) * static_cast<std::ptrdiff_t>(row),
                     image.bytes.begin() + lower * static_cast<std::ptrdiff_t>(row));
  return image;
}

std::filesystem::path unused_path(const std::filesystem::path& folder, const std::string& extension) {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  const std::string name = fmt::format("mercury-{:%Y-%m-%d-%H%M%S}", local);
  std::filesystem::path path = folder / (name + extension);
  std::error_code ignored;
  for (int number = 2; std::filesystem::exists(path, ignored); ++number)
    path = folder / fmt::format("{}-{}{}", name, number, extension);
  return path;
}

void Screenshot::take(render::Image image, const std::filesystem::path& path) {
  if (busy()) return;
  path_ = path;
  written_ = std::async(std::launch::async, [image = std::move(image), path]() -> std::string {
    try {
      render::write_png(path.string(), image);
      return "";
    } catch (const std::exception& error) {
      return error.what();
    }
  });
}

bool Screenshot::done(std::filesystem::path& path, std::string& error) {
  if (!busy() || written_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
  error = written_.get();
  path = error.empty() ? path_ : std::filesystem::path();
  return true;
}

}  // namespace mercury::window
