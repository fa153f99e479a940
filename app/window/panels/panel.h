// SPDX-License-Identifier: Apache-2.0
// A panel: a tab in one of the two columns of the window, and the table of all panels.
//
// To add a panel, write a class that derives from Panel in new files x_panel.h and x_panel.cpp, and add a row to the
// table in panel_table.cpp. The tab, its tooltip, the entry in the View menu and the setting that keeps the panel open
// derive from the row; CMake finds every *_panel.cpp in this folder.
#pragma once

#include <memory>
#include <span>

#include "app/window/panels/panel_context.h"

namespace mercury::window {

class Panel {
 public:
  virtual ~Panel() = default;

  // Draws the panel with ImGui. Called once per frame while its tab is open.
  virtual void draw(PanelContext& context) = 0;

  // Background work on the window's thread, such as thumbnails: at most about `seconds`. Called once per frame, whether
  // the tab is open or not.
  virtual void work(PanelContext& context, double seconds);
  // True while work() has more to do; the window then keeps drawing frames.
  virtual bool busy() const { return false; }
};

enum class Side { left, right };

struct PanelEntry {
  const char* title;    // on the tab; also the panel's name in settings and in the event log
  const char* tooltip;  // of the tab; the View menu shows it beside the title
  Side side;
  std::unique_ptr<Panel> (*make)(PanelContext& context);
};

// All panels, in the order of their tabs.
std::span<const PanelEntry> panel_table();

}  // namespace mercury::window
