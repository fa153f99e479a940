// SPDX-License-Identifier: Apache-2.0
// How a step kernel is launched: robots and warps per block, and what lies in shared memory. Needs no CUDA, so that
// every build can compute what a robot needs.
#pragma once

#include <cstddef>
#include <cstdint>

#include "mercury/configuration.h"
#include "sim/cuda/layout.h"

namespace mercury::cuda {

struct LaunchConfiguration {
  std::uint32_t robots_per_block = 1;
  std::uint32_t warps_per_robot = 1;
  std::uint32_t table_copy_bits = 0;  // 2^this many copies of the material table, at most 16
  bool shared_table = false;          // all robots of the batch have the same materials
  bool on_chip = true;                // working memory in shared memory, else in the workspace
  bool valence_on_chip = true;        // with field_valence, which XPBD reads
  std::uint32_t contact_buckets = 0;  // a power of two, or 0 = no self-collision
  std::uint32_t record_words = 2;     // of the batch
  bool contacts_on_chip = true;       // else after the working memory in the workspace
  std::size_t shared_bytes = 0;
};

// The configuration that keeps most robots in flight on the present device, beside the rest of `batch_size` robots.
LaunchConfiguration choose_launch_configuration(Solver solver, const Environment& environment, const BatchView& robots,
                                                bool same_materials, std::size_t batch_size);

}  // namespace mercury::cuda
