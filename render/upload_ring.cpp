// SPDX-License-Identifier: Apache-2.0
#include "render/upload_ring.h"

#include <algorithm>

#include "render/context.h"
#include "render/gl_failure.h"

namespace mercury::render {

UploadRing::Slot UploadRing::make_slot(std::size_t bytes) {
  GLuint name = 0;
  glCreateBuffers(1, &name);
  Slot slot{GlName<ReleaseBuffer>(name), nullptr, bytes};
  const GLbitfield access = GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
  glNamedBufferStorage(name, GLsizeiptr(bytes), nullptr, access | GL_CLIENT_STORAGE_BIT);
  slot.mapped = static_cast<std::byte*>(glMapNamedBufferRange(name, 0, GLsizeiptr(bytes), access));
  if (slot.mapped) return slot;
  throw_if_gl_failed();
  throw ContextError("the driver does not give host memory to upload from");
}

void UploadRing::write(const Buffer& to, std::span<const std::byte> data) {
  Slot& slot = ring_[next_];
  next_ = (next_ + 1) % ring_.size();
  if (slot.size < data.size()) slot = make_slot(data.size());
  std::ranges::copy(data, slot.mapped);
  glCopyNamedBufferSubData(slot.buffer.get(), to.get(), 0, 0, GLsizeiptr(data.size()));
}

}  // namespace mercury::render
