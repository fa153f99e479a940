// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/chunks.h"

#include <algorithm>
#include <bit>

#include "sim/cuda/rest_lengths.h"

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
  take(masses, sizes.slots());
}

void Chunks::fill(std::size_t k, const Robot& robot, const Arrangement& arrangement) {
  fill_masses(k, robot, *arrangement.order);
  fill_springs(k, robot, arrangement.schedule);
  put(chunk(row_start, k, sizes_.row_starts()), std::span<const std::uint32_t>(arrangement.schedule.row_start));
  put(chunk(face_pairs, k, sizes_.face_pairs), std::span(arrangement.faces));
}

void Chunks::fill_masses(std::size_t k, const Robot& robot, const SlotOrder& order) {
  fill_state(chunk(state, k, sizes_.state()), robot, order, 0);
  put(chunk(masses, k, sizes_.slots()), std::span<const std::uint16_t>(order.masses()));
  const auto valence = chunk(valences, k, sizes_.slots());
  std::ranges::fill(valence, 0.f);
  for (const Spring& spring : robot.springs)
    for (const std::uint16_t mass : {spring.a, spring.b}) valence[order.slot_of(mass)] += 1;
}

void Chunks::fill_springs(std::size_t k, const Robot& robot, const Schedule& schedule) {
  const auto records = chunk(springs, k, sizes_.springs()), incoming = chunk(incoming_counts, k, sizes_.slots());
  std::ranges::fill(incoming, 0u);
  RestLengths rest;
  if (sizes_.record_words == 1) {
    rest = rest_lengths(robot);
    put(chunk(lengths, k, max_lengths), std::span<const float>(rest.table));
  }
  auto to = records.begin();
  for (const ScheduledSpring& entry : schedule.entries) {
    const bool is_padding = entry.spring == padding;  // of air, so it adds nothing
    const Spring spring = is_padding ? Spring{} : robot.springs[entry.spring];
    const std::uint32_t key = static_cast<std::uint32_t>(entry.partner) << 16 | spring.material;
    if (sizes_.record_words == 1) {
      *to++ = key | (is_padding ? 0u : std::uint32_t{rest.index[entry.spring]} << 8);
    } else {
      *to++ = key;
      *to++ = std::bit_cast<std::uint32_t>(spring.rest_length);
    }
    ++incoming[entry.partner];
  }
  std::fill(to, records.end(), 0u);
}

void fill_state(std::span<float> state, const Robot& robot, const SlotOrder& order, float lift) {
  std::ranges::fill(state, 0.f);
  for (std::uint32_t mass = 0; mass < robot.masses.size(); ++mass)
    put_vector(state, order.slot_of(mass), field_x,
               lift == 0 ? robot.masses[mass] : robot.masses[mass] + Vec3{0, 0, lift});
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
