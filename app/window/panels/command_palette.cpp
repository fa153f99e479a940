// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/command_palette.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "app/window/toolkit/fuzzy_match.h"
#include "app/window/toolkit/key_bindings.h"
#include "app/window/toolkit/theme.h"
#include "app/window/toolkit/widgets.h"

namespace mercury::window {

void CommandPalette::open(std::function<std::vector<PaletteEntry>()> list) {
  entries_ = list();
  query_.clear();
  open_ = just_opened_ = true;
  accepted_ = false;
  moved_ = 0;
  search();
}

void CommandPalette::search() {
  std::vector<std::pair<int, std::size_t>> scores;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const auto score = fuzzy_match(query_, entries_[i].name);
    const auto in_group = fuzzy_match(query_, entries_[i].group + " " + entries_[i].name);
    // A letter found in the name counts more than one in the name of the group.
    if (score || in_group) scores.emplace_back(-std::max(score.value_or(-100'000), in_group.value_or(-100'000) - 8), i);
  }
  std::ranges::stable_sort(scores, {}, &std::pair<int, std::size_t>::first);
  found_.clear();
  for (const auto& [score, index] : scores) found_.push_back(index);
  mark_ = 0;
}

void CommandPalette::press(const KeyPress& press) {
  if (is_enter(press)) accepted_ = true;
  if (press.character != 0) return;
  if (press.key == GLFW_KEY_DOWN) ++moved_;
  if (press.key == GLFW_KEY_UP) --moved_;
  if (press.key == GLFW_KEY_PAGE_DOWN) moved_ += 8;
  if (press.key == GLFW_KEY_PAGE_UP) moved_ -= 8;
}

void CommandPalette::draw(PanelContext& context) {
  if (!open_) return;
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  const float text = ImGui::GetFontSize(), top = 0.12f * screen.y;
  ImGui::SetNextWindowPos({screen.x / 2, top}, ImGuiCond_Always, {0.5f, 0});
  ImGui::SetNextWindowSize({std::min(0.94f * screen.x, 36 * text), std::min(0.8f * screen.y, 26 * text)});
  ImGui::SetNextWindowBgAlpha(1);
  ImGui::SetNextWindowFocus();
  ImGui::Begin("##palette", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoNav);
  context.log.item(
      "panel.Palette", ImGui::GetWindowPos(),
      {ImGui::GetWindowPos().x + ImGui::GetWindowWidth(), ImGui::GetWindowPos().y + ImGui::GetWindowHeight()});
  ImGui::SetKeyboardFocusHere();
  ImGui::SetNextItemWidth(-1);
  const std::string before = query_;
  // Not in the first frame: the field has yet to receive what was typed before Enter.
  const bool accepted = std::exchange(accepted_, false) && !just_opened_;
  text_field("##query", query_, "a command, a robot or a setting");
  context.log.item("palette.query");
  if (query_ != before || std::exchange(just_opened_, false)) search();
  const int last = static_cast<int>(found_.size()) - 1;
  mark_ = std::clamp(mark_ + moved_, 0, std::max(0, last));
  std::optional<std::size_t> chosen;
  if (accepted && last >= 0) chosen = found_[static_cast<std::size_t>(mark_)];
  if (const auto clicked = draw_entries(context)) chosen = clicked;
  moved_ = 0;
  const bool left = ImGui::IsMouseClicked(0) && !ImGui::IsWindowHovered(ImGuiHoveredFlags_ChildWindows);
  ImGui::End();
  if (left) open_ = false;
  if (!chosen) return;
  open_ = false;
  context.log.write("palette", {{"name", entries_[*chosen].name}});
  const std::function<void()> act = entries_[*chosen].act;  // a copy, since it may open the palette again
  act();
}

std::optional<std::size_t> CommandPalette::draw_entries(PanelContext& context) {
  std::optional<std::size_t> clicked;
  if (ImGui::BeginChild("found", {0, 0})) {
    if (found_.empty()) note("nothing has these letters");
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(found_.size()), ImGui::GetTextLineHeightWithSpacing());
    if (moved_ != 0) {
      const float line = ImGui::GetTextLineHeightWithSpacing(), top = static_cast<float>(mark_) * line;
      if (top < ImGui::GetScrollY()) ImGui::SetScrollY(top);
      if (top + line > ImGui::GetScrollY() + ImGui::GetWindowHeight())
        ImGui::SetScrollY(top + line - ImGui::GetWindowHeight());
    }
    while (clipper.Step())
      for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
        const std::size_t index = found_[static_cast<std::size_t>(i)];
        const PaletteEntry& entry = entries_[index];
        const std::string right =
            entry.detail.empty() ? entry.group : fmt::format("{}   {}", entry.detail, entry.group);
        const float width = ImGui::GetContentRegionAvail().x, place = width - ImGui::CalcTextSize(right.c_str()).x;
        ImGui::PushID(i);
        if (ImGui::Selectable("##entry", i == mark_)) clicked = index;
        ImGui::PopID();
        if (i < 10) context.log.item(fmt::format("palette.{}", i));
        ImGui::SameLine(ImGui::GetStyle().ItemSpacing.x);
        ImGui::TextUnformatted(shortened(entry.name, place - 2 * ImGui::GetFontSize()).c_str());
        ImGui::SameLine(place);
        ImGui::PushStyleColor(ImGuiCol_Text, palette().faint);
        ImGui::TextUnformatted(right.c_str());
        ImGui::PopStyleColor();
      }
  }
  ImGui::EndChild();
  return clicked;
}

}  // namespace mercury::window
