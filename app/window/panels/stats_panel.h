// SPDX-License-Identifier: Apache-2.0
// The speed of the physics and of drawing.
#pragma once

#include "app/window/panels/panel.h"

namespace mercury::window {

class StatsPanel : public Panel {
 public:
  void draw(PanelContext& context) override;
};

}  // namespace mercury::window
