// SPDX-License-Identifier: Apache-2.0
// Which physics a robot is made for.
#pragma once

#include <string_view>

namespace mercury {

// What bodies are made of: masses of 1 kg and springs of 50 N/m, as in the paper, or a real material's modulus, density
// and damping.
enum class Physics { paper, real };

// "paper", "real".
constexpr std::string_view name_of(Physics physics) { return physics == Physics::real ? "real" : "paper"; }

}  // namespace mercury
