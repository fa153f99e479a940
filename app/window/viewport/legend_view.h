// SPDX-License-Identifier: Apache-2.0
// The legend of the colors, over the picture: a scale whose ends the mouse drags, or swatches with names.
#pragma once

#include <optional>

#include "app/scene/view_settings.h"
#include "app/window/toolkit/event_log.h"
#include "app/window/viewport/viewport_area.h"
#include "render/scene.h"

namespace mercury::window {

class LegendView {
 public:
  // Draws the legend in the upper right corner of the picture. Returns true if the mouse changed the scale in `view`:
  // dragging an end sets it, and a double click on one lets the scale fit again. Call between begin_frame() and
  // end_frame() of ImGuiLayer, also without a legend.
  bool draw(const std::optional<render::Legend>& legend, const ViewportArea& area, ViewSettings& view, EventLog& log);
  const Box& box() const { return box_; }  // of the last draw()

 private:
  struct Bar;
  bool draw_scale(const render::Legend& legend, const Bar& bar, ViewSettings& view, EventLog& log);
  bool drag_end(bool high, const render::Legend& legend, const Bar& bar, ViewSettings& view, EventLog& log);

  Box box_;
  std::optional<render::Scale> held_;  // while an end is dragged: the scale when the drag began
};

}  // namespace mercury::window
