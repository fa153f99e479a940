// SPDX-License-Identifier: Apache-2.0
// The layers of a network, evaluated for many points at once with the widest vectors that the machine has. The result
// is the same bit for bit with any of them.
#pragma once

#include <span>
#include <vector>

#include "mercury/network.h"

namespace mercury {

// See evaluate() in mercury/network.h.
std::vector<float> evaluate_layers(std::span<const Layer> layers, std::span<const float> points);

}  // namespace mercury
