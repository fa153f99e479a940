// SPDX-License-Identifier: Apache-2.0
// Plots over time.
#pragma once

#include <array>

#include "app/window/panels/panel.h"

namespace mercury::window {

class MeasurePanel : public Panel {
 public:
  void draw(PanelContext& context) override;

 private:
  void draw_plots(PanelContext& context);
  void draw_exports(PanelContext& context);

  std::array<bool, 5> shown_{true, true, false, false, false};  // by Measure
};

}  // namespace mercury::window
