// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/help_window.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <string>
#include <vector>

#include "app/live/background.h"
#include "app/live/scene_comparison.h"
#include "app/live/scene_robots.h"
#include "app/window/toolkit/theme.h"
#include "app/window/toolkit/widgets.h"

namespace mercury::window {
namespace {

void line(const std::string& keys, const char* meaning) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ImGui::PushStyleColor(ImGuiCol_Text, palette().accent);
  ImGui::TextUnformatted(keys.c_str());
  ImGui::PopStyleColor();
  ImGui::TableNextColumn();
  ImGui::TextWrapped("%s", meaning);
}

bool begin_lines(const char* id) {
  if (!ImGui::BeginTable(id, 2, ImGuiTableFlags_SizingFixedFit)) return false;
  ImGui::TableSetupColumn("keys", ImGuiTableColumnFlags_WidthFixed, 9.5f * ImGui::GetFontSize());
  ImGui::TableSetupColumn("meaning", ImGuiTableColumnFlags_WidthStretch);
  return true;
}

void group(const std::string& name, const KeyMap& keys) {
  heading(name.c_str());
  if (!begin_lines(name.c_str())) return;
  for (const KeyBinding& binding : key_bindings())
    if (const std::string given = keys.keys_of(binding.action); binding.group == name && !given.empty())
      line(given, binding.meaning);
  ImGui::EndTable();
}

void mouse() {
  heading("Mouse");
  if (!begin_lines("mouse")) return;
  for (const MouseGesture& use : mouse_gestures()) line(use.gesture, use.meaning);
  ImGui::EndTable();
}

struct Gesture {
  const char* hand;
  const char* effect;
};
constexpr std::array<Gesture, 4> gestures{
    {{"drag", "turn"}, {"right drag", "move"}, {"wheel", "zoom"}, {"Ctrl drag", "pull a mass"}}};
constexpr float fade_time = 0.8f;  // [s]

ImU32 faded(ImU32 color, float opacity) {
  ImVec4 parts = ImGui::ColorConvertU32ToFloat4(color);
  parts.w *= opacity;
  return ImGui::ColorConvertFloat4ToU32(parts);
}

float width_of(const Gesture& gesture) {
  return ImGui::CalcTextSize(gesture.hand).x + ImGui::CalcTextSize(gesture.effect).x + 1.6f * ImGui::GetFontSize();
}

void draw_chip(const Gesture& gesture, ImVec2 at, float opacity) {
  const float text = ImGui::GetFontSize(), margin = 0.5f * text;
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  list.AddRectFilled(at, {at.x + width_of(gesture), at.y + 1.7f * text}, faded(palette().on_view, 0.85f * opacity),
                     0.4f * text);
  list.AddText({at.x + margin, at.y + 0.35f * text}, faded(palette().accent, opacity), gesture.hand);
  list.AddText({at.x + margin + ImGui::CalcTextSize(gesture.hand).x + 0.6f * text, at.y + 0.35f * text},
               faded(ImGui::GetColorU32(ImGuiCol_Text), opacity), gesture.effect);
}

// Without what stands at the right or covers the lower end.
ViewportArea free_part(ViewportArea area, std::initializer_list<Box> taken) {
  const float rows = 5 * ImGui::GetFontSize();
  for (const Box& box : taken) {
    const bool at_right = box.low.x > (area.low.x + area.high.x) / 2;
    if (!box.meets({{area.low.x, area.high.y - rows}, area.high})) continue;
    if (at_right)
      area.high.x = box.low.x;
    else
      area.high.y = box.low.y;
  }
  return area;
}

// What to do where there are no robots.
void draw_empty_hint(PanelContext& context, const ViewportArea& view) {
  const std::string lines[] = {
      "No robots",
      fmt::format("Open files ({}), or drop them here", context.keys.keys_of(Action::open)),
      fmt::format("Make random robots ({})", context.keys.keys_of(Action::new_random)),
  };
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const float text = ImGui::GetFontSize();
  float y = (view.low.y + view.high.y) / 2 - 2.2f * text, widest = 0;
  for (const std::string& line : lines) widest = std::max(widest, ImGui::CalcTextSize(line.c_str()).x);
  const float middle = (view.low.x + view.high.x) / 2;
  const ImVec2 low{middle - widest / 2 - text, y - 0.8f * text}, high{middle + widest / 2 + text, y + 5 * text};
  list.AddRectFilled(low, high, palette().on_view, 0.5f * text);
  context.log.item("empty_hint", low, high);
  for (const std::string& line : lines) {
    const bool first = &line == lines;
    list.AddText({middle - ImGui::CalcTextSize(line.c_str()).x / 2, y},
                 first ? ImGui::GetColorU32(ImGuiCol_Text) : palette().faint, line.c_str());
    y += first ? 1.9f * text : 1.4f * text;
  }
}

}  // namespace

