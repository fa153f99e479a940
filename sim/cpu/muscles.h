// SPDX-License-Identifier: Apache-2.0
// The muscles of the robots that are stepped together, on their way through time.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <tuple>
#include <vector>

#include "sim/cpu/aligned.h"
#include "sim/physics/muscle.h"

namespace mercury::cpu {

// Which of the factors L(t) / L0 of one step is a material's.
using FactorId = std::uint16_t;

// Materials that move alike share a factor. The first factor is that of a spring that does not move.
class Muscles {
 public:
  Muscles();

  // The factors of these materials of a table of max_materials elements; 0 for those not wanted.
  std::array<FactorId, max_materials> add(std::span<const Material> table,
                                          const std::array<bool, max_materials>& wanted);
  // How many factors there are; with `table`'s materials, at most.
  std::size_t size() const { return movements_.size(); }
  std::size_t size_with(const std::array<bool, max_materials>& wanted) const;
  static constexpr std::size_t max_size = 65536;

  // To the clock's step. Cheap where the steps since the last call were made by Kernel::fill_factors.
  void move_to(const Clock& clock);

  // By factor, then filled up to a multiple of any number of lanes with factors that do not move.
  Aligned<float> amplitude;
  Aligned<std::uint64_t> phase, per_step;  // MusclePhase, the phase at the present step
  std::int64_t step = 0;                   // the present step

 private:
  using Movement = std::tuple<float, float, float>;  // amplitude, frequency, phase
  std::vector<Material> movements_;
  std::map<Movement, FactorId> factor_of_;
  Clock clock_;           // of the last move_to()
  bool current_ = false;  // the phases are those of step `step` by clock_
};

}  // namespace mercury::cpu
