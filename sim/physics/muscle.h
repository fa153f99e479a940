// SPDX-License-Identifier: Apache-2.0
// The muscle law L(t) = L0 (1 + dL0 sin(omega t + phi)) (paper, II.A), its phase exact on runs of any length.
#pragma once

#include <cmath>
#include <cstdint>

#include "mercury/clock.h"
#include "mercury/host_device.h"
#include "mercury/material.h"

namespace mercury {

// A phase counts 2^-64 of a turn and wraps around, so that adding is exact and an hour costs no digit.
struct MusclePhase {
  std::uint64_t at_base = 0;  // at the clock's base
  std::uint64_t per_step = 0;
};

// A number of turns, reduced to [0, 1) in double precision, as 64-bit phase.
MERCURY_HOST_DEVICE std::uint64_t phase_of_turns(double turns) {
  const double fraction = turns - std::floor(turns);
  return fraction < 1.0 ? static_cast<std::uint64_t>(fraction * 18446744073709551616.0) : 0;
}

MERCURY_HOST_DEVICE MusclePhase muscle_phase(const Material& material, const Clock& clock) {
  constexpr double turns_per_radian = 0.15915494309189533577;
  const double omega = static_cast<double>(material.frequency);
  return {phase_of_turns((omega * clock.base_time + static_cast<double>(material.phase)) * turns_per_radian),
          phase_of_turns(omega * clock.dt * turns_per_radian)};
}

MERCURY_HOST_DEVICE std::uint64_t phase_at(const MusclePhase& phase, std::int64_t steps_since_base) {
  return phase.at_base + static_cast<std::uint64_t>(steps_since_base) * phase.per_step;
}

// sin of 2^-32 of a turn: folded to a quarter turn, then the polynomial of degree 9 that is within 4e-9 of sin(pi s).
template <class Word>
MERCURY_HOST_DEVICE auto sine_of_turns(Word turns) {
  const Word folded = select(top_bit(turns ^ (turns + turns)), Word(0x80000000u) - turns, turns);
  const auto s = float_of_signed(folded) * 4.656612873077393e-10f;  // half turns, [-1/2, 1/2]
  const auto u = s * s;
  auto p = multiply_add(0.07721982151269913f, u, -0.5980449914932251f);
  p = multiply_add(p, u, 2.5500314235687256f);
  p = multiply_add(p, u, -5.1677069664001465f);
  p = multiply_add(p, u, 3.141592502593994f);
  return p * s;
}
MERCURY_HOST_DEVICE float sine_of_phase(std::uint64_t phase) {
  return sine_of_turns(static_cast<std::uint32_t>(phase >> 32));
}

// L(t) / L0.
MERCURY_HOST_DEVICE float muscle_factor(float amplitude, std::uint64_t phase) {
  return multiply_add(amplitude, sine_of_phase(phase), 1.0f);
}
MERCURY_HOST_DEVICE float muscle_factor(const Material& material, const Clock& clock) {
  return muscle_factor(material.amplitude, phase_at(muscle_phase(material, clock), clock.step - clock.base_step));
}
// The same at t = step dt.
MERCURY_HOST_DEVICE float muscle_factor(const Material& material, double dt, std::int64_t step) {
  return muscle_factor(material, Clock{.dt = dt, .base_time = 0, .base_step = 0, .step = step});
}

}  // namespace mercury
