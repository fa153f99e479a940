// SPDX-License-Identifier: Apache-2.0
// The CUDA backend of a build without nvcc: there are no devices.
#include "mercury/backend.h"
#include "mercury/cuda_devices.h"
#include "mercury/error.h"

namespace mercury {

std::unique_ptr<Backend> make_cuda_backend(const Device&) {
  throw DeviceError("this build has no CUDA backend; build with nvcc on PATH, or use the device \"cpu\"");
}
ChipFit chip_fit(const Robot&, const Configuration&, int) { throw DeviceError("this build has no CUDA backend"); }
int cuda_device_count() { return 0; }
std::string cuda_device_name(int) { return {}; }
std::size_t free_cuda_memory(int) { throw DeviceError("this build has no CUDA backend"); }
void synchronize_cuda_device(int) { throw DeviceError("this build has no CUDA backend"); }
void copy_cuda_memory(void*, const void*, std::size_t) { throw DeviceError("this build has no CUDA backend"); }
bool built_with_cuda() { return false; }

}  // namespace mercury
