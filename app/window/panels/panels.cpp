// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/panels.h"

#include <imgui.h>

#include <nlohmann/json.hpp>

#include "app/window/panels/help_window.h"
#include "app/window/panels/play_bar.h"

namespace mercury::window {

ViewportArea Panels::draw_frame() {
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  ViewportArea area{{0, 0}, screen};
  if (context_.preferences.panels) {
    draw_menu();
    const float top = ImGui::GetFrameHeight(),
                bar = 1.15f * ImGui::GetFrameHeight() + 2 * ImGui::GetStyle().WindowPadding.y;
    area = {{PanelColumn::pixels(context_.preferences.left_width), top},
            {screen.x - PanelColumn::pixels(context_.preferences.right_width), screen.y - bar}};
    left_.draw(context_, top, area.high.y, context_.preferences.left_panel, context_.preferences.left_width);
    right_.draw(context_, top, area.high.y, context_.preferences.right_panel, context_.preferences.right_width);
    draw_play_bar(context_, {0, area.high.y}, screen);
  }
  context_.aspect = area.aspect();
  context_.log.item("picture", area.low, area.high);
  return area;
}

void Panels::draw_over(const ViewportArea& area, const render::Camera& camera, double dt) {
  explosions_.update(context_, area, camera);
  explosions_.draw(context_, area);
  if (help_open_) draw_help(help_open_, context_.log);
  context_.toasts.draw(area.low, area.high, dt, context_.log);
}

// Dear ImGui requires that no window outside a modal appears after it in the frame in which the modal opens.
void Panels::draw_dialogs() { context_.dialogs.draw(context_.log); }

void Panels::work(double seconds) {
  left_.work(context_, seconds);
  right_.work(context_, seconds);
}

void Panels::show(const std::string& panel) {
  context_.preferences.panels = true;
  (left_.has(panel) ? context_.preferences.left_panel : context_.preferences.right_panel) = panel;
  context_.log.write("panel", {{"name", panel}});
}

}  // namespace mercury::window
