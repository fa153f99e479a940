// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>
#include <vector>

#include "mercury/backend.h"
#include "mercury/cuda_devices.h"

namespace mercury {

std::unique_ptr<Backend> make_backend(const Device& device) {
  const bool cuda =
      device.kind == DeviceKind::cuda || (device.kind == DeviceKind::automatic && cuda_device_count() > device.index);
  if (!cuda) return make_cpu_backend(device);
  if (device.index != Device::all_devices) return make_cuda_backend(device);
  std::vector<std::unique_ptr<Backend>> parts;
  // Without any device, make_cuda_backend() throws the error that says so.
  for (int index = 0; index < std::max(1, cuda_device_count()); ++index)
    parts.push_back(make_cuda_backend({.kind = DeviceKind::cuda, .index = index}));
  return make_split_backend(std::move(parts));
}

}  // namespace mercury
