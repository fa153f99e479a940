// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/panels.h"

#include <fmt/format.h>
#include <imgui.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

#include "app/window/panels/commands.h"
#include "app/window/panels/robot_list.h"
#include "app/window/toolkit/theme.h"
#include "app/window/toolkit/widgets.h"

namespace mercury::window {
PanelColumn::PanelColumn(Side side, PanelContext& context)
    : id_(side == Side::left ? "##left" : "##right"), right_(side == Side::right) {
  for (const PanelEntry& entry : panel_table())
    if (entry.side == side) tabs_.push_back({&entry, entry.make(context)});
}

void PanelColumn::work(PanelContext& context) {
  for (const Tab& tab : tabs_) tab.panel->work(context);
}

float PanelColumn::rail_pixels() { return std::round(2.6f * ImGui::GetFontSize()); }

float PanelColumn::pixels(float width, bool narrow) {
  const float text = ImGui::GetFontSize(), screen = ImGui::GetIO().DisplaySize.x;
  const float lines = width > 0 ? width : std::clamp(0.16f * screen / text, 18.0f, 30.0f);
  return std::min(lines * text, (narrow ? 0.75f : 0.38f) * screen);
}

bool PanelColumn::has(const std::string& title) const {
  return std::ranges::any_of(tabs_, [&](const Tab& tab) { return tab.entry->title == title; });
}

void PanelColumn::draw(PanelContext& context, float top, float bottom, float size, std::string& open, float& width,
                       bool card) {
  if (!has(open)) open = tabs_.front().entry->title;
  const float screen = ImGui::GetIO().DisplaySize.x, rail = rail_pixels();
  ImGui::SetNextWindowPos({right_ ? screen - rail - size : rail, top});
  ImGui::SetNextWindowSize({size, bottom - top});
  ImGui::SetNextWindowBgAlpha(0);  // see panel_background()
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0);
  ImGui::Begin(id_, nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoScrollWithMouse);
  ImGui::PopStyleVar();
  ImGui::TextUnformatted(open.c_str());
  ImGui::Separator();
  const auto tab = std::ranges::find_if(tabs_, [&](const Tab& other) { return other.entry->title == open; });
  // Each panel has an ImGui child of its own, which keeps its scroll position.
  if (ImGui::BeginChild(tab->entry->title, {0, card ? -pinned_card_height() : 0})) tab->panel->draw(context);
  ImGui::EndChild();
  context.log.item(std::string("panel.") + tab->entry->title);
  if (card) draw_pinned_card(context);
  ImGui::End();
  draw_edge(top, bottom, size, width);
}

const PanelEntry* PanelColumn::draw_rail(EventLog& log, float top, float bottom, const std::string* open) {
  const float text = ImGui::GetFontSize(), width = rail_pixels(), side = 2.1f * text;
  ImGui::SetNextWindowPos({right_ ? ImGui::GetIO().DisplaySize.x - width : 0, top});
  ImGui::SetNextWindowSize({width, bottom - top});
  ImGui::SetNextWindowBgAlpha(0);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {(width - side) / 2, 0.5f * text});
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {0, 0.25f * text});
  ImGui::Begin((std::string(id_) + "rail").c_str(), nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoBringToFrontOnFocus);
  ImGui::PopStyleVar(2);
  const PanelEntry* clicked = nullptr;
  for (const Tab& tab : tabs_) {
    const bool on = open && *open == tab.entry->title;
    ImGui::PushStyleColor(ImGuiCol_Button, on ? ImGui::GetColorU32(ImGuiCol_Header) : IM_COL32_BLACK_TRANS);
    ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetColorU32(on ? ImGuiCol_Text : ImGuiCol_TextDisabled));
    if (ImGui::Button(fmt::format("{}##{}", tab.entry->icon, tab.entry->title).c_str(), {side, side}))
      clicked = tab.entry;
    ImGui::PopStyleColor(2);
    log.item(std::string("tab.") + tab.entry->title);
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    if (ImGui::IsItemHovered()) {  // beside the rail, so that it covers no icon
      ImGui::SetNextWindowPos({right_ ? low.x - 0.6f * text : high.x + 0.6f * text, (low.y + high.y) / 2},
                              ImGuiCond_Always, {right_ ? 1.0f : 0.0f, 0.5f});
      ImGui::SetTooltip("%s: %s", tab.entry->title, tab.entry->tooltip);
    }
  }
  ImGui::End();
  ImGui::PopStyleVar();
  return clicked;
}

