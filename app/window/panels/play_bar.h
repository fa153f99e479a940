// SPDX-License-Identifier: Apache-2.0
// Time: play, pause, step, reset and speed.
#pragma once

#include "app/window/panels/panel_context.h"

namespace mercury::window {

// Along the lower edge, over a rectangle of the window.
void draw_play_bar(PanelContext& context, ImVec2 low, ImVec2 high);

}  // namespace mercury::window
