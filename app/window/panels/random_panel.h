// SPDX-License-Identifier: Apache-2.0
// Random robots: the settings of a generator, and the button that makes robots.
#pragma once

#include "app/window/panels/panel_context.h"

namespace mercury::window {

class RandomPanel {
 public:
  void draw(PanelContext& context);
  // Makes random robots with the panel's settings.
  void generate(PanelContext& context);
  // Height of its rows [pixels].
  float height() const;

  RandomRobots generation{.count = 6};

 private:
  bool replace_ = true, advanced_ = false;
};

}  // namespace mercury::window
