// SPDX-License-Identifier: Apache-2.0
// Compares robots: two views of the same robots under different settings, and ghosts of robots before a change.
#pragma once

#include <string>

#include "app/window/panels/panel.h"

namespace mercury::window {

class ComparePanel : public Panel {
 public:
  void draw(PanelContext& context) override;

 private:
  void draw_views(PanelContext& context);
  void draw_settings(PanelContext& context, const SideDifference& difference);
  void draw_text(PanelContext& context, const SideDifference& difference);
  void draw_ghosts(PanelContext& context);

  std::string text_, shown_text_;  // in the field, and of the second side when it was written there
  std::string problem_;            // with the text in the field
  int ghost_of_ = 0;               // a GhostOf
};

// What the key does: the second view on and off. It begins with what it was last.
void toggle_second_view(PanelContext& context);
// Ghosts of the selected robots on and off.
void toggle_ghosts(PanelContext& context, GhostOf of = GhostOf::automatic);

}  // namespace mercury::window
