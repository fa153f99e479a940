// SPDX-License-Identifier: Apache-2.0
// The bar with the timeline, play, pause, step, reset, time and speed.
#pragma once

#include "app/window/panels/panel_context.h"

namespace mercury::window {

// Its height: the timeline, and the controls below it [pixels].
float play_bar_height();

// Draws the bar in this rectangle of the window.
void draw_play_bar(PanelContext& context, ImVec2 low, ImVec2 high);

}  // namespace mercury::window
