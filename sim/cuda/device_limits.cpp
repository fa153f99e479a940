// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/device_limits.h"

#include "sim/cuda/stream.h"
#include "sim/cuda/tile.h"

namespace mercury::cuda {
namespace {

int attribute(cudaDeviceAttr which) {
  int device = 0, value = 0;
  check(cudaGetDevice(&device), "querying the current device");
  check(cudaDeviceGetAttribute(&value, which, device), "querying the device's limits");
  return value;
}

}  // namespace

DeviceLimits device_limits() {
  // Before, a block may have taken all named barriers (SplitBarrier::exists), of which there are 64.
  constexpr std::uint32_t with_split_barriers = 8, without = 4;
  const auto limit = [](cudaDeviceAttr which) { return static_cast<std::uint32_t>(attribute(which)); };
  return {.shared_per_block = limit(cudaDevAttrMaxSharedMemoryPerBlockOptin),
          .shared_per_multiprocessor = limit(cudaDevAttrMaxSharedMemoryPerMultiprocessor),
          .reserved_per_block = limit(cudaDevAttrReservedSharedMemoryPerBlock),
          .multiprocessors = limit(cudaDevAttrMultiProcessorCount),
          .blocks_per_multiprocessor = limit(cudaDevAttrComputeCapabilityMajor) < with_split_barriers
                                           ? without
                                           : limit(cudaDevAttrMaxBlocksPerMultiprocessor),
          .clusters = attribute(cudaDevAttrClusterLaunch) != 0};
}

double spring_limit(Solver solver) {
  const double hertz = 1e3 * attribute(cudaDevAttrClockRate);
  const double passes = solver == Solver::force ? 10 : 11;
  return hertz * device_limits().multiprocessors * lanes / passes;
}

}  // namespace mercury::cuda
