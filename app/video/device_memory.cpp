// SPDX-License-Identifier: Apache-2.0
#include "app/video/device_memory.h"

#include <epoxy/gl.h>  // before CUDA's header, which would bring another OpenGL header

#include <cuda.h>
#include <cuda_runtime_api.h>
#include <unistd.h>

#include <algorithm>
#include <string>

#include "app/video/position_bridge.h"
#include "mercury/error.h"

namespace mercury {
namespace {

// A function of CUDA's driver, found at run time: the program must also start where there is no driver.
template <class Function>
Function* driver_function(const char* name) {
  void* function = nullptr;
#if CUDART_VERSION >= 12050
  const cudaError_t error = cudaGetDriverEntryPointByVersion(name, &function, 12000, cudaEnableDefault, nullptr);
#elif CUDART_VERSION >= 12000
  const cudaError_t error = cudaGetDriverEntryPoint(name, &function, cudaEnableDefault, nullptr);
#else
  const cudaError_t error = cudaGetDriverEntryPoint(name, &function, cudaEnableDefault);
#endif
  if (error == cudaSuccess && function) return reinterpret_cast<Function*>(function);
  (void)cudaGetLastError();
  throw NoInterop(std::string("CUDA's driver has no ") + name);
}

struct Driver {
  decltype(cuMemGetAllocationGranularity)* granularity;
  decltype(cuMemCreate)* create;
  decltype(cuMemRelease)* release;
  decltype(cuMemAddressReserve)* reserve;
  decltype(cuMemAddressFree)* free;
  decltype(cuMemMap)* map;
  decltype(cuMemUnmap)* unmap;
  decltype(cuMemSetAccess)* set_access;
  decltype(cuMemExportToShareableHandle)* export_handle;
};

const Driver& driver() {
  static const Driver found{
      driver_function<decltype(cuMemGetAllocationGranularity)>("cuMemGetAllocationGranularity"),
      driver_function<decltype(cuMemCreate)>("cuMemCreate"),
      driver_function<decltype(cuMemRelease)>("cuMemRelease"),
      driver_function<decltype(cuMemAddressReserve)>("cuMemAddressReserve"),
      driver_function<decltype(cuMemAddressFree)>("cuMemAddressFree"),
      driver_function<decltype(cuMemMap)>("cuMemMap"),
      driver_function<decltype(cuMemUnmap)>("cuMemUnmap"),
      driver_function<decltype(cuMemSetAccess)>("cuMemSetAccess"),
      driver_function<decltype(cuMemExportToShareableHandle)>("cuMemExportToShareableHandle"),
  };
  return found;
}

bool done(CUresult result, const char* what) {
  if (result == CUDA_ERROR_OUT_OF_MEMORY) throw DeviceError(std::string("CUDA: ") + what + ": out of memory");
  return result == CUDA_SUCCESS;
}

}  // namespace

DeviceMemory::DeviceMemory(int cuda_device, std::size_t bytes) {
  const Driver& cuda = driver();
  CUmemAllocationProp wanted{};
  wanted.type = CU_MEM_ALLOCATION_TYPE_PINNED;
  wanted.location = {.type = CU_MEM_LOCATION_TYPE_DEVICE, .id = cuda_device};
  wanted.requestedHandleTypes = CU_MEM_HANDLE_TYPE_POSIX_FILE_DESCRIPTOR;
  std::size_t unit = 0;
  if (!done(cuda.granularity(&unit, &wanted, CU_MEM_ALLOC_GRANULARITY_MINIMUM), "asking for page sizes") || unit == 0)
    throw NoInterop("CUDA cannot share memory on this GPU");
  size_ = (std::max<std::size_t>(bytes, 1) + unit - 1) / unit * unit;
  const char* const what = "allocating memory to share with OpenGL";
  CUmemGenericAllocationHandle handle = 0;
  if (!done(cuda.create(&handle, size_, &wanted, 0), what)) throw NoInterop("CUDA cannot share memory on this GPU");
  handle_ = handle;
  CUdeviceptr address = 0;
  const CUmemAccessDesc access{.location = wanted.location, .flags = CU_MEM_ACCESS_FLAGS_PROT_READWRITE};
  const bool reserved = cuda.reserve(&address, size_, 0, 0, 0) == CUDA_SUCCESS;
  const bool mapped = reserved && cuda.map(address, size_, 0, handle, 0) == CUDA_SUCCESS;
  if (mapped && cuda.set_access(address, size_, &access, 1) == CUDA_SUCCESS) {
    address_ = address;
    return;
  }
  if (mapped) cuda.unmap(address, size_);
  if (reserved) cuda.free(address, size_);
  cuda.release(handle);
  throw DeviceError(std::string("CUDA: ") + what + " failed");
}

DeviceMemory::~DeviceMemory() {
  const Driver& cuda = driver();
  cuda.unmap(address_, size_);
  cuda.free(address_, size_);
  cuda.release(handle_);
}

int DeviceMemory::file_descriptor() const {
  int descriptor = -1;
  if (driver().export_handle(&descriptor, handle_, CU_MEM_HANDLE_TYPE_POSIX_FILE_DESCRIPTOR, 0) != CUDA_SUCCESS)
    throw NoInterop("CUDA cannot export memory on this GPU");
  return descriptor;
}

DeviceBuffer::DeviceBuffer(const DeviceMemory& memory) {
  if (!epoxy_has_gl_extension("GL_EXT_memory_object_fd")) throw NoInterop("OpenGL here has no GL_EXT_memory_object_fd");
  while (glGetError() != GL_NO_ERROR) {
  }
  const int descriptor = memory.file_descriptor();
  glCreateMemoryObjectsEXT(1, &memory_);
  glImportMemoryFdEXT(memory_, memory.size(), GL_HANDLE_TYPE_OPAQUE_FD_EXT, descriptor);
  if (glGetError() != GL_NO_ERROR) {
    close(descriptor);  // OpenGL owns it only after a success
    glDeleteMemoryObjectsEXT(1, &memory_);
    throw NoInterop("OpenGL does not take CUDA's memory");
  }
  glCreateBuffers(1, &buffer_);
  glNamedBufferStorageMemEXT(buffer_, static_cast<GLsizeiptr>(memory.size()), memory_, 0);
  if (glGetError() == GL_NO_ERROR) return;
  glDeleteBuffers(1, &buffer_);
  glDeleteMemoryObjectsEXT(1, &memory_);
  throw NoInterop("OpenGL makes no buffer of CUDA's memory");
}

DeviceBuffer::~DeviceBuffer() {
  glDeleteBuffers(1, &buffer_);
  glDeleteMemoryObjectsEXT(1, &memory_);
}

}  // namespace mercury
