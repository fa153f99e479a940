// SPDX-License-Identifier: Apache-2.0
// Memory of the processor's that the card writes into, read without stopping the card.
#pragma once

#include <cstddef>
#include <cstdint>

#include "render/gl_objects.h"

namespace mercury::render {

class HostBuffer {
 public:
  HostBuffer() = default;
  // Throws ContextError.
  explicit HostBuffer(std::size_t bytes);
  ~HostBuffer() { forget(); }
  HostBuffer(HostBuffer&& other) noexcept { *this = std::move(other); }
  HostBuffer& operator=(HostBuffer&& other) noexcept {
    std::swap(buffer_, other.buffer_);
    std::swap(size_, other.size_);
    std::swap(mapped_, other.mapped_);
    std::swap(fence_, other.fence_);
    return *this;
  }

  std::size_t size() const { return size_; }
  // Copies what `from` will hold after the calls so far. Nothing waits.
  void start(const Buffer& from, std::size_t bytes);
  bool started() const { return fence_ != nullptr; }
  // Waits for the copy; the bytes stay until the next start(). Throws ContextError when the card does not answer.
  const std::uint8_t* finish();

 private:
  void forget();

  GlName<ReleaseBuffer> buffer_;
  std::size_t size_ = 0;
  const std::uint8_t* mapped_ = nullptr;
  GLsync fence_ = nullptr;
};

}  // namespace mercury::render
