// SPDX-License-Identifier: Apache-2.0
// The text on the picture: names, clock, scale bar (the legend has a file of its own). ImGui draws it, so that it is
// sharp even if the picture is coarse.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "app/window/toolkit/event_log.h"
#include "app/window/viewport/viewport_area.h"
#include "render/camera.h"
#include "render/scene.h"

namespace mercury::window {

// A copy of the scene without its text.
render::Scene without_text(const render::Scene& scene);

struct ViewportTextOptions {
  bool clock = false;                  // draw the clock
  float top = 0;                       // of the picture that is taken [pixels]
  bool caption = true;                 // draw the caption
  std::optional<std::size_t> hovered;  // the body under the mouse, whose name is shown in any case
  Box legend;                          // which the caption leaves free
};

// Draws the text of the scene over the picture, and logs where each name is as the item "label.BODY". `bounds`: one box
// per body, in the coordinates of the picture. Returns the box of the caption; without one it is empty.
Box draw_viewport_text(const render::Scene& scene, std::span<const render::Bounds> bounds, const ViewportArea& area,
                       const render::Camera& camera, const ViewportTextOptions& options, EventLog& log);

}  // namespace mercury::window
