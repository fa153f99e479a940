// SPDX-License-Identifier: Apache-2.0
// The muscles of the robots that are stepped together, and where they are in their cycles.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <tuple>
#include <vector>

#include "sim/cpu/layout/aligned.h"
#include "sim/physics/muscle.h"

namespace mercury::cpu {

// Index of a factor L(t) / L0 among all factors of one step.
using FactorId = std::uint16_t;

// Materials with the same movement share a factor. Factor 0 is that of springs that do not move.
class Muscles {
 public:
  Muscles();

  // Adds the wanted materials of a table and sets the factor of each; the other elements of `factors` stay.
  void add(std::span<const Material> table, const std::array<bool, max_materials>& wanted,
           std::array<FactorId, max_materials>& factors);
  // Adds a factor that no add() returns, with a movement that may change.
  FactorId add_driven();
  // Gives such a factor the movement of this material, from the next move_to() on.
  void drive(FactorId factor, const Material& material);
  // The number of factors.
  std::size_t size() const { return movements_.size(); }

  // Moves all phases to the clock's step. Cheap if Kernel::fill_factors has brought them there already.
  void move_to(const Clock& clock);

  // By factor, padded to a multiple of any number of lanes with factors that do not move.
  Aligned<float> amplitude, highest;       // highest_sine()
  Aligned<std::uint64_t> phase, per_step;  // as in MusclePhase; `phase` is that of `step`
  std::int64_t step = 0;

 private:
  using Movement = std::tuple<float, float, float, bool>;  // amplitude, frequency, phase, half wave
  static Movement movement_of(const Material& material) {
    return {material.amplitude, material.frequency, material.phase, material.half_wave};
  }
  void place(std::size_t factor);

  std::vector<Material> movements_;
  std::map<Movement, FactorId> factor_of_;
  std::vector<FactorId> driven_;  // since the last move_to()
  Clock clock_;                   // of the last move_to()
  bool current_ = false;          // the phases are those of `step` by clock_
};

}  // namespace mercury::cpu
