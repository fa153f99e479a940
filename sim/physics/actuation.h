// SPDX-License-Identifier: Apache-2.0
// A muscle that a program drives: L = L0 (1 + dL0 u) with u in [-1, 1] instead of the sine.
//
// The muscle law (muscle.h) gives this length without any change: with frequency 0, the angle is the phase, and with
// the phase arcsin u the sine is u. So a drive is a change of the material, and no kernel knows of it. Half waves are a
// property of the sine that the drive replaces: a driven muscle takes u of either sign.
#pragma once

#include <cmath>
#include <cstdint>

#include "mercury/host_device.h"
#include "mercury/material.h"

namespace mercury {

// The largest amplitude that a program can give an actuator: the largest float below 1.
inline constexpr float max_actuated_amplitude = 0.99999994f;

// arcsin u for u in [0, 1] [rad], with the same bits on every machine, since roots are rounded exactly:
//
//   arcsin u = pi/2 - sqrt(1 - u) (a0 + a1 u + ... + a7 u^7) + e, |e| <= 2e-8
//
// (Abramowitz and Stegun, Handbook of Mathematical Functions, 4.4.46).
MERCURY_HOST_DEVICE double arcsine_of_positive(double u) {
  double p = -0.0012624911;
  p = p * u + 0.0066700901;
  p = p * u - 0.0170881256;
  p = p * u + 0.0308918810;
  p = p * u - 0.0501743046;
  p = p * u + 0.0889789874;
  p = p * u - 0.2145988016;
  p = p * u + 1.5707963050;
  return 1.5707963267948966 - std::sqrt(1.0 - u) * p;
}

MERCURY_HOST_DEVICE float arcsine(float u) {
  const double size = std::fabs(static_cast<double>(u));
  const double angle = arcsine_of_positive(size < 1.0 ? size : 1.0);
  return static_cast<float>(u < 0 ? -angle : angle);
}

// What a program gives an actuator. Amplitude, frequency and phase that are not finite are none
// (mercury/shared_array.h).
struct ActuatorSetting {
  float amplitude, frequency, phase, drive;
  bool driven;  // else it follows the sine
};

// Whether a program drives the actuator: from its first number on, or since it says so.
MERCURY_HOST_DEVICE bool is_driven(std::uint8_t& driven, float drive) {
  if (driven == 0 && !std::isnan(drive)) driven = 1;
  return driven != 0;
}

// A drive that is not finite comes from a program that has failed. The robot explodes, so that this is seen.
MERCURY_HOST_DEVICE bool has_failed(const ActuatorSetting& setting) {
  return setting.driven && !std::isfinite(setting.drive);
}

// The amplitude of the material `own` with that of a setting.
MERCURY_HOST_DEVICE float actuated_amplitude(const Material& own, float amplitude) {
  return std::isfinite(amplitude) ? std::fmin(std::fmax(amplitude, -max_actuated_amplitude), max_actuated_amplitude)
                                  : own.amplitude;
}

// The material that an actuator's springs have while it has this setting.
MERCURY_HOST_DEVICE Material actuated(const Material& own, const ActuatorSetting& setting) {
  Material now = own;
  now.amplitude = actuated_amplitude(own, setting.amplitude);
  if (std::isfinite(setting.frequency)) now.frequency = setting.frequency;
  if (std::isfinite(setting.phase)) now.phase = setting.phase;
  if (setting.driven && std::isfinite(setting.drive)) {
    now.frequency = 0;
    now.phase = arcsine(setting.drive);
    now.half_wave = false;
  }
  return now;
}

}  // namespace mercury
