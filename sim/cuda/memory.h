// SPDX-License-Identifier: Apache-2.0
// Owners of device memory and of host memory that the device reads and writes.
//
// Simulations come and go, several at once (mercury/evaluator.h). cudaMalloc and cudaFree would make each of them wait
// for all others, and pinned memory takes 0.4 ms per MiB to make. So both kinds are kept for reuse: device memory in
// CUDA's own pool, pinned memory in ours.
//
// While others step, whatever a multiprocessor does waits for the launches that they have begun, tens of milliseconds
// even in an urgent stream: kernels, copies within the device, cudaMemset, and copies of up to 24 kB to the device,
// which go the same way. Copies by the copy engines do not wait.
#pragma once

#include <cuda_runtime_api.h>

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "sim/cuda/stream.h"

namespace mercury::cuda {

// Queues a copy to the device by a copy engine, whatever its size. The host may change pageable memory afterward, but
// not pinned memory before the stream has done it. `what` says what it is for.
void upload(void* to, const void* from, std::size_t bytes, cudaStream_t stream, const char* what);

// Gets the first memory of the current device, which takes 10 ms. Otherwise the first allocation does.
void set_up_memory();

// Bytes of zeros on the current device, ready for use by all streams. Throws DeviceError if there is no room.
void* allocate_on_device(std::size_t bytes);
// No stream may still use them. The device that holds them must be the current one.
void free_on_device(void* data) noexcept;

// Bytes of zeros on the current device for programs and other libraries. They can be freed by any thread, after their
// backend, and while kernels still use them: freeing waits for the device. They do not come from the pool, because
// other devices and processes can map only what cudaMalloc() allocates.
std::shared_ptr<void> allocate_to_share(std::size_t bytes);

// An array in device memory.
template <class T>
class DeviceArray {
 public:
  DeviceArray() = default;
  explicit DeviceArray(std::size_t size)
      : data_(size > 0 ? static_cast<T*>(allocate_on_device(size * sizeof(T))) : nullptr), size_(size) {}
  ~DeviceArray() { free_on_device(data_); }
  DeviceArray(DeviceArray&& other) noexcept
      : data_(std::exchange(other.data_, nullptr)), size_(std::exchange(other.size_, 0)) {}
  DeviceArray& operator=(DeviceArray&& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    return *this;
  }

  T* data() const { return data_; }
  std::size_t size() const { return size_; }

  // Both return when the stream has done it.
  void write(std::size_t first, std::span<const T> values, cudaStream_t stream) {
    constexpr const char* what = "writing to the device";
    if (values.empty()) return;
    upload(data_ + first, values.data(), values.size_bytes(), stream, what);
    check(cudaStreamSynchronize(stream), what);
  }
  void read(std::size_t first, std::span<T> values, cudaStream_t stream) const {
    constexpr const char* what = "reading from the device";
    if (values.empty()) return;
    check(cudaMemcpyAsync(values.data(), data_ + first, values.size_bytes(), cudaMemcpyDeviceToHost, stream), what);
    check(cudaStreamSynchronize(stream), what);
  }

 private:
  T* data_ = nullptr;
  std::size_t size_ = 0;
};

// Bytes of pinned host memory: copies from and to it run beside other work, and kernels can write to it. What it holds
// at first is unspecified.
class PinnedBuffer {
 public:
  PinnedBuffer() = default;
  explicit PinnedBuffer(std::size_t bytes);
  ~PinnedBuffer();
  PinnedBuffer(PinnedBuffer&& other) noexcept
      : data_(std::exchange(other.data_, nullptr)), bytes_(std::exchange(other.bytes_, 0)) {}
  PinnedBuffer& operator=(PinnedBuffer&& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(bytes_, other.bytes_);
    return *this;
  }

  std::byte* data() const { return data_; }
  std::size_t bytes() const { return bytes_; }  // at least as many as requested

 private:
  std::byte* data_ = nullptr;
  std::size_t bytes_ = 0;
};

// An array in pinned host memory. It returns a few numbers per robot without a copy.
template <class T>
class MappedArray {
 public:
  MappedArray() = default;
  explicit MappedArray(std::size_t size) : buffer_(size * sizeof(T)), size_(size) {}

  T* on_device() const {
    void* pointer = nullptr;
    check(cudaHostGetDevicePointer(&pointer, buffer_.data(), 0), "mapping memory");
    return static_cast<T*>(pointer);
  }
  const T& operator[](std::size_t i) const { return reinterpret_cast<const T*>(buffer_.data())[i]; }
  std::size_t size() const { return size_; }

 private:
  PinnedBuffer buffer_;
  std::size_t size_ = 0;
};

}  // namespace mercury::cuda
