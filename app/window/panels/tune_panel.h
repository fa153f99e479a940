// SPDX-License-Identifier: Apache-2.0
// Solver, environment and their parameters, as sliders that act at once.
#pragma once

#include "app/window/toolkit/event_log.h"
#include "mercury/configuration.h"

namespace mercury::window {

// True when the configuration changed; it stays one that validate() accepts.
bool draw_physics_sliders(Configuration& configuration, EventLog& log);

}  // namespace mercury::window
