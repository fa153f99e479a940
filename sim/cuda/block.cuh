// What a block of threads shares while it steps its robots.
#pragma once

#include "sim/cuda/step.h"

namespace mercury::cuda {

// When in a step something went wrong: at 4 step + phase. A phase is carried out unless the robot failed before it.
enum Phase : std::uint32_t { phase_environment = 0, phase_prediction = 1, phase_springs = 2, phase_end = 3 };
inline constexpr std::uint32_t never = 0xffffffffu;

struct Failure {
  std::uint32_t when;
  std::uint32_t bad_mass;
};

// What a spring of one material is at the present step.
struct alignas(8) SpringLaw {
  float hardness;  // stiffness in units of force a metre, or 1/(k dt^2) divided by the scale of corrections
  float factor;    // L / L0
};

// Shared memory of a block, in this order: material tables, failures, rest lengths, contact buckets and lists, working memory of its
// robots. Ends of the parts in bytes.
struct BlockLayout {
  std::uint32_t tables, failures, lengths, contacts, total;
};

// Pairs of near masses that are kept; if there are more, the cell grid is asked every step.
inline constexpr std::uint32_t contact_list_size = 1023;

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
