// SPDX-License-Identifier: Apache-2.0
// Tiles: how the masses of a robot lie in memory.
//
// A mass stands in a slot. 32 slots, one per lane of a warp, form a tile. A tile is a stack of fields; a field holds
// one 32-bit number per lane:
//
//                          lane 0     lane 1     ...    lane 31
//                        +----------+----------+-----+----------+
//   field_x      (0..2)  | x, y, z  | x, y, z  |     | x, y, z  |    state, in device memory between launches
//   field_v      (3..5)  | vx,vy,vz | vx,vy,vz |     | vx,vy,vz |
//                        +----------+----------+-----+----------+
//   field_sum    (6..8)  | integers | integers |     | integers |    working memory adds these while a robot is stepped
//   field_valence  (9)   | count    | count    |     | count    |    XPBD only
//                        +----------+----------+-----+----------+
//   bank                     0          1       ...      31
//
// 1. Slot s is lane s mod 32 of tile s / 32. One address leads to all fields of a slot: each field is a constant
//    further on, and the load instruction has room for that constant.
// 2. Shared memory has 32 banks of four bytes. A warp's access takes one pass if its lanes use different banks. All
//    fields of slot s lie in bank s mod 32, so a schedule (schedule.h) without conflicts in one field has none in
//    any.
// 3. All lists on the device (springs, faces, perturbations) name masses by their slots. Only the host knows the
//    robot's own numbers, and SlotOrder (slot_order.h) converts them.
#pragma once

#include <cstdint>

#include "mercury/configuration.h"
#include "mercury/host_device.h"

namespace mercury::cuda {

inline constexpr std::uint32_t lanes = 32;
inline constexpr std::uint32_t field_bytes = lanes * 4;

// Rows of springs that a warp loads and computes together: a group (layout.h). After the groups of the last robot comes
// an unused one, since a warp reads ahead.
inline constexpr std::uint32_t rows_at_once = 4;
constexpr std::size_t words_of_group(std::uint32_t record_words) {
  return std::size_t{rows_at_once} * lanes * record_words;
}

MERCURY_HOST_DEVICE constexpr std::uint32_t divide_up(std::uint32_t a, std::uint32_t b) { return (a + b - 1) / b; }

enum Field : std::uint32_t { field_x = 0, field_v = 3, field_sum = 6, field_valence = 9 };

// Fields of a tile in device memory: positions and velocities.
inline constexpr std::uint32_t state_fields = 6;

// Fields of a tile in working memory.
MERCURY_HOST_DEVICE constexpr std::uint32_t working_fields(Solver solver, bool keeps_valence) {
  return solver == Solver::xpbd && keeps_valence ? 10 : 9;
}

// Tiles that this many masses fill; the last one may be partly empty.
constexpr std::uint32_t tiles_for(std::size_t masses) {
  return static_cast<std::uint32_t>((masses + lanes - 1) / lanes);
}

// Where the working memory of a slot begins, in words after that of slot 0, if each tile has this many fields. With 0
// fields an offset is the slot itself.
MERCURY_HOST_DEVICE constexpr std::uint32_t offset_of_slot(std::uint32_t slot, std::uint32_t fields) {
  return fields == 0 ? slot : slot / lanes * fields * lanes + slot % lanes;
}
MERCURY_HOST_DEVICE constexpr std::uint32_t slot_at_offset(std::uint32_t offset, std::uint32_t fields) {
  return fields == 0 ? offset : offset / (fields * lanes) * lanes + offset % lanes;
}

}  // namespace mercury::cuda
