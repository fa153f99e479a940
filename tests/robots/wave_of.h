// SPDX-License-Identifier: Apache-2.0
// How muscles move at a time, by the library's sine.
#pragma once

#include <cmath>
#include <numbers>

#include "mercury/material.h"
#include "robots/muscle_fields.h"

namespace mercury {

inline constexpr double turn = 2 * std::numbers::pi;

inline double wave_of(const FieldValue& value, double turns) {
  return value.cosine * std::sin(turn * turns) + value.sine * std::cos(turn * turns);
}

inline double wave_of(const Material& material, double time) {
  return static_cast<double>(material.amplitude) *
         std::sin(static_cast<double>(material.frequency) * time + static_cast<double>(material.phase));
}

}  // namespace mercury
