// One entry a source file kernel_*.cpp.
#pragma once

#include "sim/cpu/kernel.h"

namespace mercury::cpu {

extern const Kernel sse4_kernel, avx2_kernel, avx512_kernel;

}  // namespace mercury::cpu
