// SPDX-License-Identifier: Apache-2.0
// Solver, environment and their parameters, as sliders that act at once.
#pragma once

#include "app/window/toolkit/observations.h"
#include "mercury/configuration.h"

namespace mercury::window {

// True when the configuration changed; it stays one that validate() accepts.
bool draw_physics_sliders(Configuration& configuration, Observations& observations);

}  // namespace mercury::window
