// SPDX-License-Identifier: Apache-2.0
// Copies positions from CUDA's memory into OpenGL's, on the GPU that both use.
#include <epoxy/gl.h>  // before CUDA's header, which would bring another OpenGL header

#include <cuda_gl_interop.h>
#include <cuda_runtime_api.h>

#include <mutex>
#include <string>
#include <vector>

#include "app/video/position_bridge.h"
#include "mercury/error.h"

namespace mercury {
namespace {

void check(cudaError_t error, const char* what) {
  if (error != cudaSuccess) throw DeviceError(std::string("CUDA: ") + what + ": " + cudaGetErrorString(error));
}

// Floats in device memory.
class DeviceFloats {
 public:
  explicit DeviceFloats(std::size_t size) : size_(size) {
    if (size > 0) check(cudaMalloc(reinterpret_cast<void**>(&data_), size * sizeof(float)), "allocating device memory");
  }
  ~DeviceFloats() { cudaFree(data_); }
  DeviceFloats(const DeviceFloats&) = delete;
  DeviceFloats& operator=(const DeviceFloats&) = delete;

  float* data() const { return data_; }
  std::size_t size() const { return size_; }

 private:
  float* data_ = nullptr;
  std::size_t size_ = 0;
};

// A point in a stream that other streams can wait for.
class Mark {
 public:
  Mark() { check(cudaEventCreateWithFlags(&event_, cudaEventDisableTiming), "making an event"); }
  ~Mark() { cudaEventDestroy(event_); }
  Mark(const Mark&) = delete;
  Mark& operator=(const Mark&) = delete;
  void set(cudaStream_t stream) { check(cudaEventRecord(event_, stream), "recording an event"); }
  // Later work in this stream waits for the mark; a mark that was never set blocks nothing.
  void block(cudaStream_t stream) const { check(cudaStreamWaitEvent(stream, event_, 0), "waiting for an event"); }

 private:
  cudaEvent_t event_ = nullptr;
};

// A stream that runs beside the simulation's.
class Stream {
 public:
  Stream() {
    int least = 0, greatest = 0;
    check(cudaDeviceGetStreamPriorityRange(&least, &greatest), "asking for priorities");
    check(cudaStreamCreateWithPriority(&stream_, cudaStreamNonBlocking, greatest), "making a stream");
  }
  ~Stream() {
    cudaStreamSynchronize(stream_);
    cudaStreamDestroy(stream_);
  }
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;
  cudaStream_t get() const { return stream_; }

 private:
  cudaStream_t stream_ = nullptr;
};

// An OpenGL buffer as CUDA knows it.
class SharedBuffer {
 public:
  explicit SharedBuffer(GLuint name) {
    const cudaError_t error = cudaGraphicsGLRegisterBuffer(&resource_, name, cudaGraphicsRegisterFlagsWriteDiscard);
    if (error == cudaSuccess) return;
    (void)cudaGetLastError();
    throw NoInterop(std::string("CUDA does not take OpenGL's buffer: ") + cudaGetErrorString(error));
  }
  ~SharedBuffer() { cudaGraphicsUnregisterResource(resource_); }
  SharedBuffer(const SharedBuffer&) = delete;
  SharedBuffer& operator=(const SharedBuffer&) = delete;

  // Overwrites its beginning, in order with the OpenGL calls around this one.
  void fill(const DeviceFloats& values, cudaStream_t stream) {
    check(cudaGraphicsMapResources(1, &resource_, stream), "taking OpenGL's buffer");
    void* memory = nullptr;
    std::size_t bytes = 0;
    check(cudaGraphicsResourceGetMappedPointer(&memory, &bytes, resource_), "finding OpenGL's buffer");
    const std::size_t wanted = values.size() * sizeof(float);
    if (bytes < wanted) throw std::logic_error("the renderer's bodies are not those of the simulation");
    const cudaError_t copied = cudaMemcpyAsync(memory, values.data(), wanted, cudaMemcpyDeviceToDevice, stream);
    check(cudaGraphicsUnmapResources(1, &resource_, stream), "giving OpenGL's buffer back");
    check(copied, "copying positions");
  }

