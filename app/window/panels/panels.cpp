// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/panels.h"

#include <imgui.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/window/panels/body_editor.h"
#include "app/window/panels/camera_commands.h"
#include "app/window/panels/help_window.h"
#include "app/window/panels/play_bar.h"
#include "app/window/panels/robot_menu.h"

namespace mercury::window {
namespace {

// The upper edge of messages, which are in the middle of the picture.
float below_caption(const Box& caption, const ViewportArea& area) {
  const float text = ImGui::GetFontSize(), middle = (area.low.x + area.high.x) / 2;
  const float half = std::min(area.width() / 2, 19 * text);
  return caption.high.x > middle - half ? std::max(area.low.y, caption.high.y - 0.4f * text) : area.low.y;
}

}  // namespace

ViewportArea Panels::draw_frame() {
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  ViewportArea area{{0, 0}, screen};
  context_.cursor.begin_frame();
  if (context_.preferences.panels) {
    draw_menu();
    const float top = ImGui::GetFrameHeight(), bottom = screen.y - play_bar_height();
    const float left = draw_column(left_, Side::left, top, bottom);
    area = {{left, top}, {screen.x - draw_column(right_, Side::right, top, bottom), bottom}};
    draw_play_bar(context_, {0, area.high.y}, screen);
  }
  context_.aspect = area.aspect();
  context_.log.item("picture", area.low, area.high);
  return area;
}

// Whether the window has no room for two columns and a picture.
bool Panels::is_narrow() const {
  constexpr float least = 1000;  // pixels of a screen of normal resolution
  return ImGui::GetIO().DisplaySize.x < least * context_.window.content_scale();
}

bool Panels::column_open(Side side) const {
  if (is_narrow()) return narrow_open_ == side;
  return side == Side::left ? context_.preferences.left_open : context_.preferences.right_open;
}

// In a narrow window, one column opens in place of the other, and the user's choice for wide ones stays.
void Panels::open_column(Side side, bool open) {
  if (is_narrow())
    narrow_open_ = open ? std::optional(side) : narrow_open_ == side ? std::nullopt : narrow_open_;
  else
    (side == Side::left ? context_.preferences.left_open : context_.preferences.right_open) = open;
}

// Returns how much of the window's width it takes [pixels].
float Panels::draw_column(PanelColumn& column, Side side, float top, float bottom) {
  Preferences& preferences = context_.preferences;
  float& width = side == Side::left ? preferences.left_width : preferences.right_width;
  const bool open = column_open(side);
  const float pixels = open ? PanelColumn::pixels(width, is_narrow()) : 0;
  if (open)
    column.draw(context_, top, bottom, pixels, side == Side::left ? preferences.left_panel : preferences.right_panel,
                width);
  if (column.draw_handle(context_.log, (top + bottom) / 2, pixels, open)) open_column(side, !open);
  return pixels;
}

void Panels::draw_over(const ViewportArea& area, const render::Camera& camera, double dt) {
  const Box axes =
      draw_axes(context_, area, camera, context_.scene.view().shown.scale_bar ? 2.6f * ImGui::GetFontSize() : 0);
  explosions_.update(context_, area, camera);
  explosions_.draw(context_, area);
  first_steps_.draw(context_, area, {axes, context_.legend, explosions_.box()}, dt);
  draw_body_editor(context_, area);
  draw_robot_menu(context_, [this](Action action) { execute(action); });
  if (help_open_) draw_help(help_open_, context_.keys, context_.log);
  context_.toasts.draw({area.low.x, below_caption(context_.caption, area)}, area.high, dt, context_.log);
  if (context_.dialogs.open()) palette_.close();
  palette_.draw(context_);
  if (context_.toasts.take_click()) show("Messages");
}

// Dear ImGui requires that no window outside a modal appears after it in the frame in which the modal opens.
void Panels::draw_dialogs() { context_.dialogs.draw(context_.log); }

void Panels::work(double seconds) {
  left_.work(context_, seconds);
  right_.work(context_, seconds);
}

void Panels::show(const std::string& panel) {
  context_.preferences.panels = true;
  open_column(left_.has(panel) ? Side::left : Side::right, true);
  (left_.has(panel) ? context_.preferences.left_panel : context_.preferences.right_panel) = panel;
  context_.log.write("panel", {{"name", panel}});
}

}  // namespace mercury::window
