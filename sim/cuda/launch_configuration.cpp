// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/launch_configuration.h"

#include <algorithm>

#include "sim/cuda/block_layout.h"
#include "sim/cuda/device_limits.h"

namespace mercury::cuda {
namespace {

// Takes as many copies of the material table as leave room for `blocks` blocks on a multiprocessor. Returns false if
// not even one copy does.
bool fit(LaunchConfiguration& launch, std::uint32_t tiles, std::uint32_t fields, const DeviceLimits& limits,
         std::uint32_t blocks) {
  for (const std::uint32_t bits : {4u, 3u, 2u, 1u, 0u}) {
    launch.table_copy_bits = bits;
    launch.shared_bytes = block_layout(launch, tiles, fields).total;
    if (launch.shared_bytes <= limits.shared_per_block &&
        blocks * (launch.shared_bytes + limits.reserved_per_block) <= limits.shared_per_multiprocessor)
      return true;
  }
  return false;
}

// Small robots: several per block, as long as at least two blocks fill the multiprocessor's warps.
bool fit_several(LaunchConfiguration& launch, std::uint32_t tiles, std::uint32_t fields, const DeviceLimits& limits,
                 std::uint32_t robots) {
  launch.warps_per_robot = even_warps(tiles, resident_warps / 2);
  for (std::uint32_t n = std::min(resident_warps / 2 / launch.warps_per_robot, robots); n > 0; --n) {
    launch.robots_per_block = n;
    if (fit(launch, tiles, fields, limits, resident_warps / (n * launch.warps_per_robot))) return true;
  }
  return false;
}

// Large robots: one per block and multiprocessor.
bool fit_one(LaunchConfiguration& launch, std::uint32_t tiles, std::uint32_t fields, const DeviceLimits& limits) {
  launch.robots_per_block = 1;
  launch.warps_per_robot = divide_up(tiles, divide_up(tiles, resident_warps));
  return fit(launch, tiles, fields, limits, 1);
}

}  // namespace

LaunchConfiguration choose_launch_configuration(Solver solver, const Environment& environment, const BatchView& robots,
                                                bool same_materials, bool viscous, std::size_t batch_size,
                                                std::uint32_t table_chunks) {
  const DeviceLimits limits = device_limits();
  const std::uint32_t tiles = robots.tile_stride;
  LaunchConfiguration launch;
  launch.shared_table = same_materials;
  launch.viscous = viscous;
  launch.table_chunks = table_chunks;
  launch.record_words = robots.record_words;
  launch.contact_buckets = contact_buckets(environment, tiles);
  const std::uint32_t all_fields = working_fields(solver, true);
  // With fewer robots than multiprocessors, each robot gets a multiprocessor to itself.
  if (batch_size > limits.multiprocessors && fit_several(launch, tiles, all_fields, limits, robots.robot_count))
    return launch;
  for (const bool contacts_on_chip : {true, false})
    for (const bool valence_on_chip : {true, false}) {
      launch.contacts_on_chip = contacts_on_chip;
      launch.valence_on_chip = valence_on_chip;
      if (fit_one(launch, tiles, working_fields(solver, valence_on_chip), limits)) return launch;
    }
  launch.on_chip = false;
  launch.valence_on_chip = true;
  fit_one(launch, tiles, all_fields, limits);
  return launch;
}

}  // namespace mercury::cuda
