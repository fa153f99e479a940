// SPDX-License-Identifier: Apache-2.0
// Exports a robot for other programs through the file dialog: the selected one, else the first.
#pragma once

#include "app/window/panels/panel_context.h"

namespace mercury::window {

// Its present pose.
void export_pose(PanelContext& context);
// Its motion from time 0: asks for how long, and where.
void export_motion(PanelContext& context);

}  // namespace mercury::window
