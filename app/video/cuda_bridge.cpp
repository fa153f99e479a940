// SPDX-License-Identifier: Apache-2.0
// Copies positions from CUDA's memory into OpenGL's, on the GPU that both use.
//
//   simulating thread   steps, and copy into a Store's memory     (CUDA, the simulation's stream)
//   drawing thread      wait for the mark; copy from the same     (OpenGL)
//                       memory into the renderer's buffer, or
//                       mix that of two steps into it; fence
//
// 1. The memory belongs to both interfaces all the time (device_memory.h). Mapping an OpenGL buffer in CUDA for each
//    picture would make each side wait until the other has nothing left to do.
// 2. A store is written again only after its fence: OpenGL has read it.
// 3. The copy belongs to the steps: work of its own would have to wait until the GPU has drawn something, and switches
//    between drawing and computing cost more than the copy.
#include <epoxy/gl.h>  // before CUDA's header, which would bring another OpenGL header

#include <cuda_gl_interop.h>
#include <cuda_runtime_api.h>

#include <algorithm>
#include <deque>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "app/base/frame_places.h"
#include "app/video/device_memory.h"
#include "app/video/position_bridge.h"
#include "mercury/error.h"

namespace mercury {
namespace {

void check(cudaError_t error, const char* what) {
  if (error != cudaSuccess) throw DeviceError(std::string("CUDA: ") + what + ": " + cudaGetErrorString(error));
}

// A point in a stream that threads can wait for.
class Mark {
 public:
  Mark() {
    check(cudaEventCreateWithFlags(&event_, cudaEventDisableTiming | cudaEventBlockingSync), "making an event");
  }
  ~Mark() { cudaEventDestroy(event_); }
  Mark(const Mark&) = delete;
  Mark& operator=(const Mark&) = delete;
  void set(cudaStream_t stream) { check(cudaEventRecord(event_, stream), "recording an event"); }
  void wait() const { check(cudaEventSynchronize(event_), "waiting for positions"); }

 private:
  cudaEvent_t event_ = nullptr;
};

// A point in OpenGL's work. The context must be current in all members.
class Fence {
 public:
  Fence() : sync_(glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0)) {}
  ~Fence() {
    if (sync_) glDeleteSync(sync_);
  }
  Fence(Fence&& other) noexcept : sync_(std::exchange(other.sync_, nullptr)) {}
  Fence& operator=(Fence&& other) noexcept {
    std::swap(sync_, other.sync_);
    return *this;
  }
  bool passed() const { return glClientWaitSync(sync_, GL_SYNC_FLUSH_COMMANDS_BIT, 0) != GL_TIMEOUT_EXPIRED; }

 private:
  GLsync sync_;
};

// Room for the positions of one snapshot in memory that several stores share.
struct Store {
  Store(std::shared_ptr<const DeviceMemory> block, std::size_t begin, std::size_t bytes)
      : memory(std::move(block)), offset(begin), size(bytes) {}
  float* data() const { return reinterpret_cast<float*>(static_cast<char*>(memory->data()) + offset); }
  std::shared_ptr<const DeviceMemory> memory;
  std::size_t offset, size;  // [bytes]
  Mark taken;
};

// Stores that nobody uses; the next snapshots do.
class DevicePool : public std::enable_shared_from_this<DevicePool> {
 public:
  explicit DevicePool(int device) : device_(device) {}

  // It comes back to the pool when its last user lets go.
  std::shared_ptr<Store> take(std::size_t bytes) {
    return {free_store(bytes).release(), [pool = shared_from_this()](Store* store) { pool->put(store); }};
  }

 private:
  std::unique_ptr<Store> free_store(std::size_t bytes) {
    const std::lock_guard lock(mutex_);
    while (!free_.empty()) {
      std::unique_ptr<Store> store = std::move(free_.back());
      free_.pop_back();
      if (store->size >= bytes) return store;
    }
    // Making memory that OpenGL can read takes milliseconds, so it is made for several stores at once.
    constexpr std::size_t stores = 8, alignment = 256;  // as shaders of any GPU accept
    const std::size_t each = (std::max<std::size_t>(bytes, 1) + alignment - 1) / alignment * alignment;
    const auto block = std::make_shared<const DeviceMemory>(device_, stores * each);
    for (std::size_t i = 1; i < stores; ++i) free_.push_back(std::make_unique<Store>(block, i * each, each));
    return std::make_unique<Store>(block, 0, each);
  }
  void put(Store* store) {
    const std::lock_guard lock(mutex_);
    free_.emplace_back(store);
  }

  const int device_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Store>> free_;
};

class CudaSnapshot final : public PositionSnapshot {
 public:
  CudaSnapshot(int device, std::shared_ptr<Store> store, const Simulation& simulation)
      : device_(device), masses_(simulation.mass_count()), store_(std::move(store)) {
    // The simulation's kernels run in the same stream, so the copy lies between the earlier and the later steps.
    if (simulation.copy_positions(store_->data())) store_->taken.set(cudaStreamLegacy);
  }

  // Between two snapshots of one step each.
  CudaSnapshot(const CudaSnapshot& earlier, const CudaSnapshot& later, float share)
      : device_(earlier.device_), masses_(earlier.masses_), store_(earlier.store_), later_(later.store_),
        share_(share) {}

