// SPDX-License-Identifier: Apache-2.0
// A buffer of equal chunks in device memory, one per robot, that can grow.
#pragma once

#include <algorithm>

#include "sim/cuda/memory.h"

namespace mercury::cuda {

template <class T>
class ChunkedArray {
 public:
  // `tail` = unused elements after the last chunk, for kernels that read ahead.
  explicit ChunkedArray(std::size_t tail = 0) : tail_(tail) {}

  T* data() const { return array_.data(); }
  T* chunk(std::size_t i) const { return array_.data() + i * stride_; }
  std::size_t stride() const { return stride_; }  // elements of a chunk
  std::size_t size() const { return array_.size(); }

  // From chunk `first` on; both return when the stream has done it.
  void write(std::size_t first, std::span<const T> values, cudaStream_t stream) {
    array_.write(first * stride_, values, stream);
  }
  void read(std::size_t first, std::span<T> values, cudaStream_t stream) const {
    array_.read(first * stride_, values, stream);
  }

  // Makes room for `capacity` chunks of `stride` elements and keeps the first `used` chunks. New elements are 0.
  void reshape(std::size_t capacity, std::size_t stride, std::size_t used, cudaStream_t stream) {
    if (capacity * stride + tail_ == array_.size() && stride == stride_) return;
    DeviceArray<T> larger(capacity * stride + tail_);
    const std::size_t width = std::min(stride, stride_);
    if (used > 0 && width > 0) {
      check(cudaMemcpy2DAsync(larger.data(), stride * sizeof(T), array_.data(), stride_ * sizeof(T), width * sizeof(T),
                              used, cudaMemcpyDeviceToDevice, stream),
            "making room on the device");
      check(cudaStreamSynchronize(stream), "making room on the device");
    }
    array_ = std::move(larger);
    stride_ = stride;
  }

 private:
  DeviceArray<T> array_;
  std::size_t stride_ = 0, tail_ = 0;
};

}  // namespace mercury::cuda
