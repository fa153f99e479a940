// SPDX-License-Identifier: Apache-2.0
// Edits a body in the view: clicks on its skin add, remove or paint voxels.
#pragma once

#include "app/window/panels/panel.h"
#include "app/window/viewport/viewport.h"

namespace mercury::window {

// Starts editing the selected robot, or stops.
void toggle_body_editor(PanelContext& context);

// Draws the tools at the top of the view while a body is edited, and stops when its robot is gone.
void draw_body_editor(PanelContext& context, const ViewportArea& area);

// Applies the tool to what was clicked. Returns false if no body is edited, or the click was beside it.
bool edit_body_at(PanelContext& context, const Hit& hit);

}  // namespace mercury::window
