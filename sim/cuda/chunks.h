// SPDX-License-Identifier: Apache-2.0
// Makes the robots' chunks of a size class's buffers (layout.h) on the host.
#pragma once

#include <cstddef>
#include <span>

#include "mercury/robot.h"
#include "sim/cuda/arrangement.h"
#include "sim/cuda/layout.h"
#include "sim/cuda/rest_lengths.h"

namespace mercury::cuda {

// What one robot's chunks hold: enough for the largest robot of the class.
struct ChunkSizes {
  std::uint32_t tiles = 0, groups = 0, face_pairs = 0;
  std::uint32_t record_words = 1;

  std::size_t slots() const { return std::size_t{tiles} * lanes; }
  std::size_t state() const { return slots() * state_fields; }
  std::size_t springs() const { return groups * words_of_group(record_words); }  // [words]
  std::size_t lengths() const { return record_words == 1 ? max_lengths : 0; }
  std::size_t bytes() const {  // of all chunks of one robot, a multiple of 8
    const std::size_t words = state() + slots() + lengths() + springs() + tiles;
    return (4 * words + sizeof(SlotRows) * slots() + sizeof(FacePair) * face_pairs + 2 * slots() + 7) / 8 * 8;
  }
};

// Chunks of some consecutive robots, in memory that somebody else owns. The members are as in BatchView.
class Chunks {
 public:
  // `memory` = robots * sizes.bytes() bytes, aligned for all members. Masses are addressed by offset_of_slot() with
  // `fields`.
  Chunks(const ChunkSizes& sizes, std::size_t robots, std::byte* memory, std::uint32_t fields);

  // Fills the chunks of robot k of these. Safe to call for several robots at once.
  void fill(std::size_t k, const Robot& robot, const Arrangement& arrangement);

  std::span<FacePair> face_pairs;
  std::span<std::uint16_t> masses;
  std::span<float> state, valences, lengths;
  std::span<std::uint32_t> springs, groups;
  std::span<SlotRows> rows;

 private:
  void fill_springs(std::size_t k, const Robot& robot, const Schedule& schedule);

  ChunkSizes sizes_;
  std::uint32_t fields_;
};

// How spring records name springs, partners and materials.
struct RecordNames {
  std::span<const std::uint32_t> numbers;  // [spring of the schedule], its number in the robot; empty = the same
  std::span<const MaterialId> materials;   // [max_materials], the new id by the robot's; empty = the same
  std::uint32_t fields = 0;                // partners are addressed by offset_of_slot()
};
// Groups of rows that a schedule takes.
std::uint32_t groups_of(const Schedule& schedule);
// Fills the first groups of a schedule's tiles, and the rows of its slots.
void fill_rows(std::span<std::uint32_t> groups, std::span<SlotRows> rows, const Schedule& schedule);
// Fills the spring records of a schedule, and clears those of unused rows and all that come after. `rest` is empty for
// records of two words.
void fill_records(std::span<std::uint32_t> records, const Robot& robot, const Schedule& schedule,
                  const RestLengths& rest, const RecordNames& names = {});

// A pair whose corners are slots, with these addressed by offset_of_slot() with `fields`.
FacePair addressed(const FacePair& pair, std::uint32_t fields);

// BatchView::face_backs of a robot or a part: for each pair, `mass_at` having the masses by their slots. Of a slot that
// repeats a mass the first one counts. A face whose mass behind is not here has its own corner a for it. Corners are
// addressed by offset_of_slot() with `fields`.
void fill_backs(std::span<std::uint32_t> backs, const Robot& robot, std::span<const std::uint16_t> mass_at,
                std::span<const FacePair> pairs, std::uint32_t fields);

// Where a mass is at rest if its robot is `lift` [m] higher than in its file.
inline Vec3 at_rest(Vec3 mass, float lift) { return lift == 0 ? mass : mass + Vec3{0, 0, lift}; }

// The state of a robot at rest where it began, but `lift` [m] higher.
void fill_state(std::span<float> state, const Robot& robot, const SlotOrder& order, float lift);

// A vector of a slot in a robot's chunk of the state buffer.
Vec3 vector_at(std::span<const float> state, std::uint32_t slot, Field field);
void put_vector(std::span<float> state, std::uint32_t slot, Field field, Vec3 value);

}  // namespace mercury::cuda
