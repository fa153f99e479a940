// SPDX-License-Identifier: Apache-2.0
// Camera bookmarks, and views along an axis.
#pragma once

#include <cstddef>

#include "app/window/panels/panel.h"
#include "app/window/viewport/viewport.h"

namespace mercury::window {

// The camera as it is now becomes a bookmark of the scene, 0 to most_bookmarks - 1.
void set_bookmark(PanelContext& context, std::size_t place);
// Goes to a bookmark, or says that it is not set.
void go_to_bookmark(PanelContext& context, std::size_t place);

// Looks along an axis, 0 to 2, from its positive side, or from its negative one.
void look_along(PanelContext& context, int axis, bool from_negative = false);

// The axes in a corner of the view, at its lower right; a click on an end looks from there. `above`: free room below
// it [pixels].
Box draw_axes(PanelContext& context, const ViewportArea& area, const render::Camera& camera, float above);

}  // namespace mercury::window
