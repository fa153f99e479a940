// SPDX-License-Identifier: Apache-2.0
// Memory of the host that the GPU reads, for large data of each picture. The CPU only copies; the transfer happens when
// the GPU gets there. glNamedBufferSubData would make one wait for the other.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "render/gl_objects.h"

namespace mercury::render {

// At most two pictures may be under way (Pace).
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
