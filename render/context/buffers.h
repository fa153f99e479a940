// SPDX-License-Identifier: Apache-2.0
// Memory that the host and the GPU share: one direction per class, and neither stops the GPU.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "render/context/gl_objects.h"

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

// Memory of the host that the GPU reads, for large data of each frame. The CPU only copies; the transfer happens when
// the GPU gets there. glNamedBufferSubData would make one wait for the other.
// At most two frames may be under way (Pace).
class UploadRing {
 public:
  void write(const Buffer& to, std::span<const std::byte> data);

 private:
  struct Slot {
    GlName<ReleaseBuffer> buffer;
    std::byte* mapped = nullptr;
    std::size_t size = 0;
  };
  static Slot make_slot(std::size_t bytes);

  std::array<Slot, 4> ring_;
  std::size_t next_ = 0;
};

}  // namespace mercury::render
