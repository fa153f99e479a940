// SPDX-License-Identifier: Apache-2.0
// The bar with the timeline, play, pause, step, reset, time and speed.
#pragma once

#include "app/window/panels/panel.h"
#include "app/window/toolkit/key_bindings.h"

namespace mercury::window {

// Its height: the timeline, and the controls below it [pixels].
float play_bar_height();

// Draws the bar in this rectangle of the window.
void draw_play_bar(PanelContext& context, ImVec2 low, ImVec2 high);

// Draws the timeline over the play controls, the moments of the last minutes or of a recording, to be dragged along: at
// ImGui's cursor, as wide as the window.
void draw_timeline_strip(PanelContext& context);

// A drag over moments, on the strip or in a plot. Robots that played go on when it ends.
void begin_scrub(PanelContext& context);
void scrub_to(PanelContext& context, double time);  // [s]
void end_scrub(PanelContext& context);

// Executes the commands of the timeline: step back, start, present, loop, bookmarks, go on, fork. Others do nothing.
void change_timeline(PanelContext& context, Action action);

}  // namespace mercury::window
