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
  const std::uint32_t whole = limits.shared_per_multiprocessor;
  const auto fits = [&](std::uint32_t bits, std::uint32_t most) {
    launch.table_copy_bits = bits;
    launch.shared_bytes = block_layout(launch, tiles, fields).total;
    const std::size_t bytes = blocks * (launch.shared_bytes + limits.reserved_per_block);
    if (launch.shared_bytes > limits.shared_per_block || bytes > most) return false;
    if (launch.fits_cache) launch.shared_percent = std::min(100u, static_cast<std::uint32_t>(100 * bytes / whole) + 1);
    return true;
  };
  // 8 copies and an eighth more to cache with are faster than 16 copies.
  if (launch.fits_cache && (fits(4, whole / 8 * 7) || fits(3, whole / 8 * 7))) return true;
  for (const std::uint32_t bits : {4u, 3u, 2u, 1u, 0u})
    if (fits(bits, whole)) return true;
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

LaunchConfiguration choose_launch_configuration(const Configuration& configuration, const BatchView& robots,
                                                bool same_materials, bool viscous, std::size_t batch_size,
                                                std::uint32_t table_chunks) {
  const DeviceLimits limits = device_limits();
  const std::uint32_t tiles = robots.tile_stride;
  LaunchConfiguration launch;
  launch.shared_table = same_materials;
  launch.viscous = viscous;
  launch.table_chunks = table_chunks;
  launch.record_words = robots.record_words;
  launch.fits_cache = robots.robot_count == batch_size;
  launch.contact_buckets = contact_buckets(configuration.environment, tiles);
  const auto fields = [&] { return working_fields(configuration.solver, launch.valence_on_chip); };
  // With fewer robots than multiprocessors, each robot gets a multiprocessor to itself.
  if (batch_size > limits.multiprocessors && fit_several(launch, tiles, fields(), limits, robots.robot_count))
    return launch;
  for (const bool contacts_on_chip : {true, false})
    for (const bool valence_on_chip : {true, false}) {
      launch.contacts_on_chip = contacts_on_chip;
      launch.valence_on_chip = valence_on_chip;
      if (fit_one(launch, tiles, fields(), limits)) return launch;
    }
  launch.on_chip = false;
  launch.valence_on_chip = true;
  fit_one(launch, tiles, fields(), limits);
  return launch;
}

}  // namespace mercury::cuda
