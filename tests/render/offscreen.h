// SPDX-License-Identifier: Apache-2.0
// Shared by tests that draw: one context, because making one takes long, and functions that inspect pictures.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <string>

#include "render/context/context.h"
#include "render/readback.h"
#include "render/renderer.h"
#include "render/vector.h"

namespace mercury::render {

// nullptr if no context is available; then `why` is the reason.
inline Context* shared_context(std::string* why = nullptr) {
  static std::string reason;
  static const std::unique_ptr<Context> context = [] {
    try {
      return make_context();
    } catch (const ContextError& error) {
      reason = error.what();
      return std::unique_ptr<Context>();
    }
  }();
  if (why) *why = reason;
  return context.get();
}

// Skips its tests if there is no context, and fails them on any message of the driver.
class Offscreen : public testing::Test {
 protected:
  void SetUp() override {
    std::string why;
    context_ = shared_context(&why);
    if (!context_) GTEST_SKIP() << "no OpenGL here: " << why;
    context_->make_current();
    context_->take_messages();
  }
  void TearDown() override {
    if (!context_) return;
    for (const std::string& message : context_->take_messages()) ADD_FAILURE() << "OpenGL says: " << message;
  }
  Renderer make_renderer(int width = 160, int height = 120) {
    return Renderer(*context_, {.width = width, .height = height, .quality = Quality::low});
  }
  Context* context_ = nullptr;
};

// Red, green and blue of a pixel, or sums of them.
struct Rgb {
  int x = 0, y = 0, z = 0;
  int sum() const { return x + y + z; }
  Rgb& operator+=(const Rgb& b) { return *this = {x + b.x, y + b.y, z + b.z}; }
  friend bool operator==(const Rgb&, const Rgb&) = default;
};

inline Rgb pixel(const Image& image, int x, int y) {
  const std::size_t at = 3 * (std::size_t(y) * std::size_t(image.width) + std::size_t(x));
  return {image.bytes[at], image.bytes[at + 1], image.bytes[at + 2]};
}

inline int largest_difference(const Rgb& a, const Rgb& b) {
  return std::max({std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.z - b.z)});
}

// The number of pixels that differ by more than `tolerance` steps in some channel.
inline int count_differing(const Image& a, const Image& b, int tolerance) {
  int count = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) count += largest_difference(pixel(a, x, y), pixel(b, x, y)) > tolerance;
  return count;
}

}  // namespace mercury::render
