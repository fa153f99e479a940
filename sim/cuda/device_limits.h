// SPDX-License-Identifier: Apache-2.0
// What the current CUDA device offers.
#pragma once

#include <cstdint>

#include "mercury/configuration.h"

namespace mercury::cuda {

struct DeviceLimits {
  std::uint32_t shared_per_block;           // [bytes]
  std::uint32_t shared_per_multiprocessor;  // [bytes]
  std::uint32_t reserved_per_block;         // by the system, of the multiprocessor's shared memory [bytes]
  std::uint32_t multiprocessors;
  std::uint32_t blocks_per_multiprocessor;  // of a step kernel with contacts, if they are small
  bool clusters;                            // whether blocks can reach each other's shared memory
};

DeviceLimits device_limits();

// Springs per second if the shared memory pipe were the only limit. A row of 32 springs takes ten passes through it:
// one for the records, three for the partners' positions, one for the rest lengths, two for the material parameters and
// three for the reactions. XPBD reads the valences too.
double spring_limit(Solver solver);

}  // namespace mercury::cuda
