// SPDX-License-Identifier: Apache-2.0
// The text on the view: names, clock, scale bar, and the legend, whose ends the mouse drags. ImGui draws it, so that
// it is sharp even if the view is coarse.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "app/scene/view_settings.h"
#include "app/window/toolkit/event_log.h"
#include "app/window/viewport/viewport.h"
#include "render/camera.h"
#include "render/scene.h"

namespace mercury::window {

// A copy of the scene without the text that draw_viewport_text() draws.
render::Scene without_text(const render::Scene& scene);

struct ViewportTextOptions {
  bool clock = false;                  // draw the clock
  float top = 0;                       // of the view that is taken [pixels]
  bool caption = true;                 // draw the caption
  std::optional<std::size_t> hovered;  // the body under the mouse, whose name is shown in any case
  Box legend;                          // which the caption leaves free
  std::vector<Box> covered;            // by what else is drawn over the view, which names leave free
};

// Draws the text of the scene over the view, and logs where each name is as the item "label.BODY", and those of robots
// that were torn apart as "wreck.0", "wreck.1", ... `bounds`: one box
// per body, in the coordinates of the view. Returns the box of the caption; without one it is empty.
Box draw_viewport_text(const render::Scene& scene, std::span<const render::Bounds> bounds, const ViewportArea& area,
                       const render::Camera& camera, const ViewportTextOptions& options, EventLog& log);

// The legend of the colors, over the view: a scale whose ends the mouse drags, or swatches with names.
class LegendView {
 public:
  // Draws the legend in the upper right corner of the view. Returns true if the mouse changed the scale in `view`:
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
