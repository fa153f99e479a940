// SPDX-License-Identifier: Apache-2.0
// Plots over time, and the ranking.
#pragma once

#include <array>
#include <string>

#include "app/window/panels/panel_context.h"

namespace mercury::window {

class MeasurePanel {
 public:
  void draw(PanelContext& context);

 private:
  void draw_plots(PanelContext& context);
  void draw_exports(PanelContext& context);

  std::array<bool, 5> shown_{true, true, false, false, false};  // by Quantity
};

class RankingPanel {
 public:
  void draw(PanelContext& context, float aspect);

 private:
  int column_ = 1;
  bool ascending_ = false;
  bool sorted_ = false;  // as the headings say, and told so
};

}  // namespace mercury::window
