// SPDX-License-Identifier: Apache-2.0
// One kernel per source file kernel_*.cpp.
#pragma once

#include "sim/cpu/kernels/kernel.h"

namespace mercury::cpu {

extern const Kernel portable_kernel, sse4_kernel, avx2_kernel, avx512_kernel, neon_kernel;

}  // namespace mercury::cpu