 private:
  cudaGraphicsResource_t resource_ = nullptr;
};

// Device memory of one snapshot.
struct Store {
  explicit Store(std::size_t masses) : positions(3 * masses) {}
  DeviceFloats positions;
  Mark taken, shown;  // the snapshot is complete; it has been copied to OpenGL
};

// Memory of finished snapshots; the next ones use it again.
class Pool {
 public:
  std::unique_ptr<Store> take(std::size_t masses) {
    const std::lock_guard lock(mutex_);
    while (!free_.empty()) {
      std::unique_ptr<Store> store = std::move(free_.back());
      free_.pop_back();
      if (store->positions.size() == 3 * masses) return store;
    }
    return std::make_unique<Store>(masses);
  }
  void put(std::unique_ptr<Store> store) {
    const std::lock_guard lock(mutex_);
    free_.push_back(std::move(store));
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<Store>> free_;
};

class CudaSnapshot final : public PositionSnapshot {
 public:
  CudaSnapshot(std::shared_ptr<Pool> pool, const Simulation& simulation)
      : pool_(std::move(pool)), store_(pool_->take(simulation.mass_count())) {
    // The simulation's kernels run in the same stream, so the copy lies between the earlier and the later steps.
    store_->shown.block(cudaStreamLegacy);
    simulation.copy_positions(store_->positions.data());
    store_->taken.set(cudaStreamLegacy);
  }
  ~CudaSnapshot() override { pool_->put(std::move(store_)); }

  Store& store() const { return *store_; }

 private:
  std::shared_ptr<Pool> pool_;
  std::unique_ptr<Store> store_;
};

class CudaBridge final : public PositionBridge {
 public:
  CudaBridge(int device, GLuint buffer) : device_(device), buffer_(buffer) {}

  std::unique_ptr<PositionSnapshot> take(const Simulation& simulation) override {
    use_device();
    return std::make_unique<CudaSnapshot>(pool_, simulation);
  }

  void show(const PositionSnapshot& snapshot, render::Renderer&, render::Scene& scene) override {
    use_device();
    Store& store = dynamic_cast<const CudaSnapshot&>(snapshot).store();
    store.taken.block(stream_.get());
    buffer_.fill(store.positions, stream_.get());
    store.shown.set(stream_.get());
    scene.positions = {};
  }

 private:
  void use_device() const { check(cudaSetDevice(device_), "choosing the device"); }

  int device_;
  Stream stream_;
  SharedBuffer buffer_;
  std::shared_ptr<Pool> pool_ = std::make_shared<Pool>();
};

}  // namespace

int cuda_device_of_current_context() {
  unsigned count = 0;
  int device = -1;
  if (cudaGLGetDevices(&count, &device, 1, cudaGLDeviceListAll) == cudaSuccess && count > 0) return device;
  (void)cudaGetLastError();
  return -1;
}

std::unique_ptr<PositionBridge> make_cuda_bridge(const Simulation& simulation, const render::Renderer& renderer) {
  const int simulating = simulation.cuda_device();
  if (simulating < 0) throw NoInterop("the robots are not on one CUDA device");
  if (simulation.mass_count() == 0) throw NoInterop("there are no robots");
  const int drawing = cuda_device_of_current_context();
  if (drawing < 0) throw NoInterop("OpenGL does not draw on a card that CUDA knows");
  if (drawing != simulating)
    throw NoInterop("CUDA device " + std::to_string(simulating) + " simulates, device " + std::to_string(drawing) +
                    " draws");
  check(cudaSetDevice(simulating), "choosing the device");
  return std::make_unique<CudaBridge>(simulating, renderer.position_buffer());
}

}  // namespace mercury
