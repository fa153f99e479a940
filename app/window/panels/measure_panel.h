// SPDX-License-Identifier: Apache-2.0
// Plots of speed, distance, energies and strain over time, for the selected robots or all.
#pragma once

#include <array>
#include <optional>
#include <utility>

#include "app/window/panels/panel.h"
#include "app/window/toolkit/plot.h"

namespace mercury::window {

class MeasurePanel : public Panel {
 public:
  void draw(PanelContext& context) override;

 private:
  void draw_window(PanelContext& context);
  void draw_plots(PanelContext& context, float height);
  void draw_buttons(PanelContext& context);
  void scrub(PanelContext& context);
  void log_view(PanelContext& context);

  std::array<bool, 7> shown_{true, true};  // one per measure of measures()
  PlotView view_;
  bool large_ = false;   // in a window of their own
  bool scrubs_ = false;  // a drag goes through time
  std::optional<std::pair<double, double>> logged_;
};

}  // namespace mercury::window
