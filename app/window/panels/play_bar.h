// SPDX-License-Identifier: Apache-2.0
// Time: play, pause, step, reset and speed.
#pragma once

#include "app/window/picture/desk.h"

namespace mercury::window {

// Along the lower edge, over a rectangle of the window.
void draw_play_bar(Desk& desk, ImVec2 low, ImVec2 high);

}  // namespace mercury::window
