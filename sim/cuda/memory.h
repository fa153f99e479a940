// SPDX-License-Identifier: Apache-2.0
// Owners of device memory and events, and the check of every CUDA call.
#pragma once

#include <cuda_runtime_api.h>

#include <cstddef>
#include <span>
#include <string>
#include <utility>

#include "mercury/error.h"

namespace mercury::cuda {

// Throws DeviceError if a call failed. `what` says what the call was for.
inline void check(cudaError_t error, const char* what) {
  if (error != cudaSuccess) throw DeviceError(std::string("CUDA: ") + what + ": " + cudaGetErrorString(error));
}

// A moment in the stream of work of the device.
class Event {
 public:
  Event() { check(cudaEventCreate(&event_), "creating an event"); }
  ~Event() { cudaEventDestroy(event_); }
  Event(const Event&) = delete;
  Event& operator=(const Event&) = delete;

  void record() { check(cudaEventRecord(event_), "recording an event"); }
  // The time from `start` to this event [s]. Waits for this event.
  double seconds_since(const Event& start) const {
    float milliseconds = 0;
    check(cudaEventSynchronize(event_), "stepping");
    check(cudaEventElapsedTime(&milliseconds, start.event_, event_), "reading events");
    return static_cast<double>(milliseconds) * 1e-3;
  }

 private:
  cudaEvent_t event_ = nullptr;
};

// An array in device memory.
template <class T>
class DeviceArray {
 public:
  DeviceArray() = default;
  explicit DeviceArray(std::size_t size) : size_(size) {
    if (size == 0) return;
    const cudaError_t error = cudaMalloc(reinterpret_cast<void**>(&data_), size * sizeof(T));
    if (error == cudaErrorMemoryAllocation) {
      (void)cudaGetLastError();
      throw DeviceError("the GPU has not enough memory left for " + std::to_string(size * sizeof(T) >> 20) +
                        " MiB: give it fewer or smaller robots");
    }
    check(error, "allocating device memory");
  }
  ~DeviceArray() { cudaFree(data_); }
  DeviceArray(DeviceArray&& other) noexcept
      : data_(std::exchange(other.data_, nullptr)), size_(std::exchange(other.size_, 0)) {}
  DeviceArray& operator=(DeviceArray&& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    return *this;
  }

  T* data() const { return data_; }
  std::size_t size() const { return size_; }

  void write(std::size_t first, std::span<const T> values) {
    if (!values.empty())
      check(cudaMemcpy(data_ + first, values.data(), values.size_bytes(), cudaMemcpyHostToDevice),
            "writing to the device");
  }
  void read(std::size_t first, std::span<T> values) const {
    if (!values.empty())
      check(cudaMemcpy(values.data(), data_ + first, values.size_bytes(), cudaMemcpyDeviceToHost),
            "reading from the device");
  }
  void clear() {
    if (size_ > 0) check(cudaMemset(data_, 0, size_ * sizeof(T)), "clearing device memory");
  }

 private:
  T* data_ = nullptr;
  std::size_t size_ = 0;
};

// An array in host memory that kernels write to directly. It returns a few numbers per robot without a copy.
template <class T>
class MappedArray {
 public:
  MappedArray() = default;
  explicit MappedArray(std::size_t size) : size_(size) {
    if (size > 0)
      check(cudaHostAlloc(reinterpret_cast<void**>(&data_), size * sizeof(T), cudaHostAllocMapped),
            "allocating mapped memory");
  }
  ~MappedArray() { cudaFreeHost(data_); }
  MappedArray(MappedArray&& other) noexcept
      : data_(std::exchange(other.data_, nullptr)), size_(std::exchange(other.size_, 0)) {}
  MappedArray& operator=(MappedArray&& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    return *this;
  }

  T* on_device() const {
    void* pointer = nullptr;
    check(cudaHostGetDevicePointer(&pointer, data_, 0), "mapping memory");
    return static_cast<T*>(pointer);
  }
  const T& operator[](std::size_t i) const { return data_[i]; }
  std::size_t size() const { return size_; }

 private:
  T* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace mercury::cuda
