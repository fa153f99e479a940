// SPDX-License-Identifier: Apache-2.0
// The timeline over the play controls: the moments of the last minutes, or of a recording, to be dragged along.
#pragma once

#include "app/window/panels/panel_context.h"
#include "app/window/toolkit/key_bindings.h"

namespace mercury::window {

// Draws the strip at ImGui's cursor, as wide as the window.
void draw_timeline_strip(PanelContext& context);

// A drag over moments, on the strip or in a plot. Robots that played go on when it ends.
void begin_scrub(PanelContext& context);
void scrub_to(PanelContext& context, double time);  // [s]
void end_scrub(PanelContext& context);

// Executes the commands of the timeline: step back, start, present, loop, bookmarks, go on, fork. Others do nothing.
void change_timeline(PanelContext& context, Action action);

}  // namespace mercury::window
