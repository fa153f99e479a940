// SPDX-License-Identifier: Apache-2.0
// Memory of a GPU that CUDA writes and OpenGL reads, without a copy and without mapping.
//
//   CUDA    DeviceMemory: an allocation that can be exported as a file descriptor
//   OpenGL  DeviceBuffer: a buffer object over the same bytes (GL_EXT_memory_object_fd)
//
// Neither side waits for the other: the user of both must order their work.
#pragma once

#include <cstddef>

namespace mercury {

class DeviceMemory {
 public:
  // Throws NoInterop if the driver cannot export memory, and DeviceError if none is free.
  DeviceMemory(int cuda_device, std::size_t bytes);
  ~DeviceMemory();
  DeviceMemory(const DeviceMemory&) = delete;
  DeviceMemory& operator=(const DeviceMemory&) = delete;

  void* data() const { return reinterpret_cast<void*>(address_); }
  std::size_t size() const { return size_; }  // at least what was asked for
  // A new file descriptor of the memory, which belongs to the caller. Throws NoInterop.
  int file_descriptor() const;

 private:
  std::size_t size_ = 0;
  unsigned long long handle_ = 0, address_ = 0;
};

// The same memory as an OpenGL buffer object. The context must be current in all members.
class DeviceBuffer {
 public:
  // Throws NoInterop if OpenGL does not take the memory.
  explicit DeviceBuffer(const DeviceMemory& memory);
  ~DeviceBuffer();
  DeviceBuffer(const DeviceBuffer&) = delete;
  DeviceBuffer& operator=(const DeviceBuffer&) = delete;

  unsigned name() const { return buffer_; }

 private:
  unsigned memory_ = 0, buffer_ = 0;
};

}  // namespace mercury
