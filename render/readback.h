// SPDX-License-Identifier: Apache-2.0
// Pictures from the card to the processor without making either wait.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace mercury::render {

class Renderer;

enum class PixelFormat {
  rgb,     // 3 bytes a pixel, upper row first
  rgba,    // 4 bytes a pixel, upper row first
  yuv420,  // planes Y, U, V as encoders take them (I420): BT.709, limited range; width and height must be even
};

struct Image {
  int width = 0, height = 0;
  PixelFormat format = PixelFormat::rgb;
  std::vector<std::uint8_t> bytes;
};

// Bytes of one picture.
std::size_t image_size(PixelFormat format, int width, int height);

// A ring of buffers that pictures pass through: start() after draw(), finish() some frames later.
class Readback {
 public:
  // `ring`: how many pictures may be under way. Throws std::invalid_argument for odd sizes with yuv420.
  Readback(PixelFormat format, int width, int height, int ring = 3);
  ~Readback();
  Readback(Readback&&) noexcept;
  Readback& operator=(Readback&&) noexcept;

  // Begins to read the renderer's picture. At most `ring` may be pending: call finish() first when full().
  void start(const Renderer& renderer);
  std::size_t pending() const;
  bool full() const;
  // The oldest picture under way, in the order of start(); waits for it. `into` keeps its memory if it is large enough.
  void finish(Image& into);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

// The renderer's picture, now.
Image read(const Renderer& renderer, PixelFormat format = PixelFormat::rgb);

}  // namespace mercury::render
