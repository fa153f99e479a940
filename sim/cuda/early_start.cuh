// SPDX-License-Identifier: Apache-2.0
// Kernels that follow one another in a stream without a pause ("programmatic dependent launch" of CUDA):
//
//   kernel 1   wait, let_next_kernel_start | ......... work ......... |
//   kernel 2                     start, read what is constant, wait   | work
//
// Without it, a kernel is started some microseconds after the last block of the one before has ended. Devices before
// compute capability 9.0 do that always.
#pragma once

#include <cuda_runtime_api.h>

#include "sim/cuda/stream.h"

namespace mercury::cuda {

// Until what came before in the stream has ended, and its results are visible. A kernel that is started early calls
// this before it reads or writes what other kernels of the stream write or read.
__device__ inline void wait_for_kernel_before() {
#if __CUDA_ARCH__ >= 900
  asm volatile("griddepcontrol.wait;" ::: "memory");
#endif
}

// After wait_for_kernel_before(), so that a kernel that has waited for this one has waited for all before.
__device__ inline void let_next_kernel_start() {
#if __CUDA_ARCH__ >= 900
  asm volatile("griddepcontrol.launch_dependents;");
#endif
}

inline bool kernels_can_start_early() {
  int device = 0, major = 0;
  check(cudaGetDevice(&device), "querying the current device");
  check(cudaDeviceGetAttribute(&major, cudaDevAttrComputeCapabilityMajor, device), "querying the device's limits");
  return major >= 9;
}

inline cudaLaunchAttribute early_start() {
  cudaLaunchAttribute attribute{};
  attribute.id = cudaLaunchAttributeProgrammaticStreamSerialization;
  attribute.val.programmaticStreamSerializationAllowed = 1;
  return attribute;
}

// Starts a kernel that calls wait_for_kernel_before().
template <class... Parameters, class... Arguments>
void start_early(void (*kernel)(Parameters...), unsigned blocks, unsigned threads, cudaStream_t stream,
                 const Arguments&... arguments) {
  cudaLaunchAttribute attribute = early_start();
  cudaLaunchConfig_t configuration{};
  configuration.gridDim = blocks;
  configuration.blockDim = threads;
  configuration.stream = stream;
  configuration.attrs = &attribute;
  configuration.numAttrs = kernels_can_start_early() ? 1 : 0;
  check(cudaLaunchKernelEx(&configuration, kernel, arguments...), "starting a kernel");
}

}  // namespace mercury::cuda
