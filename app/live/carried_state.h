// SPDX-License-Identifier: Apache-2.0
// The state of a robot whose body was edited.
#pragma once

#include <optional>

#include "mercury/robot.h"
#include "mercury/state.h"

namespace mercury {

// Masses of `after` that were in `before`, at the same place at rest, go on as they are in `state`. New masses are as
// far from their place at rest as the nearest mass that was there, and move with its velocity. None if the robot had
// exploded or no mass stayed.
std::optional<State> carried_state(const Robot& before, const State& state, const Robot& after);

}  // namespace mercury
