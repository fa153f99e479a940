// SPDX-License-Identifier: Apache-2.0
#include "sim/cpu/layout/muscles.h"

#include <utility>

namespace mercury::cpu {
namespace {

constexpr std::size_t max_lanes = 16;

}  // namespace

Muscles::Muscles() {
  movements_.push_back({});
  factor_of_.emplace(movement_of({}), FactorId{0});
}

void Muscles::add(std::span<const Material> table, const std::array<bool, max_materials>& wanted,
                  std::array<FactorId, max_materials>& factors) {
  for (std::size_t id = 0; id < table.size(); ++id) {
    if (!wanted[id]) continue;
    const Material& m = table[id];
    const Movement movement = movement_of(m.amplitude == 0 ? Material{} : m);
    const auto [found, is_new] = factor_of_.emplace(movement, static_cast<FactorId>(movements_.size()));
    if (is_new) {
      movements_.push_back(m);
      current_ = false;
    }
    factors[id] = found->second;
  }
}

FactorId Muscles::add_driven() {
  movements_.push_back({});
  current_ = false;
  return static_cast<FactorId>(movements_.size() - 1);
}

void Muscles::drive(FactorId factor, const Material& material) {
  if (movement_of(movements_[factor]) == movement_of(material)) return;
  movements_[factor] = material;
  driven_.push_back(factor);
}

void Muscles::place(std::size_t factor) {
  const MusclePhase muscle = muscle_phase(movements_[factor], clock_);
  amplitude[factor] = movements_[factor].amplitude;
  highest[factor] = highest_sine(movements_[factor]);
  phase[factor] = phase_at(muscle, clock_.step - clock_.base_step);
  per_step[factor] = muscle.per_step;
}

void Muscles::move_to(const Clock& clock) {
  const bool goes_on = current_ && clock.dt == clock_.dt && clock.base_time == clock_.base_time &&
                       clock.base_step == clock_.base_step && clock.step == step;
  const std::vector<FactorId> driven = std::exchange(driven_, {});
  if (goes_on) {
    clock_ = clock;
    for (const FactorId factor : driven) place(factor);
    return;
  }
  clock_ = clock;
  step = clock.step;
  current_ = true;
  const std::size_t padded = (size() + max_lanes - 1) / max_lanes * max_lanes;
  amplitude.assign(padded, 0);
  highest.assign(padded, 0);
  phase.assign(padded, 0);
  per_step.assign(padded, 0);
  for (std::size_t i = 0; i < size(); ++i) place(i);
}

}  // namespace mercury::cpu
