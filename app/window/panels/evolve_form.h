// SPDX-License-Identifier: Apache-2.0
// The dialog "Evolve these robots".
#pragma once

#include "app/window/panels/panel_context.h"

namespace mercury::window {

// Asks for the settings of a new run, and starts it in the background from the selected robots.
void ask_evolve(PanelContext& context);

}  // namespace mercury::window