// The user drags the inner edge to change the width.
void PanelColumn::draw_edge(float top, float bottom, float size, float& width) {
  const float grip = 0.4f * ImGui::GetFontSize(), screen = ImGui::GetIO().DisplaySize.x;
  const float edge = right_ ? screen - rail_pixels() - size : rail_pixels() + size;
  ImGui::SetNextWindowPos({edge - grip / 2, top});
  ImGui::SetNextWindowSize({grip, bottom - top});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0);
  ImGui::Begin((std::string(id_) + "edge").c_str(), nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoFocusOnAppearing);
  ImGui::InvisibleButton("edge", {grip, std::max(1.0f, bottom - top)});
  if (ImGui::IsItemHovered() || ImGui::IsItemActive()) {
    ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    ImGui::GetWindowDrawList()->AddRectFilled({edge - 1, top}, {edge + 1, bottom}, palette().accent);
  }
  if (item_dragged()) {
    const float x = ImGui::GetIO().MousePos.x;
    width = std::clamp(((right_ ? screen - x : x) - rail_pixels()) / ImGui::GetFontSize(), 14.0f, 60.0f);
  }
  ImGui::End();
  ImGui::PopStyleVar(3);
}

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
  if (context_.new_probe) show("Probes");
  frame_new_robots();
  context_.aspect = area.aspect();
  context_.log.item("view", area.low, area.high);
  return area;
}

void Panels::frame_new_robots() {
  const LiveRobots& robots = *context_.scene.snapshot().robots;
  const bool drawn =
      context_.scene.drawn().offsets().size() == robots.robots.size() &&
      std::ranges::all_of(context_.to_frame, [&](RobotId id) { return robots.index_of(id).has_value(); });
  if (context_.to_frame.empty() || !drawn) return;
  frame_robots(context_, std::exchange(context_.to_frame, {}));
}

// Whether the window has no room for two columns and a view.
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
  std::string& panel = side == Side::left ? preferences.left_panel : preferences.right_panel;
  const bool open = column_open(side);
  const float pixels = open ? PanelColumn::pixels(width, is_narrow()) : 0;
  const bool has_card = context_.pinned && (side == Side::left || !column_open(Side::left));
  if (open) column.draw(context_, top, bottom, pixels, panel, width, has_card);
  if (const PanelEntry* clicked = column.draw_rail(context_.log, top, bottom, open ? &panel : nullptr)) {
    if (open && panel == clicked->title)
      open_column(side, false);
    else
      show(clicked->title);
  }
  return PanelColumn::rail_pixels() + pixels;
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
  if (!context_.legend.empty()) context_.log.item("legend", context_.legend.low, context_.legend.high);
  draw_messages(area);
  context_.covered = {axes, context_.legend, explosions_.box(), context_.first_steps, context_.message};
  context_.covered.insert(context_.covered.end(), explosions_.marks().begin(), explosions_.marks().end());
  std::erase_if(context_.covered, [](const Box& box) { return box.empty(); });
  if (context_.dialogs.open()) palette_.close();
  palette_.draw(context_);
  if (context_.toasts.take_click()) show("Messages");
}

// While the menu bar is hidden, messages have a line at the top of the view, between caption and legend or below the
// caption. Its room is reserved, with a message or without.
void Panels::draw_messages(const ViewportArea& area) {
  context_.message = {};
  if (context_.preferences.panels) return;
  constexpr float least = 20;  // [letters]
  const float text = ImGui::GetFontSize();
  const Box &caption = context_.caption, &legend = context_.legend;
  Box room{area.low, {legend.empty() ? area.high.x : legend.low.x, area.low.y + Toasts::line_height()}};
  if (!caption.empty() && room.high.x - caption.high.x > least * text) {
    room.low.x = caption.high.x + text;
  } else if (!caption.empty()) {
    room.low.y = caption.high.y;
    room.high.y = room.low.y + Toasts::line_height();
  }
  context_.message = room;
  if (context_.toasts.empty()) return;
  ImGui::SetNextWindowPos(room.low);
  ImGui::SetNextWindowSize({room.high.x - room.low.x, room.high.y - room.low.y});
  ImGui::Begin("##messages", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoMove);
  context_.toasts.draw({room.low.x, (room.low.y + room.high.y - text) / 2}, room.high.x, context_.log);
  ImGui::End();
}

// Dear ImGui requires that no window outside a modal appears after it in the frame in which the modal opens.
void Panels::draw_dialogs() {
  if (palette_.is_open() || help_open_) hide_tooltip();
  context_.dialogs.draw(context_.log);
}

void Panels::work() {
  left_.work(context_);
  right_.work(context_);
}

void Panels::show(const std::string& panel) {
  context_.preferences.panels = true;
  open_column(left_.has(panel) ? Side::left : Side::right, true);
  (left_.has(panel) ? context_.preferences.left_panel : context_.preferences.right_panel) = panel;
  context_.log.write("panel", {{"name", panel}});
}

}  // namespace mercury::window
