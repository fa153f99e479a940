// SPDX-License-Identifier: Apache-2.0
// What the view shows and how: colors, arrows, camera, appearance.
#pragma once

#include <optional>

#include "app/window/panels/panel.h"

namespace mercury::window {

// Changes the size of the text by some tenths, within its limits.
void change_text_size(PanelContext& context, int tenths);

// A row with two buttons. The panel grows with its text, so a click would move them away from under the mouse: until
// the mouse leaves, the buttons stay where they were, above the panel.
class TextSizeRow {
 public:
  void draw(PanelContext& context);

 private:
  struct Pinned {
    ImVec2 low, high;  // of the buttons
    float font = 0;    // size of the text then [pixels]
  };
  void draw_buttons(PanelContext& context, float width, float height);
  void draw_pinned(PanelContext& context);

  std::optional<Pinned> pinned_;
};

class ViewPanel : public Panel {
 public:
  void draw(PanelContext& context) override;

 private:
  TextSizeRow text_size_;
};

}  // namespace mercury::window
