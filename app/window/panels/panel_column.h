// SPDX-License-Identifier: Apache-2.0
// Which part of the window is whose: columns of panels left and right, the play bar below, the picture between them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "app/window/panels/panel_context.h"
#include "app/window/viewport/viewport_area.h"

namespace mercury::window {

// A panel by its name, as it is written on its tab.
struct Panel {
  const char* name;
  const char* meaning;  // shown when the mouse rests on the tab
  std::function<void()> draw;
};

// A column of panels at a side of the window, one of them open.
class PanelColumn {
 public:
  PanelColumn(const char* id, bool right, std::vector<Panel> panels)
      : id_(id), right_(right), panels_(std::move(panels)) {}

  // Between two heights of the window. `open` and `width` [lines of text] are changed by the user.
  void draw(PanelContext& context, float top, float bottom, std::string& open, float& width);
  // Its width now [pixels]; one of 0 lines is as the window suggests.
  static float pixels(float width);
  const std::vector<Panel>& panels() const { return panels_; }
  bool has(const std::string& name) const;

 private:
  void draw_tabs(PanelContext& context, std::string& open);
  void draw_edge(float top, float bottom, float& width);

  const char* id_;
  bool right_;
  std::vector<Panel> panels_;
};

}  // namespace mercury::window
