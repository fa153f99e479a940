// SPDX-License-Identifier: Apache-2.0
// How the shared memory of a block is dealt out. Knows no CUDA, so that every build can tell what a robot needs.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <variant>
#include <vector>

#include "mercury/configuration.h"
#include "mercury/host_device.h"
#include "mercury/robot.h"
#include "sim/cuda/layout.h"

namespace mercury::cuda {

// Groups of 32 that a robot's masses fill.
inline std::uint32_t groups_of(const Robot& robot) {
  return static_cast<std::uint32_t>((robot.masses.size() + lanes - 1) / lanes);
}

// The different rest lengths of a robot in ascending order, 0 of empty places first; cut off behind max_lengths + 1.
std::vector<float> lengths_of(const Robot& robot);

// What a block has and does.
struct Shape {
  std::uint32_t robots_per_block = 1;
  std::uint32_t warps_per_robot = 1;
  std::uint32_t table_copy_bits = 0;  // 2^this many copies of the material table, at most 16
  bool shared_table = false;          // all robots of the batch have the same materials
  bool on_chip = true;                // masses in shared memory, else in the workspace
  bool splits_on_chip = true;         // and beside them the number of springs at each, which XPBD needs
  std::uint32_t contact_buckets = 0;  // a power of two, or 0 = no self-collision
  std::uint32_t record_words = 2;     // of the batch
  bool contacts_on_chip = true;       // else behind the working memory in the workspace
  std::size_t shared_bytes = 0;
};

// What a spring of one material is at the present step.
struct alignas(8) SpringLaw {
  float hardness;  // stiffness [N/m], or 1/(k dt^2) [1/kg]
  float factor;    // L / L0
};

// Shared memory of a block, in this order: material tables, failures, rest lengths, contact buckets and lists, working
// memory of its robots. Ends of the parts in bytes.
struct BlockLayout {
  std::uint32_t tables, failures, lengths, contacts, total;
};

// Pairs of near masses that are kept; if there are more, the cell grid is asked every step.
inline constexpr std::uint32_t contact_list_size = 1023;

// Buckets of the grid in which a robot of so many groups looks for masses that touch; 0 where they may not.
inline std::uint32_t contact_buckets(const Environment& environment, std::uint32_t groups) {
  const Land* land = std::get_if<Land>(&environment);
  return land && land->self_collision && land->contact_stiffness > 0 ? std::bit_ceil(groups * lanes) : 0;
}

// The list and its length, the buckets, and a link a mass (contacts.cuh).
MERCURY_HOST_DEVICE std::uint32_t contact_bytes(std::uint32_t buckets, std::uint32_t groups) {
  return buckets == 0 ? 0 : (1 + contact_list_size + buckets) * 4 + groups * lanes * 2;
}

MERCURY_HOST_DEVICE BlockLayout block_layout(const Shape& shape, std::uint32_t groups, std::uint32_t rows) {
  BlockLayout layout{};
  const std::uint32_t tables = shape.shared_table ? 1 : shape.robots_per_block;
  layout.tables = (tables * max_materials * static_cast<std::uint32_t>(sizeof(SpringLaw))) << shape.table_copy_bits;
  layout.failures = layout.tables + shape.robots_per_block * 16;
  layout.lengths = layout.failures + (shape.record_words == 1 ? shape.robots_per_block * max_lengths * 4 : 0);
  layout.contacts = layout.lengths;
  if (shape.contacts_on_chip) layout.contacts += shape.robots_per_block * contact_bytes(shape.contact_buckets, groups);
  layout.total = layout.contacts;
  if (shape.on_chip) layout.total += shape.robots_per_block * groups * rows * row_bytes;
  return layout;
}

}  // namespace mercury::cuda
