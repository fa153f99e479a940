// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/chunks.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <ranges>

#include "sim/cuda/block_layout.h"
#include "sim/physics/measures.h"

namespace mercury::cuda {
namespace {

std::ptrdiff_t offset(std::size_t k, std::size_t size) { return static_cast<std::ptrdiff_t>(k * size); }

}  // namespace

Arrangements::Arrangements(std::span<const Robot* const> robots)
    : robots_(robots), first_of_topology_(first_of_topology(robots)), lengths_(robots.size()) {
  const std::size_t count = robots.size();
  const auto is_first = [&](std::size_t i) { return first_of_topology_[i] == i; };
  // The sizes are known only after every topology is arranged. Many topologies would fill the host's memory, so they
  // are arranged twice instead.
  constexpr std::ptrdiff_t max_kept = 2048;
  const bool keep = std::ranges::count_if(std::views::iota(std::size_t{0}, count), is_first) <= max_kept;
  if (keep) kept_.resize(count);
  std::vector<std::uint32_t> rows(count), face_pairs(count);
  oneapi::tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    lengths_[i] = lengths_of(*robots_[i]);
    if (!is_first(i)) return;
    auto arrangement = std::make_shared<const Arrangement>(arrange(*robots_[i]));
    rows[i] = arrangement->schedule.rows();
    face_pairs[i] = static_cast<std::uint32_t>(arrangement->faces.size());
    if (keep) kept_[i] = std::move(arrangement);
  });
  for (const Robot* robot : robots) sizes_.tiles = std::max(sizes_.tiles, tiles_for(robot->masses.size()));
  sizes_.rows = std::ranges::max(rows);
  sizes_.face_pairs = std::ranges::max(face_pairs);
  const auto fit_table = [](const std::vector<float>& lengths) { return lengths.size() <= max_lengths; };
  sizes_.record_words = std::ranges::all_of(lengths_, fit_table) ? 1 : 2;
}

std::shared_ptr<const Arrangement> Arrangements::of(std::size_t robot) const {
  if (kept_.empty()) return std::make_shared<const Arrangement>(arrange(*robots_[robot]));
  return kept_[first_of_topology_[robot]];
}

Chunks::Chunks(const ChunkSizes& sizes, std::size_t robots)
    : state(robots * sizes.state()), valences(robots * sizes.slots()), lengths(robots * sizes.lengths()),
      springs(robots * sizes.springs()), row_start(robots * sizes.row_starts()),
      incoming_counts(robots * sizes.slots()), face_pairs(robots * sizes.face_pairs), sizes_(sizes) {}

void Chunks::fill(std::size_t k, const Robot& robot, const Arrangement& arrangement,
                  std::span<const float> robot_lengths) {
  fill_masses(k, robot, arrangement.order);
  fill_springs(k, robot, arrangement.schedule, robot_lengths);
  if (sizes_.record_words == 1) std::ranges::copy(robot_lengths, lengths.begin() + offset(k, max_lengths));
  std::ranges::copy(arrangement.schedule.row_start, row_start.begin() + offset(k, sizes_.row_starts()));
  std::ranges::copy(arrangement.faces, face_pairs.begin() + offset(k, sizes_.face_pairs));
}

void Chunks::fill_masses(std::size_t k, const Robot& robot, const SlotOrder& order) {
  const auto chunk = std::span(state).subspan(k * sizes_.state(), sizes_.state());
  const std::vector<std::uint32_t> valence = mercury::valences(robot);
  for (std::uint32_t mass = 0; mass < robot.masses.size(); ++mass) {
    const std::uint32_t slot = order.slot_of(mass);
    put_vector(chunk, slot, field_x, robot.masses[mass]);
    valences[k * sizes_.slots() + slot] = static_cast<float>(valence[mass]);
  }
}

void Chunks::fill_springs(std::size_t k, const Robot& robot, const Schedule& schedule,
                          std::span<const float> robot_lengths) {
  std::uint32_t* to = springs.data() + k * sizes_.springs();
  for (const ScheduledSpring& entry : schedule.entries) {
    // Padding is of air, so it adds nothing.
    const Spring spring = entry.spring == padding ? Spring{} : robot.springs[entry.spring];
    const std::uint32_t key = static_cast<std::uint32_t>(entry.partner) << 16 | spring.material;
    if (sizes_.record_words == 1) {
      const auto index = std::ranges::lower_bound(robot_lengths, spring.rest_length) - robot_lengths.begin();
      *to++ = key | static_cast<std::uint32_t>(index) << 8;
    } else {
      *to++ = key;
      *to++ = std::bit_cast<std::uint32_t>(spring.rest_length);
    }
    ++incoming_counts[k * sizes_.slots() + entry.partner];
  }
}

Vec3 vector_at(std::span<const float> state, std::uint32_t slot, Field field) {
  const float* at = state.data() + offset_of_slot(slot, state_fields) + field * lanes;
  return {at[0], at[lanes], at[2 * lanes]};
}

void put_vector(std::span<float> state, std::uint32_t slot, Field field, Vec3 value) {
  float* at = state.data() + offset_of_slot(slot, state_fields) + field * lanes;
  at[0] = value.x;
  at[lanes] = value.y;
  at[2 * lanes] = value.z;
}

}  // namespace mercury::cuda
