// SPDX-License-Identifier: Apache-2.0
#include "render/context/buffers.h"

#include <algorithm>

#include "render/context/context.h"

namespace mercury::render {
namespace {

constexpr GLuint64 patience = 20'000'000'000;  // [ns] per frame; after that the GPU counts as dead

}  // namespace

HostBuffer::HostBuffer(std::size_t bytes) : size_(bytes) {
  GLuint name = 0;
  glCreateBuffers(1, &name);
  buffer_ = GlName<ReleaseBuffer>(name);
  const GLbitfield access = GL_MAP_READ_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
  glNamedBufferStorage(name, GLsizeiptr(bytes), nullptr, access | GL_CLIENT_STORAGE_BIT);
  mapped_ = static_cast<const std::uint8_t*>(glMapNamedBufferRange(name, 0, GLsizeiptr(bytes), access));
  if (mapped_) return;
  throw_if_gl_failed();
  throw ContextError("the driver does not give host memory to read back into");
}

void HostBuffer::start(const Buffer& from, std::size_t bytes) {
  forget();
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glCopyNamedBufferSubData(from.get(), buffer_.get(), 0, 0, GLsizeiptr(bytes));
  fence_ = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
  glFlush();
}

const std::uint8_t* HostBuffer::finish() {
  const GLenum outcome = glClientWaitSync(fence_, GL_SYNC_FLUSH_COMMANDS_BIT, patience);
  forget();
  if (outcome != GL_ALREADY_SIGNALED && outcome != GL_CONDITION_SATISFIED)
    throw ContextError("the GPU did not finish a picture within 20 s");
  throw_if_gl_failed();
  return mapped_;
}

void HostBuffer::forget() {
  if (fence_) glDeleteSync(fence_);
  fence_ = nullptr;
}

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
