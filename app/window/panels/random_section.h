// SPDX-License-Identifier: Apache-2.0
// The part of the Robots panel that makes random robots: the settings of a generator (mercury/generator.h), and a
// button.
#pragma once

#include "app/window/panels/panel_context.h"

namespace mercury::window {

class RandomSection {
 public:
  void draw(PanelContext& context);
  // Height of its rows [pixels].
  float height(const PanelContext& context) const;

 private:
  bool advanced_ = false;  // show the advanced settings, too
};

}  // namespace mercury::window
