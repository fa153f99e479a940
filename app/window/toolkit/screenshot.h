// SPDX-License-Identifier: Apache-2.0
// Pictures of the window as it is.
#pragma once

#include <filesystem>
#include <future>
#include <string>

#include "app/window/toolkit/window.h"
#include "render/readback.h"

namespace mercury::window {

// The part of the window's framebuffer, in its pixels from the upper left corner, upper row first. Call before it is
// shown.
render::Image read_window(WindowSize pixels, render::PixelFormat format = render::PixelFormat::rgb);

// A name that no file has yet: "mercury-2026-01-31-120501.png" in that folder.
std::filesystem::path fresh_name(const std::filesystem::path& folder, const std::string& extension);

// Writes a picture on a thread of its own.
class Screenshot {
 public:
  void take(render::Image image, const std::filesystem::path& path);
  bool under_way() const { return written_.valid(); }
  // Once it is done: true, and what is to be told; the path is empty if it failed.
  bool done(std::filesystem::path& path, std::string& error);

 private:
  std::filesystem::path path_;
  std::future<std::string> written_;  // what went wrong
};

}  // namespace mercury::window
