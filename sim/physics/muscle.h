// SPDX-License-Identifier: Apache-2.0
// The muscle law L(t) = L0 (1 + dL0 sin(omega t + phi)) (paper, II.A), with a phase that stays exact on long runs.
//
// sinf(omega t + phi) does not work: after 1e6 s the angle is about 4e6 rad, where floats are 0.25 rad apart. Only the
// fraction of a turn matters, so that is all we compute, in integers:
//
//   angle(t) = omega t + phi                                              [rad]
//   turns(t) = (omega t + phi) / (2 pi)                                   [turns]
//   t        = base_time + n dt                                           n steps since the clock's base
//   turns(n) = (omega base_time + phi) / (2 pi)  +  n (omega dt / (2 pi))
//   P(n)     = at_base + n per_step   (mod 2^64)                          one unit = 2^-64 turn
//
//            0 ------------ 2^62 ------------ 2^63 ------------ 3 2^62 ------------ 2^64 = 0
//            0              1/4               1/2               3/4                 1 turn
//
// 1. Whole turns drop out by themselves, because unsigned integers wrap around.
// 2. n per_step is exact, so errors do not add up from step to step. What remains is the rounding of per_step in double
//    precision, about 1e-19 turns, times n: 1e-9 rad after 1e9 steps.
// 3. The phase depends on the number of the step alone. Runs are the same bit for bit however their steps are divided
//    into calls.
// 4. It costs one integer product per material and step, and nothing per spring. Springs do not know of half waves.
#pragma once

#include <cmath>
#include <cstdint>

#include "mercury/clock.h"
#include "mercury/host_device.h"
#include "mercury/material.h"

namespace mercury {

// Of a material, in units of 2^-64 turn.
struct MusclePhase {
  std::uint64_t at_base = 0;  // at the clock's base
  std::uint64_t per_step = 0;
};

// The fraction of a number of turns, as a phase.
MERCURY_HOST_DEVICE std::uint64_t phase_of_turns(double turns) {
  const double fraction = turns - std::floor(turns);
  return fraction < 1.0 ? static_cast<std::uint64_t>(fraction * 18446744073709551616.0) : 0;
}

inline constexpr double turns_per_radian = 0.15915494309189533577;

MERCURY_HOST_DEVICE MusclePhase muscle_phase(const Material& material, const Clock& clock) {
  const double omega = static_cast<double>(material.frequency);
  return {phase_of_turns((omega * clock.base_time + static_cast<double>(material.phase)) * turns_per_radian),
          phase_of_turns(omega * clock.dt * turns_per_radian)};
}

// Of a muscle of frequency 0, which keeps its phase [rad]: the same as muscle_phase().
MERCURY_HOST_DEVICE MusclePhase held_phase(float phase) {
  return {phase_of_turns(static_cast<double>(phase) * turns_per_radian), 0};
}

MERCURY_HOST_DEVICE std::uint64_t phase_at(const MusclePhase& phase, std::int64_t steps_since_base) {
  return phase.at_base + static_cast<std::uint64_t>(steps_since_base) * phase.per_step;
}

// The sine of an angle in units of 2^-32 turn.
//
//   t       in [-1/2, 1/2) turn, as a signed integer
//   folded  = t, or 1/2 - t if t is beyond a quarter turn, because sin(pi - x) = sin(x)     in [-1/4, 1/4]
//   s       = 2 folded, in half turns: the sine is sin(pi s)                                in [-1/2, 1/2]
//   sin(pi s) ~ s (p0 + p1 u + p2 u^2 + p3 u^3 + p4 u^4), u = s^2, within 4e-9
//
// An angle is beyond a quarter turn if its two top bits differ, which is the top bit of t ^ 2t.
template <class Word>
MERCURY_HOST_DEVICE auto sine_of_turns(Word turns) {
  const Word folded = select(top_bit(turns ^ (turns + turns)), Word(0x80000000u) - turns, turns);
  const auto s = float_of_signed(folded) * 4.656612873077393e-10f;  // 2^-31
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
MERCURY_HOST_DEVICE float cosine_of_phase(std::uint64_t phase) {
  return sine_of_phase(phase + (std::uint64_t{1} << 62));  // a quarter turn ahead
}

// L(t) / L0 [1] of a muscle by its sine. A muscle that moves by half waves takes min(0, sine) in its place (as
// voxcraft-sim without EnableExpansion): its highest sine is 0. That of all others is above every sine.
MERCURY_HOST_DEVICE float highest_sine(const Material& material) { return material.half_wave ? 0.0f : 2.0f; }
template <class Number>
MERCURY_HOST_DEVICE Number length_factor(Number amplitude, Number sine, Number highest) {
  return multiply_add(amplitude, select(sine < highest, sine, highest), Number(1.0f));
}
MERCURY_HOST_DEVICE float muscle_factor(const Material& material, std::uint64_t phase) {
  return length_factor(material.amplitude, sine_of_phase(phase), highest_sine(material));
}
MERCURY_HOST_DEVICE float muscle_factor(const Material& material, const Clock& clock) {
  return muscle_factor(material, phase_at(muscle_phase(material, clock), clock.step - clock.base_step));
}
// Its rate [1/s]: L(t) / L0 = 1 + dL0 sin(theta) with theta = omega t + phi, so d(L / L0) / dt = dL0 omega cos(theta).
// In the half of the wave that does not act it is 0.
MERCURY_HOST_DEVICE float muscle_rate(const Material& material, std::uint64_t phase) {
  const float rate = material.amplitude * material.frequency * cosine_of_phase(phase);
  return sine_of_phase(phase) < highest_sine(material) ? rate : 0.0f;
}
// At t = step dt.
MERCURY_HOST_DEVICE float muscle_factor(const Material& material, double dt, std::int64_t step) {
  return muscle_factor(material, Clock{.dt = dt, .base_time = 0, .base_step = 0, .step = step});
}

}  // namespace mercury
