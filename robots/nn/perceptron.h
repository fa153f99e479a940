// SPDX-License-Identifier: Apache-2.0
// The layers of a network, evaluated for many points at once with the widest vectors that the machine has. The result
// is the same bit for bit with any of them.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "mercury/network.h"

namespace mercury {

// See evaluate() in mercury/network.h. `kernel` is below perceptron_kernels().
std::vector<float> evaluate_layers(std::span<const Layer> layers, std::span<const float> points,
                                   std::size_t kernel = 0);

// Number of instruction sets that this machine has a kernel for. Kernel 0 is the fastest.
std::size_t perceptron_kernels();

}  // namespace mercury
