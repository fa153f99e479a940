// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/chunks.h"

#include <algorithm>
#include <bit>

#include "sim/cuda/rest_lengths.h"
#include "sim/physics/face_backs.h"
#include "sim/physics/fixed_point.h"

namespace mercury::cuda {
namespace {

// Chunk k of a buffer.
template <class T>
std::span<T> chunk(std::span<T> buffer, std::size_t k, std::size_t stride) {
  return buffer.subspan(k * stride, stride);
}

// Copies the values and clears the rest of the chunk.
template <class T, class Value>
void put(std::span<T> chunk, std::span<const Value> values) {
  const auto rest = std::ranges::transform(values, chunk.begin(), [](Value v) { return static_cast<T>(v); }).out;
  std::fill(rest, chunk.end(), T{});
}

}  // namespace

Chunks::Chunks(const ChunkSizes& sizes, std::size_t robots, std::byte* memory, std::uint32_t fields)
    : sizes_(sizes), fields_(fields) {
  const auto take = [&]<class T>(std::span<T>& buffer, std::size_t stride) {
    buffer = {reinterpret_cast<T*>(memory), robots * stride};
    memory += buffer.size_bytes();
  };
  take(face_pairs, sizes.face_pairs);
  take(state, sizes.state());
  take(valences, sizes.slots());
  take(lengths, sizes.lengths());
  take(springs, sizes.springs());
  take(rows, sizes.slots());
  take(groups, sizes.tiles);
  take(masses, sizes.slots());
}

void Chunks::fill(std::size_t k, const Robot& robot, const Arrangement& arrangement) {
  const Schedule& schedule = arrangement.schedule;
  fill_state(chunk(state, k, sizes_.state()), robot, *arrangement.order, 0);
  put(chunk(masses, k, sizes_.slots()), std::span<const std::uint16_t>(arrangement.order->masses()));
  fill_springs(k, robot, schedule);
  put(chunk(valences, k, sizes_.slots()), std::span<const std::uint32_t>(schedule.valences));
  fill_rows(chunk(groups, k, sizes_.tiles), chunk(rows, k, sizes_.slots()), schedule);
  const std::span<FacePair> pairs = chunk(face_pairs, k, sizes_.face_pairs);
  const auto rest = std::ranges::transform(arrangement.faces, pairs.begin(), [&](const FacePair& pair) {
                      return addressed(pair, fields_);
                    }).out;
  std::fill(rest, pairs.end(), FacePair{});
}

void Chunks::fill_springs(std::size_t k, const Robot& robot, const Schedule& schedule) {
  const RestLengths rest = sizes_.record_words == 1 ? rest_lengths(robot) : RestLengths{};
  if (sizes_.record_words == 1) put(chunk(lengths, k, max_lengths), std::span<const float>(rest.table));
  fill_records(chunk(springs, k, sizes_.springs()), robot, schedule, rest, {.fields = fields_});
}

std::uint32_t groups_of(const Schedule& schedule) {
  std::uint32_t groups = 0;
  for (std::uint32_t tile = 0; tile < schedule.tiles(); ++tile)
    groups += divide_up(schedule.rows_of(tile), rows_at_once);
  return groups;
}

void fill_rows(std::span<std::uint32_t> groups, std::span<SlotRows> rows, const Schedule& schedule) {
  std::ranges::fill(groups, 0u);
  std::ranges::fill(rows, SlotRows{});
  std::uint32_t group = 0;
  for (std::uint32_t tile = 0; tile < schedule.tiles(); ++tile) {
    const std::uint32_t count = schedule.rows_of(tile);
    groups[tile] = group;
    group += divide_up(count, rows_at_once);
    for (std::uint32_t slot = tile * lanes; slot < (tile + 1) * lanes; ++slot) {
      const std::uint32_t bias = (count - schedule.incoming_counts[slot]) * std::uint32_t{rounding_magic_bits};
      rows[slot] = {count, static_cast<std::int32_t>(bias)};
    }
  }
}

void fill_records(std::span<std::uint32_t> records, const Robot& robot, const Schedule& schedule,
                  const RestLengths& rest, const RecordNames& names) {
  // Keys without the partner. The last one is that of padding: of air, so it adds nothing.
  const auto count = static_cast<std::uint32_t>(robot.springs.size());
  std::vector<std::uint16_t> keys(count + 1);
  for (std::uint32_t i = 0; i < count; ++i) {
    const MaterialId own = robot.springs[i].material;
    const MaterialId material = names.materials.empty() ? own : names.materials[own];
    keys[i] = static_cast<std::uint16_t>((rest.index.empty() ? 0 : rest.index[i] << 8) | material);
  }
  const std::uint32_t words = rest.table.empty() ? 2 : 1;
  const auto write = [&](const ScheduledSpring& entry, std::uint32_t* to) {
    const std::uint32_t spring = entry.spring == padding ? count
                                 : names.numbers.empty() ? entry.spring
                                                         : names.numbers[entry.spring];
    to[0] = offset_of_slot(entry.partner, names.fields) << 16 | keys[spring];
    if (words == 2) to[1] = spring == count ? 0 : std::bit_cast<std::uint32_t>(robot.springs[spring].rest_length);
  };
  std::uint32_t* to = records.data();
  for (std::uint32_t tile = 0; tile < schedule.tiles(); ++tile)
    for (std::uint32_t row = schedule.row_start[tile]; row < schedule.row_start[tile + 1]; row += rows_at_once)
      for (std::uint32_t lane = 0; lane < lanes; ++lane)
        for (std::uint32_t i = row; i < row + rows_at_once; ++i, to += words)
          if (i < schedule.row_start[tile + 1])
            write(schedule.entries[std::size_t{i} * lanes + lane], to);
          else
            std::fill_n(to, words, 0u);
  std::fill(to, records.data() + records.size(), 0u);
}

FacePair addressed(const FacePair& pair, std::uint32_t fields) {
  const auto at = [&](std::uint16_t slot) { return static_cast<std::uint16_t>(offset_of_slot(slot, fields)); };
  return {at(pair.a), at(pair.b), at(pair.c), at(pair.d)};
}

void fill_backs(std::span<std::uint32_t> backs, const Robot& robot, std::span<const std::uint16_t> mass_at,
                std::span<const FacePair> pairs, std::uint32_t fields) {
  constexpr std::uint32_t absent = 0xffffffff;
  std::vector<std::uint32_t> slot_of(robot.masses.size(), absent);
  for (std::uint32_t slot = 0; slot < mass_at.size(); ++slot)
    if (slot_of[mass_at[slot]] == absent) slot_of[mass_at[slot]] = slot;
  const auto mass = [&](std::uint16_t address) { return mass_at[slot_at_offset(address, fields)]; };
  std::vector<FacePair> of_masses;
  of_masses.reserve(pairs.size());
  for (const FacePair& p : pairs) of_masses.push_back({mass(p.a), mass(p.b), mass(p.c), mass(p.d)});
  const std::vector<PairBacks> found = masses_behind(robot, of_masses);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const std::uint32_t a = slot_of[of_masses[i].a], first = slot_of[found[i].first], second = slot_of[found[i].second];
    backs[i] = (first == absent ? a : first) | (second == absent ? a : second) << 16;
  }
}

void fill_state(std::span<float> state, const Robot& robot, const SlotOrder& order, float lift) {
  std::ranges::fill(state, 0.f);
  for (std::uint32_t mass = 0; mass < robot.masses.size(); ++mass)
    put_vector(state, order.slot_of(mass), field_x, at_rest(robot.masses[mass], lift));
  if (robot.velocity.empty()) return;
  const std::vector<Vec3> velocities = start_velocities(robot);
  for (std::uint32_t mass = 0; mass < velocities.size(); ++mass)
    put_vector(state, order.slot_of(mass), field_v, velocities[mass]);
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
