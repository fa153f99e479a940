// SPDX-License-Identifier: Apache-2.0
// Makes the robots' chunks of the batch's buffers (layout.h) on the host.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "sim/cuda/arrangement.h"
#include "sim/cuda/layout.h"

namespace mercury::cuda {

// What one robot's chunks hold: enough for the largest robot of the batch.
struct ChunkSizes {
  std::uint32_t tiles = 0, rows = 0, face_pairs = 0;
  std::uint32_t record_words = 1;

  std::size_t slots() const { return std::size_t{tiles} * lanes; }
  std::size_t state() const { return slots() * state_fields; }
  std::size_t springs() const { return std::size_t{rows} * lanes * record_words; }  // [words]
  std::size_t lengths() const { return record_words == 1 ? max_lengths : 0; }
  std::size_t row_starts() const { return std::size_t{tiles} + 1; }
};

// The arrangements and rest lengths of a batch's robots.
class Arrangements {
 public:
  // Uses all cores. `robots` must outlive this object.
  explicit Arrangements(std::span<const Robot* const> robots);

  const ChunkSizes& sizes() const { return sizes_; }
  // Arrangements are kept if there are few topologies, otherwise made again by each call.
  std::shared_ptr<const Arrangement> of(std::size_t robot) const;
  // As from lengths_of().
  std::span<const float> lengths(std::size_t robot) const { return lengths_[robot]; }

 private:
  std::span<const Robot* const> robots_;
  ChunkSizes sizes_;
  std::vector<std::uint32_t> first_of_topology_;          // [robot]
  std::vector<std::shared_ptr<const Arrangement>> kept_;  // [robot], at the first of each topology; or empty
  std::vector<std::vector<float>> lengths_;               // [robot]
};

// Chunks of some consecutive robots. The members are as in BatchView.
class Chunks {
 public:
  Chunks(const ChunkSizes& sizes, std::size_t robots);

  // Fills the chunks of robot k of these. Partners are slots. Safe to call for several robots at once.
  void fill(std::size_t k, const Robot& robot, const Arrangement& arrangement, std::span<const float> lengths);

  std::vector<float> state, valences, lengths;
  std::vector<std::uint32_t> springs, row_start, incoming_counts;
  std::vector<FacePair> face_pairs;

 private:
  void fill_masses(std::size_t k, const Robot& robot, const SlotOrder& order);
  void fill_springs(std::size_t k, const Robot& robot, const Schedule& schedule, std::span<const float> lengths);

  ChunkSizes sizes_;
};

// A vector of a slot in a robot's chunk of the state buffer.
Vec3 vector_at(std::span<const float> state, std::uint32_t slot, Field field);
void put_vector(std::span<float> state, std::uint32_t slot, Field field, Vec3 value);

}  // namespace mercury::cuda
