// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/launch_configuration.h"

#include <algorithm>
#include <type_traits>
#include <variant>

#include "sim/cuda/block_layout.h"
#include "sim/cuda/device_limits.h"
#include "sim/physics/environments.h"

namespace mercury::cuda {
namespace {

// Copies of a robot's own table are written in every step, which costs small robots more than the conflicts of fewer
// copies: with 7 chunks, 16 copies cost robots of 61 rows 16 % of their speed and one copy 7 %, but robots of 445 rows
// 0.6 % and 6 %. Springs of real bodies compute more beside each read: one copy is as fast or faster for any size.
bool writes_more_than_it_reads(const LaunchConfiguration& launch, std::uint32_t rows) {
  constexpr std::uint32_t most_rows = 128;
  return !launch.shared_table && (launch.viscous || rows < most_rows);
}

void share_tiles(LaunchConfiguration& launch, std::uint32_t tiles, std::uint32_t warps) {
  launch.warps_per_robot = warps;
  launch.inverse_warps = 65536 / warps + 1;
  launch.even_tiles = tiles % warps == 0;
}

// Those warps of a robot should write the material table that have less to do: of tiles and face tiles, of which the
// first ones have more or less than the last (first_tile_of(), faces.cuh). With many robots per block the last ones are
// faster all the same (docs/experiments.md).
bool first_warps_have_less(const LaunchConfiguration& launch, std::uint32_t tiles, std::uint32_t face_tiles) {
  constexpr std::uint32_t most_robots = 4, work_of_tile = 3;  // that of a face tile is 1
  const std::uint32_t warps = launch.warps_per_robot;
  if (launch.robots_per_block > most_robots) return false;
  const auto work_of = [&](std::uint32_t warp) {
    const std::uint32_t turn = launch.even_tiles ? warps - 1 - warp : warp;
    const std::uint32_t own_tiles = first_tile_of(warp + 1, tiles, warps) - first_tile_of(warp, tiles, warps);
    return work_of_tile * own_tiles + (face_tiles + warps - 1 - turn) / warps;
  };
  std::uint32_t first = 0, last = 0;
  for (std::uint32_t i = 0; i < std::min(warps, divide_up(launch.table_chunks, launch.robots_per_block)); ++i) {
    first += work_of(i);
    last += work_of(warps - 1 - i);
  }
  return first < last;
}

// Takes as many copies of the material table as leave room for `blocks` blocks on a multiprocessor. Returns false if
// not even one copy does.
bool fit_tables(LaunchConfiguration& launch, const BatchView& robots, std::uint32_t fields, const DeviceLimits& limits,
                std::uint32_t blocks) {
  const std::uint32_t tiles = robots.tile_stride;
  const std::uint32_t whole = limits.shared_per_multiprocessor;
  const auto fits = [&](std::uint32_t bits, std::uint32_t most) {
    launch.table_copy_bits = bits;
    launch.bytes_per_material = parameter_bytes << bits;
    launch.shared_bytes = block_layout(launch, tiles, fields).total;
    const std::size_t bytes = blocks * (launch.shared_bytes + limits.reserved_per_block);
    if (launch.shared_bytes > limits.shared_per_block || bytes > most) return false;
    launch.shared_percent = std::min(100u, static_cast<std::uint32_t>(100 * bytes / whole) + 1);
    return true;
  };
  if (writes_more_than_it_reads(launch, robots.group_stride * rows_at_once)) return fits(0, whole);
  // 8 copies and an eighth more to cache with are faster than 16 copies.
  if (fits(4, whole / 8 * 7) || fits(3, whole / 8 * 7)) return true;
  for (const std::uint32_t bits : {4u, 3u, 2u, 1u, 0u})
    if (fits(bits, whole)) return true;
  return false;
}

// The same with as much of a brain as there is room for: its scratch at least, if masses are on the chip. Weights that
// leave less than an eighth to cache with are cached instead.
bool fit(LaunchConfiguration& launch, const BatchView& robots, std::uint32_t fields, const DeviceLimits& limits,
         std::uint32_t blocks, const BrainBytes& brain) {
  const auto fits = [&](const BrainBytes& part) {
    launch.brain = part;
    return fit_tables(launch, robots, fields, limits, blocks);
  };
  if (!fits(launch.on_chip ? BrainBytes{brain.scratch, 0, 0} : BrainBytes{})) return false;
  if (!launch.on_chip || brain.scratch == 0) return true;
  const LaunchConfiguration least = launch;
  const std::uint32_t most = limits.shared_per_multiprocessor / 8 * 7;
  for (const std::uint32_t weights : {brain.weights, 0u})
    if (fits({brain.scratch, brain.tables, weights}) && launch.table_copy_bits == least.table_copy_bits &&
        (weights == 0 || blocks * (launch.shared_bytes + limits.reserved_per_block) <= most))
      return true;
  launch = least;
  return true;
}

// Such kernels have no robots apart (step.cu). Where only masses differ from the paper's, this is not seen here, and
// robots wait for each other all the same.
bool kernel_has_contacts(const Configuration& configuration, bool viscous) {
  return std::visit([](const auto& model) { return std::decay_t<decltype(model)>::has_contacts; },
                    solver_model_of(configuration, viscous));
}

// Small robots: several per block. Robots that are apart fill a multiprocessor's warps in one block, so that all share
// one table. Others do in two, so that one computes while the other waits at a barrier; so do robots beside other size
// classes, since a large block would wait until a multiprocessor is empty. Robots that would wait for each other and
// share no table have blocks of their own.
bool fit_several(LaunchConfiguration& launch, const BatchView& robots, std::uint32_t fields, const DeviceLimits& limits,
                 std::size_t batch_size, const BrainBytes& brain, std::uint32_t face_tiles) {
  const std::size_t robots_each = (batch_size + limits.multiprocessors - 1) / limits.multiprocessors;
  const auto share = static_cast<std::uint32_t>(std::max(resident_warps / robots_each, std::size_t{1}));
  share_tiles(launch, robots.tile_stride, even_warps(robots.tile_stride, resident_warps / 2, share));
  const std::uint32_t warps = launch.warps_per_robot, most = resident_warps / warps;
  const bool can_be_apart = launch.apart;
  const auto fits = [&](std::uint32_t n) {
    launch.robots_per_block = n;
    launch.apart = can_be_apart && n > 1;
    launch.first_warps_write = first_warps_have_less(launch, robots.tile_stride, face_tiles);
    return fit(launch, robots, fields, limits, most / n, brain);
  };
  if (!can_be_apart && !launch.shared_table) {
    for (std::uint32_t n = divide_up(most, limits.blocks_per_multiprocessor); n <= most; ++n)
      if (fits(n)) return true;
    return false;
  }
  const bool whole_batch = robots.robot_count == batch_size;
  const std::uint32_t blocks = can_be_apart && whole_batch ? 1u : 2u;
  // All multiprocessors have as many robots in each round, and enough to fill a common table together.
  const std::size_t at_once = std::size_t{most / blocks * blocks} * limits.multiprocessors;
  const std::size_t rounds = (batch_size + at_once - 1) / at_once, places = rounds * blocks * limits.multiprocessors;
  auto n = static_cast<std::uint32_t>((batch_size + places - 1) / places);
  if (launch.shared_table) n = std::max(n, divide_up(launch.table_chunks, warps));
  if (!whole_batch) n = most;
  for (n = std::min({n, most / blocks, robots.robot_count}); n > 0; --n)
    if (fits(n)) return true;
  return false;
}

// Large robots: one per block and multiprocessor.
bool fit_one(LaunchConfiguration& launch, const BatchView& robots, std::uint32_t fields, const DeviceLimits& limits,
             const BrainBytes& brain) {
  const std::uint32_t tiles = robots.tile_stride;
  launch.robots_per_block = 1;
  launch.apart = launch.first_warps_write = false;
  share_tiles(launch, tiles, divide_up(tiles, divide_up(tiles, resident_warps)));
  return fit(launch, robots, fields, limits, 1, brain);
}

}  // namespace

LaunchConfiguration choose_launch_configuration(const Configuration& configuration, const BatchView& robots,
                                                bool same_materials, bool viscous, std::size_t batch_size,
                                                std::uint32_t table_chunks, const BrainBytes& brain) {
  const DeviceLimits limits = device_limits();
  const std::uint32_t tiles = robots.tile_stride;
  LaunchConfiguration launch;
  launch.shared_table = same_materials;
  launch.viscous = viscous;
  launch.table_chunks = table_chunks;
  launch.record_words = robots.record_words;
  launch.contact_buckets = contact_buckets(configuration.environment, tiles);
  launch.apart = !kernel_has_contacts(configuration, viscous);
  const auto fields = [&] { return working_fields(configuration.solver, launch.valence_on_chip); };
  const std::uint32_t face_tiles =
      has_face_forces(configuration.environment) ? divide_up(robots.face_stride, lanes) : 0;
  // With fewer robots than multiprocessors, each robot gets a multiprocessor to itself.
  if (batch_size > limits.multiprocessors &&
      fit_several(launch, robots, fields(), limits, batch_size, brain, face_tiles))
    return launch;
  for (const bool contacts_on_chip : {true, false})
    for (const bool valence_on_chip : {true, false}) {
      launch.contacts_on_chip = contacts_on_chip;
      launch.valence_on_chip = valence_on_chip;
      if (fit_one(launch, robots, fields(), limits, brain)) return launch;
    }
  launch.on_chip = false;
  launch.valence_on_chip = true;
  fit_one(launch, robots, fields(), limits, brain);
  return launch;
}

bool is_faster_in_parts(const LaunchConfiguration& whole, std::uint32_t tiles, std::size_t batch_size) {
  const std::uint32_t multiprocessors = device_limits().multiprocessors;
  return (tiles >= (whole.contact_buckets > 0 ? 64 : 40) && 8 * batch_size <= multiprocessors) ||
         (tiles >= 128 && 2 * batch_size <= multiprocessors);
}

std::optional<LaunchConfiguration> choose_launch_in_parts(const Configuration& configuration, const BatchView& parts,
                                                          bool same_materials, bool viscous, std::uint32_t table_chunks,
                                                          std::uint32_t blocks) {
  LaunchConfiguration launch;
  launch.parts = parts.parts.per_robot;
  launch.contact_buckets = contact_buckets(configuration.environment, parts.parts.robot_tile_stride);
  launch.shared_table = same_materials;
  launch.viscous = viscous;
  launch.table_chunks = table_chunks;
  launch.record_words = parts.record_words;
  share_tiles(launch, parts.tile_stride,
              divide_up(parts.tile_stride, divide_up(parts.tile_stride, resident_warps / blocks)));
  const std::uint32_t fields = working_fields(configuration.solver, true);
  if (fit(launch, parts, fields, device_limits(), blocks, {})) return launch;
  return std::nullopt;
}

}  // namespace mercury::cuda
