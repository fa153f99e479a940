// SPDX-License-Identifier: Apache-2.0
// All keys and gestures.
#pragma once

#include "app/window/toolkit/observations.h"

namespace mercury::window {

void draw_help(bool& open, Observations& observations);

}  // namespace mercury::window
