// SPDX-License-Identifier: Apache-2.0
// All keys and gestures.
#pragma once

#include "app/window/toolkit/event_log.h"

namespace mercury::window {

void draw_help(bool& open, EventLog& log);

}  // namespace mercury::window