  void read(std::size_t first, std::span<Vec3> out) const override {
    read_store(*store_, first, out);
    if (!later_) return;
    std::vector<Vec3> next(out.size());
    read_store(*later_, first, next);
    interpolate(out, next, share_);
  }

  const std::shared_ptr<Store>& store() const { return store_; }
  // If it is between two steps: the second, and the share of the way to it.
  const std::shared_ptr<Store>& later() const { return later_; }
  float share() const { return share_; }
  std::size_t masses() const { return masses_; }

 private:
  void read_store(const Store& store, std::size_t first, std::span<Vec3> out) const {
    check(cudaSetDevice(device_), "choosing the device");
    store.taken.wait();
    check(cudaMemcpyAsync(out.data(), store.data() + 3 * first, out.size_bytes(), cudaMemcpyDeviceToHost,
                          cudaStreamPerThread),
          "reading positions");
    check(cudaStreamSynchronize(cudaStreamPerThread), "reading positions");
  }

  int device_;
  std::size_t masses_;
  std::shared_ptr<Store> store_, later_;
  float share_ = 0;
};

class CudaBridge final : public PositionBridge {
 public:
  explicit CudaBridge(int device) : device_(device), pool_(std::make_shared<DevicePool>(device)) {
    // Finds out now whether the two share memory.
    const DeviceMemory memory(device, 1);
    const DeviceBuffer buffer(memory);
  }

  std::unique_ptr<PositionSnapshot> take(const Simulation& simulation) override {
    check(cudaSetDevice(device_), "choosing the device");
    const std::size_t bytes = simulation.mass_count() * sizeof(Vec3);
    const bool is_next = simulation_ == &simulation && next_ && next_->size >= bytes;
    auto snapshot = std::make_unique<CudaSnapshot>(device_, is_next ? next_ : pool_->take(bytes), simulation);
    simulation_ = &simulation;
    next_ = pool_->take(bytes);
    simulation.copy_positions_with_steps({next_, next_->data()});
    return snapshot;
  }

  std::unique_ptr<PositionSnapshot> mix(const PositionSnapshot& earlier, const PositionSnapshot& later,
                                        float share) override {
    return std::make_unique<CudaSnapshot>(dynamic_cast<const CudaSnapshot&>(earlier),
                                          dynamic_cast<const CudaSnapshot&>(later), share);
  }

  void show(const PositionSnapshot& snapshot, render::Renderer& renderer, render::Scene& scene) override {
    const auto& shown = dynamic_cast<const CudaSnapshot&>(snapshot);
    check(cudaSetDevice(device_), "choosing the device");
    while (!in_use_.empty() && in_use_.front().fence.passed()) in_use_.pop_front();
    const unsigned buffer = buffer_of(shown.store()->memory);
    shown.store()->taken.wait();
    if (renderer.mass_count() != shown.masses())
      throw std::logic_error("the renderer's bodies are not those of the simulation");
    if (const std::shared_ptr<Store>& later = shown.later()) {
      later->taken.wait();
      renderer.mix_positions({buffer, shown.store()->offset}, {buffer_of(later->memory), later->offset}, shown.share());
      in_use_.push_back({{}, later});
    } else {
      glCopyNamedBufferSubData(buffer, renderer.position_buffer(), static_cast<GLintptr>(shown.store()->offset), 0,
                               static_cast<GLsizeiptr>(shown.masses() * sizeof(Vec3)));
    }
    in_use_.push_back({{}, shown.store()});
    scene.positions = {};
  }

 private:
  struct Import {
    std::weak_ptr<const DeviceMemory> memory;
    std::unique_ptr<DeviceBuffer> buffer;
  };
  struct InUse {
    Fence fence;
    std::shared_ptr<Store> store;
  };

  // OpenGL's name of the memory.
  unsigned buffer_of(const std::shared_ptr<const DeviceMemory>& memory) {
    std::erase_if(imports_, [](const Import& import) { return import.memory.expired(); });
    const auto known = std::ranges::find_if(imports_, [&](const Import& i) { return i.memory.lock() == memory; });
    if (known != imports_.end()) return known->buffer->name();
    imports_.push_back({memory, std::make_unique<DeviceBuffer>(*memory)});
    return imports_.back().buffer->name();
  }

  int device_;
  std::shared_ptr<DevicePool> pool_;
  const Simulation* simulation_ = nullptr;  // that leaves its positions in next_
  std::shared_ptr<Store> next_;             // of the next snapshot
  std::vector<Import> imports_;
  std::deque<InUse> in_use_;  // oldest first
};

}  // namespace

int cuda_device_of_current_context() {
  unsigned count = 0;
  int device = -1;
  if (cudaGLGetDevices(&count, &device, 1, cudaGLDeviceListAll) == cudaSuccess && count > 0) return device;
  (void)cudaGetLastError();
  return -1;
}

std::unique_ptr<PositionBridge> make_cuda_bridge(int simulating) {
  if (simulating < 0) throw NoInterop("the robots are not on one CUDA device");
  const int drawing = cuda_device_of_current_context();
  if (drawing < 0) throw NoInterop("OpenGL does not draw on a GPU that CUDA knows");
  if (drawing != simulating)
    throw NoInterop("CUDA device " + std::to_string(simulating) + " simulates, device " + std::to_string(drawing) +
                    " draws");
  check(cudaSetDevice(simulating), "choosing the device");
  check(cudaFree(nullptr), "starting the device");
  return std::make_unique<CudaBridge>(simulating);
}

}  // namespace mercury
