// SPDX-License-Identifier: Apache-2.0
#include "sim/cpu/kernels/kernel.h"

#include <hwy/targets.h>

#include <vector>

namespace mercury::cpu {
namespace {

std::vector<Kernel> usable_kernels() {
  std::vector<Kernel> usable;
#if HWY_ARCH_X86
  const std::int64_t supported = hwy::SupportedTargets();
  if ((supported & HWY_AVX3) != 0) usable.push_back(avx512_kernel);
  if ((supported & HWY_AVX2) != 0) usable.push_back(avx2_kernel);
  if ((supported & HWY_SSSE3) != 0) usable.push_back(ssse3_kernel);
#elif HWY_ARCH_ARM_A64
  usable.push_back(neon_kernel);
#else
  usable.push_back(portable_kernel);
#endif
  return usable;
}

}  // namespace

std::span<const Kernel> kernels() {
  static const std::vector<Kernel> usable = usable_kernels();
  return usable;
}

}  // namespace mercury::cpu
