// SPDX-License-Identifier: Apache-2.0
// How many CPU threads make sense.
#pragma once

#include "mercury/configuration.h"

namespace mercury {

// The most CPU threads that a device may have on this machine: four times as many as it runs at once, or 256 if that is
// more. Threads beyond these cost memory and gain nothing.
int max_threads();
// Throws ParameterError("threads", ...) for more than that. Not part of validate(Configuration), since a file may come
// from a larger machine.
void require_possible_threads(const Device& device);

}  // namespace mercury
