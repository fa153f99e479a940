// SPDX-License-Identifier: Apache-2.0
// Draws a scene into a picture of its own. Read it back (render/readback.h) or show it in a window (present()).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "render/body_data.h"
#include "render/camera.h"
#include "render/context/context.h"
#include "render/scene.h"

namespace mercury::render {

// automatic: high on a GPU, low with a software renderer.
enum class Quality { automatic, low, medium, high };

// "auto", "low", "medium", "high".
std::string_view name_of(Quality quality);
// Throws std::invalid_argument that lists them.
Quality quality_named(std::string_view name);

struct RendererOptions {
  int width = 1280, height = 720;  // pixels
  Quality quality = Quality::automatic;
  float text_size = 0;  // height of a line of text in pixels; 0 = from the picture's height
};

// The GPU time of a part of a frame.
struct PassTime {
  std::string name;  // "shadows"
  double milliseconds = 0;
};

// Every member, the destructor included, needs the context of the constructor to be current.
class Overlay;

class Renderer {
 public:
  // Throws ContextError when the driver refuses a shader or the picture is larger than it can draw.
  explicit Renderer(const Context& context, const RendererOptions& options = {});
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  void resize(int width, int height);
  void set_quality(Quality quality);
  int width() const;
  int height() const;
  Quality quality() const;  // never automatic

  // Replaces all bodies, with their positions at rest.
  // Throws std::invalid_argument for an index out of range or a length that does not fit.
  void set_bodies(std::span<const Body> bodies);
  // The same with bodies that were prepared before, perhaps on another thread: costs only the copy to the GPU.
  void set_bodies(std::shared_ptr<const BodyData> bodies);
  std::size_t body_count() const;
  std::size_t mass_count() const;  // of all bodies together
  std::size_t face_count() const;
  std::size_t spring_count() const;
  // Body i's masses are those from mass_offsets()[i] to mass_offsets()[i + 1].
  std::span<const std::uint32_t> mass_offsets() const;

  // The GL buffer with the positions that are drawn, 3 * mass_count() floats: fill it with OpenGL's copies or
  // Scene::positions. set_bodies() replaces its storage.
  unsigned position_buffer() const;

  // 3 * mass_count() floats in a GL buffer.
  struct PositionSource {
    unsigned buffer = 0;
    std::size_t offset = 0;  // [bytes]; a multiple of 256
  };
  // Fills position_buffer() with a + share (b - a), each operation rounded to float.
  void mix_positions(const PositionSource& a, const PositionSource& b, float share);

  // The box around each body in its own coordinates, from position_buffer(). Waits for the GPU.
  std::vector<Bounds> body_bounds();

  // Draws the picture.
  void draw(const Scene& scene, const Camera& camera);

  // GPU time of each part of a recent frame, in drawing order; empty at first.
  const std::vector<PassTime>& times() const;

  // What is written on the picture of the last draw().
  const Overlay& overlay() const;

  // The finished picture: an sRGB8_ALPHA8 texture, lower row first as usual in OpenGL. resize() replaces it.
  unsigned picture() const;
  // Copies the picture into a framebuffer (0 = the window's), scaled to the rectangle.
  void present(unsigned framebuffer, int x, int y, int width, int height) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

// A texture that keeps a frame and can be shown smaller. Not an sRGB texture, which would look darker when a user
// interface samples it.
class KeptFrame {
 public:
  // Copies what was drawn last, scaled.
  KeptFrame(const Renderer& renderer, int width, int height);
  KeptFrame(KeptFrame&& other) noexcept : name_(std::exchange(other.name_, 0u)) {}
  KeptFrame& operator=(KeptFrame&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  ~KeptFrame();
  unsigned name() const { return name_; }  // of OpenGL

 private:
  unsigned name_ = 0;
};

}  // namespace mercury::render