void draw_help(bool& open, const KeyMap& keys, EventLog& log) {
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  const float text = ImGui::GetFontSize();
  const ImVec2 size{std::min(0.96f * screen.x, 58 * text), std::min(0.96f * screen.y, 41.5f * text)};
  // Stay below the menu bar.
  const float top = std::max((screen.y - size.y) / 2, ImGui::GetFrameHeight() + 0.2f * text);
  ImGui::SetNextWindowPos({(screen.x - size.x) / 2, top}, ImGuiCond_Appearing);
  ImGui::SetNextWindowSize({size.x, std::min(size.y, screen.y - top - 0.2f * text)}, ImGuiCond_Appearing);
  ImGui::SetNextWindowBgAlpha(1);
  if (ImGui::Begin("Keys and mouse###Help", &open, ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings)) {
    log.item("panel.Help", ImGui::GetWindowPos(),
             {ImGui::GetWindowPos().x + ImGui::GetWindowSize().x, ImGui::GetWindowPos().y + ImGui::GetWindowSize().y});
    const bool two = ImGui::GetWindowWidth() > 48 * text;
    if (ImGui::BeginTable("columns", two ? 2 : 1, ImGuiTableFlags_SizingStretchSame)) {
      ImGui::TableNextColumn();
      mouse();
      group("Time", keys);
      group("View", keys);
      group("Colors", keys);
      ImGui::TableNextColumn();
      group("Robots", keys);
      group("Camera", keys);
      group("Window", keys);
      ImGui::EndTable();
    }
  }
  ImGui::End();
}

void FirstSteps::draw(PanelContext& context, const ViewportArea& view, std::initializer_list<Box> taken, double dt) {
  Preferences& preferences = context.preferences;
  const UsedGestures& used = context.gestures;
  const std::array now{used.turned, used.moved, used.zoomed, used.pulled};
  std::vector<std::size_t> shown;
  fading_ = false;
  context.first_steps = {};
  for (std::size_t i = 0; i < gestures.size(); ++i) {
    preferences.gestures_used[i] = preferences.gestures_used[i] || now[i];
    if (preferences.gestures_used[i]) opacity_[i] -= static_cast<float>(dt) / fade_time;
    // One that was used in an earlier session does not appear at all.
    if (preferences.gestures_used[i] && !now[i]) opacity_[i] = 0;
    fading_ = fading_ || (preferences.gestures_used[i] && opacity_[i] > 0);
    if (opacity_[i] > 0) shown.push_back(i);
  }
  if (context.scene.robots().count() == 0 && context.scene.work().empty()) {
    draw_empty_hint(context, view);
    return;
  }
  if (!context.preferences.panels) return;
  const ViewportArea area = free_part(view, taken);
  // As many rows as the width of the view needs.
  const float text = ImGui::GetFontSize(), spacing = 0.5f * text, room = area.width() - 2 * text;
  std::vector<std::vector<std::size_t>> rows;
  float filled = room;
  for (const std::size_t i : shown) {
    const float width = width_of(gestures[i]);
    if (rows.empty() || filled + spacing + width > room) {
      rows.emplace_back();
      filled = -spacing;
    }
    rows.back().push_back(i);
    filled += spacing + width;
  }
  if (area.height() < 0.5f * view.height()) return;
  // A narrow side has other texts there.
  if (rows.size() > 1 && (context.scene.comparison().second() || !context.scene.comparison().ghosts().empty())) return;
  float y = area.high.y - (2.1f * static_cast<float>(rows.size()) + 0.5f) * text;
  if (!rows.empty()) context.first_steps = {{area.low.x, y}, area.high};
  for (const std::vector<std::size_t>& row : rows) {
    float width = -spacing;
    for (const std::size_t i : row) width += spacing + width_of(gestures[i]);
    float x = (area.low.x + area.high.x - width) / 2;
    for (const std::size_t i : row) {
      const Gesture& gesture = gestures[i];
      draw_chip(gesture, {x, y}, std::clamp(opacity_[i], 0.0f, 1.0f));
      context.log.item(std::string("gesture.") + gesture.effect, {x, y}, {x + width_of(gesture), y + 1.7f * text});
      x += width_of(gesture) + spacing;
    }
    y += 2.1f * text;
  }
}

}  // namespace mercury::window
