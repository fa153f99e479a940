// SPDX-License-Identifier: Apache-2.0
// Host memory that the GPU writes into, read without stopping the GPU.
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
  // Starts a copy of what `from` holds after all earlier GL calls. Does not wait.
  void start(const Buffer& from, std::size_t bytes);
  bool started() const { return fence_ != nullptr; }
  // Waits for the copy. The bytes are valid until the next start(). Throws ContextError when the GPU does not answer.
  const std::uint8_t* finish();

 private:
  void forget();

  GlName<ReleaseBuffer> buffer_;
  std::size_t size_ = 0;
  const std::uint8_t* mapped_ = nullptr;
  GLsync fence_ = nullptr;
};

}  // namespace mercury::render
