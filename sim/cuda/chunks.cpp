// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/chunks.h"

#include <algorithm>
#include <bit>

namespace mercury::cuda {
namespace {

// Chunk k of a buffer.
template <class T>
std::span<T> chunk(std::span<T> buffer, std::size_t k, std::size_t stride) {
  return buffer.subspan(k * stride, stride);
}

// Copies the values and clears the rest of the chunk.
template <class T>
void put(std::span<T> chunk, std::span<const T> values) {
  const auto rest = std::ranges::copy(values, chunk.begin()).out;
  std::fill(rest, chunk.end(), T{});
}

}  // namespace

Chunks::Chunks(const ChunkSizes& sizes, std::size_t robots, std::byte* memory) : sizes_(sizes) {
  const auto take = [&]<class T>(std::span<T>& buffer, std::size_t stride) {
    buffer = {reinterpret_cast<T*>(memory), robots * stride};
    memory += buffer.size_bytes();
  };
  take(face_pairs, sizes.face_pairs);
  take(state, sizes.state());
  take(valences, sizes.slots());
  take(lengths, sizes.lengths());
  take(springs, sizes.springs());
  take(row_start, sizes.row_starts());
  take(incoming_counts, sizes.slots());
}

void Chunks::fill(std::size_t k, const Robot& robot, const Arrangement& arrangement,
                  std::span<const float> robot_lengths) {
  fill_masses(k, robot, arrangement.order);
  fill_springs(k, robot, arrangement.schedule, robot_lengths);
  if (sizes_.record_words == 1) put(chunk(lengths, k, max_lengths), robot_lengths);
  put(chunk(row_start, k, sizes_.row_starts()), std::span(arrangement.schedule.row_start));
  put(chunk(face_pairs, k, sizes_.face_pairs), std::span(arrangement.faces));
}

void Chunks::fill_masses(std::size_t k, const Robot& robot, const SlotOrder& order) {
  const auto to = chunk(state, k, sizes_.state()), valence = chunk(valences, k, sizes_.slots());
  std::ranges::fill(to, 0.f);
  std::ranges::fill(valence, 0.f);
  for (std::uint32_t mass = 0; mass < robot.masses.size(); ++mass)
    put_vector(to, order.slot_of(mass), field_x, robot.masses[mass]);
  for (const Spring& spring : robot.springs)
    for (const std::uint16_t mass : {spring.a, spring.b}) valence[order.slot_of(mass)] += 1;
}

void Chunks::fill_springs(std::size_t k, const Robot& robot, const Schedule& schedule,
                          std::span<const float> robot_lengths) {
  const auto records = chunk(springs, k, sizes_.springs()), incoming = chunk(incoming_counts, k, sizes_.slots());
  std::ranges::fill(incoming, 0u);
  auto to = records.begin();
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
    ++incoming[entry.partner];
  }
  std::fill(to, records.end(), 0u);
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
