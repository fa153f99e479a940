// SPDX-License-Identifier: Apache-2.0
// The CPU backend with a kernel of choice; make_cpu_backend() takes the best.
#pragma once

#include <memory>

#include "mercury/backend.h"
#include "sim/cpu/kernels/kernel.h"

namespace mercury::cpu {

std::unique_ptr<Backend> make_backend(const Device& device, const Kernel& kernel);

}  // namespace mercury::cpu
