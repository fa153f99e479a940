// SPDX-License-Identifier: Apache-2.0
// Screenshots of the window.
#pragma once

#include <filesystem>
#include <future>
#include <string>

#include "app/window/toolkit/window.h"
#include "render/readback.h"

namespace mercury::window {

// Reads the window's framebuffer, top row first. Call before the buffers are swapped.
render::Image read_window(WindowSize pixels, render::PixelFormat format = render::PixelFormat::rgb);

// A path in `folder` that no file has yet: "mercury-2026-01-31-120501.png".
std::filesystem::path unused_path(const std::filesystem::path& folder, const std::string& extension);

// Writes a PNG file on a background thread.
class Screenshot {
 public:
  void take(render::Image image, const std::filesystem::path& path);
  bool busy() const { return written_.valid(); }
  // Returns true once, when the file is written or has failed. `error` is empty on success, `path` on failure.
  bool done(std::filesystem::path& path, std::string& error);

 private:
  std::filesystem::path path_;
  std::future<std::string> written_;  // the error message; empty = success
};

}  // namespace mercury::window
