// SPDX-License-Identifier: Apache-2.0
// Copies pictures from the GPU to the CPU without making either wait.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace mercury::render {

class Renderer;

enum class PixelFormat {
  rgb,     // 3 bytes per pixel, upper row first
  rgba,    // 4 bytes per pixel, upper row first
  yuv420,  // planes Y, U, V as encoders take them (I420): BT.709, limited range; width and height must be even
};

struct Image {
  int width = 0, height = 0;
  PixelFormat format = PixelFormat::rgb;
  std::vector<std::uint8_t> bytes;
};

// Bytes of one picture.
std::size_t image_size(PixelFormat format, int width, int height);

// A ring of buffers: start() a copy after draw(), finish() it some frames later.
class Readback {
 public:
  // `ring`: how many copies may be pending. Throws std::invalid_argument for odd sizes with yuv420.
  Readback(PixelFormat format, int width, int height, int ring = 3);
  ~Readback();
  Readback(Readback&&) noexcept;
  Readback& operator=(Readback&&) noexcept;

  // Starts to copy the renderer's picture. Call finish() first when full().
  void start(const Renderer& renderer);
  std::size_t pending() const;
  bool full() const;
  // Waits for the oldest pending picture. `into` keeps its memory if that is large enough.
  void finish(Image& into);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

// Reads the renderer's picture and waits for it.
Image read(const Renderer& renderer, PixelFormat format = PixelFormat::rgb);

}  // namespace mercury::render
