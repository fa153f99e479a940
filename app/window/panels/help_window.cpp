// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/help_window.h"

#include <algorithm>
#include <string>

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
      group("Picture", keys);
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

}  // namespace mercury::window
