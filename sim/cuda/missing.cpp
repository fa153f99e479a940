// SPDX-License-Identifier: Apache-2.0
// The CUDA backend of a build without nvcc: there are no devices.
#include "mercury/cuda_devices.h"
#include "mercury/error.h"
#include "mercury/prepared_robots.h"

namespace mercury {

void prepare_cuda_for(double) {}
void require_cuda_device(int) {
  throw DeviceError("this build has no CUDA backend; build with nvcc on PATH, or use the device \"cpu\"");
}
std::unique_ptr<Backend> make_cuda_backend(const Device& device, std::shared_ptr<PreparedRobots>) {
  require_cuda_device(device.index);
  return nullptr;
}
std::unique_ptr<Backend> make_cuda_backend(const Device& device) { return make_cuda_backend(device, nullptr); }
std::shared_ptr<PreparedRobots> prepare_for_cuda() { return nullptr; }
ChipFit chip_fit(const Robot&, const Configuration&, int) { throw DeviceError("this build has no CUDA backend"); }
int cuda_device_count() { return 0; }
std::string cuda_device_name(int) { return {}; }
std::size_t free_cuda_memory(int) { throw DeviceError("this build has no CUDA backend"); }
void synchronize_cuda_device(int) { throw DeviceError("this build has no CUDA backend"); }
void copy_cuda_memory(void*, const void*, std::size_t) { throw DeviceError("this build has no CUDA backend"); }
bool built_with_cuda() { return false; }

}  // namespace mercury
