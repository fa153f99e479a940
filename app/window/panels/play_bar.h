// SPDX-License-Identifier: Apache-2.0
// The bar with play, pause, step, reset, time and speed.
#pragma once

#include "app/window/panels/panel_context.h"

namespace mercury::window {

// Draws the bar in this rectangle of the window.
void draw_play_bar(PanelContext& context, ImVec2 low, ImVec2 high);

}  // namespace mercury::window
