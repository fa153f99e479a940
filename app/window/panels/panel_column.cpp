// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/panel_column.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/window/toolkit/theme.h"
#include "app/window/toolkit/widgets.h"

namespace mercury::window {

PanelColumn::PanelColumn(Side side, PanelContext& context)
    : id_(side == Side::left ? "##left" : "##right"), right_(side == Side::right) {
  for (const PanelEntry& entry : panel_table())
    if (entry.side == side) tabs_.push_back({&entry, entry.make(context)});
}

void PanelColumn::work(PanelContext& context, double seconds) {
  for (const Tab& tab : tabs_) tab.panel->work(context, seconds);
}

bool PanelColumn::busy() const {
  return std::ranges::any_of(tabs_, [](const Tab& tab) { return tab.panel->busy(); });
}

float PanelColumn::pixels(float width, bool narrow) {
  const float text = ImGui::GetFontSize(), screen = ImGui::GetIO().DisplaySize.x;
  const float lines = width > 0 ? width : std::clamp(0.16f * screen / text, 18.0f, 30.0f);
  return std::min(lines * text, (narrow ? 0.75f : 0.38f) * screen);
}

bool PanelColumn::has(const std::string& title) const {
  return std::ranges::any_of(tabs_, [&](const Tab& tab) { return tab.entry->title == title; });
}

void PanelColumn::draw(PanelContext& context, float top, float bottom, float size, std::string& open, float& width) {
  if (!has(open)) open = tabs_.front().entry->title;
  const float screen = ImGui::GetIO().DisplaySize.x;
  ImGui::SetNextWindowPos({right_ ? screen - size : 0, top});
  ImGui::SetNextWindowSize({size, bottom - top});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0);
  ImGui::Begin(id_, nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoScrollWithMouse);
  ImGui::PopStyleVar();
  draw_tabs(context, open);
  ImGui::Separator();
  const auto tab = std::ranges::find_if(tabs_, [&](const Tab& other) { return other.entry->title == open; });
  // Each panel has an ImGui child of its own, which keeps its scroll position.
  if (ImGui::BeginChild(tab->entry->title, {0, 0})) tab->panel->draw(context);
  ImGui::EndChild();
  context.log.item(std::string("panel.") + tab->entry->title);
  ImGui::End();
  draw_edge(top, bottom, size, width);
}

void PanelColumn::draw_tabs(PanelContext& context, std::string& open) {
  const float spacing = 0.25f * ImGui::GetFontSize(), end = ImGui::GetWindowContentRegionMax().x;
  bool first = true;
  for (const Tab& tab : tabs_) {
    const PanelEntry& entry = *tab.entry;
    const float width = ImGui::CalcTextSize(entry.title).x + 2 * ImGui::GetStyle().FramePadding.x;
    if (!first) {
      ImGui::SameLine(0, spacing);
      if (ImGui::GetCursorPosX() + width > end) ImGui::NewLine();
    }
    first = false;
    const bool on = open == entry.title;
    ImGui::PushStyleColor(ImGuiCol_Button, on ? ImGui::GetColorU32(ImGuiCol_Header) : IM_COL32_BLACK_TRANS);
    if (ImGui::Button(entry.title) && !on) {
      open = entry.title;
      context.log.write("panel", {{"name", open}});
    }
    ImGui::PopStyleColor();
    // The tooltip appears below the tabs, so that it covers none.
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    if (!on && ImGui::IsItemHovered()) {
      ImGui::SetNextWindowPos({right_ ? high.x : low.x, high.y + 0.6f * ImGui::GetFontSize()}, ImGuiCond_Always,
                              {right_ ? 1.0f : 0.0f, 0});
      tooltip(entry.tooltip);
    }
    context.log.item(std::string("tab.") + entry.title);
  }
}

// The user drags the inner edge to change the width.
void PanelColumn::draw_edge(float top, float bottom, float size, float& width) {
  const float grip = 0.4f * ImGui::GetFontSize(), screen = ImGui::GetIO().DisplaySize.x;
  const float edge = right_ ? screen - size : size;
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
  if (ImGui::IsItemActive()) {
    const float x = ImGui::GetIO().MousePos.x;
    width = std::clamp((right_ ? screen - x : x) / ImGui::GetFontSize(), 14.0f, 60.0f);
  }
  ImGui::End();
  ImGui::PopStyleVar(3);
}

bool PanelColumn::draw_handle(EventLog& log, float middle, float size, bool open) {
  const float text = ImGui::GetFontSize(), width = 0.8f * text, height = 3.4f * text;
  const float from = size > 0 ? size + 0.2f * text : 0;  // leaves the edge free to be dragged
  const float left = right_ ? ImGui::GetIO().DisplaySize.x - from - width : from;
  ImGui::SetNextWindowPos({left, middle - height / 2});
  ImGui::SetNextWindowSize({width, height});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0);
  ImGui::Begin((std::string(id_) + "handle").c_str(), nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoFocusOnAppearing |
                   ImGuiWindowFlags_NoBringToFrontOnFocus);
  ImGui::PopStyleVar(3);
  const bool clicked = ImGui::InvisibleButton("handle", {width, height}), hovered = ImGui::IsItemHovered();
  log.item(right_ ? "handle.right" : "handle.left");
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(low, high, hovered ? palette().accent : palette().on_picture, 0.35f * text,
                     right_ ? ImDrawFlags_RoundCornersLeft : ImDrawFlags_RoundCornersRight);
  const float x = (low.x + high.x) / 2, y = (low.y + high.y) / 2, side = 0.22f * text,
              tip = right_ == open ? side : -side;
  list.AddTriangleFilled({x + tip, y}, {x - tip, y + 1.4f * tip}, {x - tip, y - 1.4f * tip},
                         hovered ? IM_COL32_WHITE : ImGui::GetColorU32(ImGuiCol_Text));
  tooltip(open ? "collapse these panels" : "open these panels");
  ImGui::End();
  return clicked;
}

}  // namespace mercury::window
