// SPDX-License-Identifier: Apache-2.0
// Solver, environment and materials, as sliders that act at once.
#pragma once

#include "app/window/panels/environment_choice.h"
#include "app/window/panels/materials_section.h"
#include "app/window/panels/panel.h"

namespace mercury::window {

class TunePanel : public Panel {
 public:
  void draw(PanelContext& context) override;

 private:
  EnvironmentChoice environment_;
  MaterialsSection materials_;
};

}  // namespace mercury::window
