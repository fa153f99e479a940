// SPDX-License-Identifier: Apache-2.0
// Random robots: how they are made, and the button that makes them.
#pragma once

#include "app/window/panels/panel_context.h"

namespace mercury::window {

class RandomPanel {
 public:
  void draw(PanelContext& context);
  // New random robots, as the panel is set.
  void generate(PanelContext& context);
  // Of its rows [pixels].
  float height() const;

  Generation generation{.count = 6};

 private:
  void draw_voxel_options(PanelContext& context);
  void draw_network_options(PanelContext& context);

  bool replace_ = true;
};

}  // namespace mercury::window
