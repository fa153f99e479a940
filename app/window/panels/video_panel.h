// SPDX-License-Identifier: Apache-2.0
// Videos of the window, clean videos of the group, screenshots.
#pragma once

#include "app/window/panels/panel.h"

namespace mercury::window {

class VideoPanel : public Panel {
 public:
  void draw(PanelContext& context) override;
};

}  // namespace mercury::window
