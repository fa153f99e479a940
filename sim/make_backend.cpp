// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>
#include <vector>

#include "mercury/backend.h"
#include "mercury/cuda_devices.h"
#include "sim/devices.h"

namespace mercury {

std::vector<Device> single_devices(const Device& device) {
  const bool cuda =
      device.kind == DeviceKind::cuda || (device.kind == DeviceKind::automatic && cuda_device_count() > device.index);
  if (!cuda) return {{.kind = DeviceKind::cpu, .threads = device.threads}};
  if (device.index != Device::all_devices) return {{.kind = DeviceKind::cuda, .index = device.index}};
  std::vector<Device> devices;
  // Without any device, make_cuda_backend() throws the error that says so.
  for (int index = 0; index < std::max(1, cuda_device_count()); ++index)
    devices.push_back({.kind = DeviceKind::cuda, .index = index});
  return devices;
}

std::string joined_device_names(std::span<const std::string> names) {
  std::string joined;
  for (std::size_t first = 0, last = 0; first < names.size(); first = last) {
    while (last < names.size() && names[last] == names[first]) ++last;
    joined +=
        (joined.empty() ? "" : ", ") + (last - first > 1 ? std::to_string(last - first) + " x " : "") + names[first];
  }
  return joined;
}

std::unique_ptr<Backend> make_backend(const Device& device) {
  std::vector<std::unique_ptr<Backend>> parts;
  for (const Device& single : single_devices(device))
    parts.push_back(single.kind == DeviceKind::cpu ? make_cpu_backend(single) : make_cuda_backend(single));
  return make_split_backend(std::move(parts));
}

}  // namespace mercury
