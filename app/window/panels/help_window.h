// SPDX-License-Identifier: Apache-2.0
// A floating window that lists all keys and mouse gestures.
#pragma once

#include "app/window/toolkit/event_log.h"
#include "app/window/toolkit/key_map.h"

namespace mercury::window {

// The user may close it, which sets `open` to false.
void draw_help(bool& open, const KeyMap& keys, EventLog& log);

}  // namespace mercury::window
