// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/memory.h"

#include <algorithm>
#include <bit>
#include <map>
#include <mutex>
#include <new>
#include <span>

namespace mercury::cuda {
namespace {

// Pinned buffers of no one. It lives as long as the process: the driver may be gone before static objects are
// destroyed.
class PinnedPool {
 public:
  static PinnedPool& instance() {
    static PinnedPool* const pool = new PinnedPool;
    return *pool;
  }

  // At least as many bytes as requested.
  std::span<std::byte> take(std::size_t bytes) {
    {
      const std::lock_guard lock(mutex_);
      if (const auto found = free_.lower_bound(bytes); found != free_.end() && found->first <= most_times * bytes) {
        const auto [kept, data] = *found;
        free_.erase(found);
        kept_ -= kept;
        return {data, kept};
      }
    }
    void* data = nullptr;
    const cudaError_t error = cudaHostAlloc(&data, bytes, cudaHostAllocMapped | cudaHostAllocPortable);
    if (error == cudaErrorMemoryAllocation) {
      (void)cudaGetLastError();
      throw std::bad_alloc();  // of the host
    }
    check(error, "allocating pinned memory");
    return {static_cast<std::byte*>(data), bytes};
  }

  void give_back(std::span<std::byte> buffer) {
    {
      const std::lock_guard lock(mutex_);
      if (kept_ + buffer.size() <= most_kept) {
        free_.emplace(buffer.size(), buffer.data());
        kept_ += buffer.size();
        return;
      }
    }
    cudaFreeHost(buffer.data());
  }

 private:
  static constexpr std::size_t most_kept = std::size_t{1} << 30;
  static constexpr std::size_t most_times = 8;  // as large as requested

  std::mutex mutex_;
  std::multimap<std::size_t, std::byte*> free_;
  std::size_t kept_ = 0;
};

// Lets the pool keep what is freed, up to half of the device's memory. A pool grows slowly, so it begins with some.
void let_pool_keep_memory(cudaMemPool_t pool) {
  std::size_t free = 0, total = 0;
  check(cudaMemGetInfo(&free, &total), "querying the device's memory");
  std::uint64_t threshold = total / 2;
  check(cudaMemPoolSetAttribute(pool, cudaMemPoolAttrReleaseThreshold, &threshold), "setting up device memory");
  void* data = nullptr;
  check(cudaMallocAsync(&data, free / 256, cudaStreamPerThread), "setting up device memory");
  check(cudaFreeAsync(data, cudaStreamPerThread), "setting up device memory");
}

// Of this thread, for the current device.
cudaStream_t urgent_stream() {
  int device = 0;
  check(cudaGetDevice(&device), "querying the current device");
  thread_local std::map<int, Stream> streams;
  return streams.try_emplace(device, true).first->second.get();
}

cudaMemPool_t present_pool() {
  int device = 0;
  cudaMemPool_t pool = nullptr;
  check(cudaGetDevice(&device), "querying the current device");
  check(cudaDeviceGetDefaultMemPool(&pool, device), "setting up device memory");
  static std::mutex mutex;
  static std::map<int, bool> set_up;
  const std::lock_guard lock(mutex);
  if (!std::exchange(set_up[device], true)) let_pool_keep_memory(pool);
  return pool;
}

// Zeros to copy from. They live as long as the process, as the pool does.
std::span<const std::byte> pinned_zeros() {
  static const std::span<const std::byte> zeros = [] {
    const std::span<std::byte> taken = PinnedPool::instance().take(std::size_t{1} << 20);
    std::ranges::fill(taken, std::byte{0});
    return taken;
  }();
  return zeros;
}

void clear(void* data, std::size_t bytes, cudaStream_t stream) {
  constexpr std::size_t most_by_copy_engine = std::size_t{32} << 20;  // for more, to wait takes no longer
  constexpr const char* what = "clearing device memory";
  if (bytes > most_by_copy_engine) return check(cudaMemsetAsync(data, 0, bytes, stream), what);
  const std::span<const std::byte> zeros = pinned_zeros();
  for (std::size_t first = 0; first < bytes; first += zeros.size())
    upload(static_cast<std::byte*>(data) + first, zeros.data(), std::min(zeros.size(), bytes - first), stream, what);
}

// What `allocate` allocates, cleared.
template <class Allocate>
void* zeros(std::size_t bytes, cudaStream_t stream, const Allocate& allocate) {
  const cudaMemPool_t pool = present_pool();
  void* data = nullptr;
  cudaError_t error = allocate(&data);
  if (error == cudaErrorMemoryAllocation) {
    (void)cudaGetLastError();
    check(cudaDeviceSynchronize(), "freeing device memory");
    check(cudaMemPoolTrimTo(pool, 0), "freeing device memory");
    error = allocate(&data);
  }
  if (error == cudaErrorMemoryAllocation) {
    (void)cudaGetLastError();
    throw DeviceError(no_room_text(bytes));
  }
  check(error, "allocating device memory");
  clear(data, bytes, stream);
  check(cudaStreamSynchronize(stream), "allocating device memory");
  return data;
}

}  // namespace

// Two rows are copied by an engine even if they are short. Longer copies are in any case, and rows have a limit.
void upload(void* to, const void* from, std::size_t bytes, cudaStream_t stream, const char* what) {
  constexpr std::size_t longest_short = std::size_t{1} << 16;
  if (bytes > longest_short) return check(cudaMemcpyAsync(to, from, bytes, cudaMemcpyHostToDevice, stream), what);
  const std::size_t row = bytes / 2, rest = bytes % 2;
  if (row > 0) check(cudaMemcpy2DAsync(to, row, from, row, row, 2, cudaMemcpyHostToDevice, stream), what);
  if (rest > 0)
    check(cudaMemcpyAsync(static_cast<std::byte*>(to) + 2 * row, static_cast<const std::byte*>(from) + 2 * row, rest,
                          cudaMemcpyHostToDevice, stream),
          what);
}

void set_up_memory() {
  present_pool();
  pinned_zeros();
}

void* allocate_on_device(std::size_t bytes) {
  const cudaStream_t stream = urgent_stream();
  return zeros(bytes, stream, [&](void** data) { return cudaMallocAsync(data, bytes, stream); });
}

std::shared_ptr<void> allocate_to_share(std::size_t bytes) {
  int device = 0;
  check(cudaGetDevice(&device), "querying the current device");
  const auto free = [device](void* data) noexcept {
    int callers = 0;
    cudaGetDevice(&callers);
    cudaSetDevice(device);
    cudaDeviceSynchronize();
    cudaFree(data);
    cudaSetDevice(callers);
  };
  return {zeros(bytes, urgent_stream(), [&](void** data) { return cudaMalloc(data, bytes); }), free};
}

void free_on_device(void* data) noexcept {
  if (data) cudaFreeAsync(data, cudaStreamPerThread);
}

PinnedBuffer::PinnedBuffer(std::size_t bytes) {
  if (bytes == 0) return;
  // To make it takes 0.4 ms or more per MiB. A program needs buffers of few sizes.
  constexpr std::size_t smallest = std::size_t{1} << 16, step = std::size_t{1} << 20;
  const std::size_t rounded =
      bytes < step ? std::bit_ceil(std::max(bytes, smallest)) : (bytes + step - 1) / step * step;
  const std::span<std::byte> taken = PinnedPool::instance().take(rounded);
  data_ = taken.data();
  bytes_ = taken.size();
}

PinnedBuffer::~PinnedBuffer() {
  if (data_) PinnedPool::instance().give_back({data_, bytes_});
}

}  // namespace mercury::cuda
