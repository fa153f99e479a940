// SPDX-License-Identifier: Apache-2.0
// What the picture shows and how: colours, arrows, camera, appearance.
#pragma once

#include "app/window/panels/panel.h"

namespace mercury::window {

class ViewPanel : public Panel {
 public:
  void draw(PanelContext& context) override;
};

}  // namespace mercury::window
