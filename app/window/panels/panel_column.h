// SPDX-License-Identifier: Apache-2.0
// A column of panels at one side of the window: tabs at the top, one panel open below, an edge that can be dragged.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/window/panels/panel.h"

namespace mercury::window {

class PanelColumn {
 public:
  // Makes the panels of panel_table() that belong to this side.
  PanelColumn(Side side, PanelContext& context);

  // Draws the column between two heights of the window, `size` pixels wide. The user changes `open`, the title of the
  // open panel, and `width` [lines of text].
  void draw(PanelContext& context, float top, float bottom, float size, std::string& open, float& width);
  // Draws the handle at the inner edge of the column that collapses or opens it. Returns true when it was clicked.
  // `size`: width of the column, 0 if it is collapsed [pixels].
  bool draw_handle(EventLog& log, float middle, float size, bool open);
  // Converts a width to pixels; 0 lines = automatic. `narrow`: the window has room for one column only.
  static float pixels(float width, bool narrow);
  bool has(const std::string& title) const;

  // Passes the call on to each panel (panel.h).
  void work(PanelContext& context, double seconds);
  bool busy() const;

 private:
  void draw_tabs(PanelContext& context, std::string& open);
  void draw_edge(float top, float bottom, float size, float& width);

  struct Tab {
    const PanelEntry* entry;
    std::unique_ptr<Panel> panel;
  };

  const char* id_;
  bool right_;
  std::vector<Tab> tabs_;
};

}  // namespace mercury::window
