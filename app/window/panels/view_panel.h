// SPDX-License-Identifier: Apache-2.0
// What the picture shows and how: colors, arrows, camera, appearance.
#pragma once

#include "app/window/panels/panel.h"
#include "app/window/panels/text_size.h"

namespace mercury::window {

class ViewPanel : public Panel {
 public:
  void draw(PanelContext& context) override;

 private:
  TextSizeRow text_size_;
};

}  // namespace mercury::window
