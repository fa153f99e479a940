// SPDX-License-Identifier: Apache-2.0
#include "render/readback.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <string>

#include "render/context/buffers.h"
#include "render/context/gl_objects.h"
#include "render/renderer.h"

namespace mercury::render {

struct Readback::Parts {
  PixelFormat format;
  int width, height;
  std::size_t words;
  Program pack;
  Buffer packed;
  std::vector<HostBuffer> slots;
  std::size_t first = 0, pending = 0;
};

std::size_t image_size(PixelFormat format, int width, int height) {
  const std::size_t pixels = std::size_t(width) * std::size_t(height);
  switch (format) {
    case PixelFormat::rgb:
      return 3 * pixels;
    case PixelFormat::rgba:
      return 4 * pixels;
    default:
      return pixels * 3 / 2;
  }
}

Readback::Readback(PixelFormat format, int width, int height, int ring) : parts_(std::make_unique<Parts>()) {
  if (format == PixelFormat::yuv420 && (width % 2 != 0 || height % 2 != 0))
    throw std::invalid_argument("a video's width and height must be even, not " + std::to_string(width) + "x" +
                                std::to_string(height));
  parts_->format = format;
  parts_->width = width;
  parts_->height = height;
  parts_->words = (image_size(format, width, height) + 3) / 4;
  parts_->pack = make_program({"readback.comp"});
  parts_->packed.reserve(4 * parts_->words);
  for (int i = 0; i < std::max(ring, 1); ++i) parts_->slots.emplace_back(4 * parts_->words);
}

Readback::~Readback() = default;
Readback::Readback(Readback&&) noexcept = default;
Readback& Readback::operator=(Readback&&) noexcept = default;

std::size_t Readback::pending() const { return parts_->pending; }
bool Readback::full() const { return parts_->pending == parts_->slots.size(); }

void Readback::start(const Renderer& renderer) {
  Parts& p = *parts_;
  if (full()) throw std::logic_error("Readback::start: every buffer of the ring is pending");
  if (renderer.width() != p.width || renderer.height() != p.height)
    throw std::invalid_argument("Readback::start: the picture has another size");
  GLuint name = 0;
  glGenTextures(1, &name);
  const Texture bytes(name);
  glTextureView(name, GL_TEXTURE_2D, renderer.picture(), GL_RGBA8, 0, 1, 0, 1);
  glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glUseProgram(p.pack.get());
  glBindTextureUnit(0, name);
  glUniform2i(0, p.width, p.height);
  glUniform1i(1, int(p.format));
  glBindBufferRange(GL_SHADER_STORAGE_BUFFER, 0, p.packed.get(), 0, GLsizeiptr(4 * p.words));
  const std::size_t groups = (p.words + 63) / 64;
  const std::size_t across = std::min<std::size_t>(groups, 32768);
  glDispatchCompute(GLuint(across), GLuint((groups + across - 1) / across), 1);
  p.slots[(p.first + p.pending) % p.slots.size()].start(p.packed, 4 * p.words);
  ++p.pending;
}

void Readback::finish(Image& into) {
  Parts& p = *parts_;
  if (p.pending == 0) throw std::logic_error("Readback::finish: no picture is pending");
  HostBuffer& slot = p.slots[p.first];
  p.first = (p.first + 1) % p.slots.size();
  --p.pending;
  const std::uint8_t* bytes = slot.finish();
  into.width = p.width;
  into.height = p.height;
  into.format = p.format;
  into.bytes.resize(image_size(p.format, p.width, p.height));
  std::memcpy(into.bytes.data(), bytes, into.bytes.size());
}

Image read(const Renderer& renderer, PixelFormat format) {
  Readback readback(format, renderer.width(), renderer.height(), 1);
  readback.start(renderer);
  Image image;
  readback.finish(image);
  return image;
}

}  // namespace mercury::render
