// SPDX-License-Identifier: Apache-2.0
// The devices that a configuration asks for, one by one.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "mercury/configuration.h"

namespace mercury {

// The CPU, a CUDA device, or all CUDA devices. At least one; whether it exists turns out when a backend is made.
std::vector<Device> single_devices(const Device& device);

// "2 x NVIDIA H100 80GB HBM3": the names of several devices as one.
std::string joined_device_names(std::span<const std::string> names);

}  // namespace mercury
