// SPDX-License-Identifier: Apache-2.0
#include "app/window/toolkit/widgets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "app/window/toolkit/theme.h"

namespace mercury::window {
namespace {

constexpr float name_share = 0.42f;  // of a row's width
constexpr double rest_time = 0.4;    // of the pointer before a tooltip appears [s]
constexpr const char* reset_tooltip = "reset to the default";

// Like row(), with a reset button beside the name if `differs`. Returns true when that button was clicked.
bool row_with_reset(const char* name, const char* text, bool differs) {
  const float left = ImGui::GetCursorPosX(), width = ImGui::GetContentRegionAvail().x, names = name_share * width;
  const float side = 0.75f * ImGui::GetFrameHeight();
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(shortened(name, differs ? names - side - 0.3f * ImGui::GetFontSize() : names).c_str());
  tooltip(text);
  bool clicked = false;
  if (differs) {
    ImGui::SameLine();
    ImGui::SetCursorPosX(left + names - side - 0.3f * ImGui::GetFontSize());
    const float top = ImGui::GetCursorPosY();
    ImGui::SetCursorPosY(top + (ImGui::GetFrameHeight() - side) / 2);
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {0, 0});
    clicked = ImGui::Button("\xe2\x86\x90##reset", {side, side});
    ImGui::PopStyleVar();
    tooltip(reset_tooltip);
    ImGui::SameLine();
    ImGui::SetCursorPosY(top);
  } else {
    ImGui::SameLine();
  }
  ImGui::SetCursorPosX(left + names);
  ImGui::SetNextItemWidth(width - names);
  return clicked;
}

}  // namespace

void heading(const char* text) {
  ImGui::Dummy({0, 0.2f * ImGui::GetFontSize()});
  ImGui::PushStyleColor(ImGuiCol_Text, palette().accent);
  ImGui::TextUnformatted(text);
  ImGui::PopStyleColor();
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const float y = corner.y - 0.5f * ImGui::GetStyle().ItemSpacing.y;
  ImGui::GetWindowDrawList()->AddLine({corner.x, y}, {corner.x + ImGui::GetContentRegionAvail().x, y}, palette().grid);
  ImGui::Dummy({0, 0.1f * ImGui::GetFontSize()});
}

// Without this delay, tooltips would flicker under a pointer that moves across a panel.
bool pointer_rests() {
  static ImVec2 place;
  static double since = 0;
  const ImVec2 corner = ImGui::GetItemRectMin();
  if (corner.x != place.x || corner.y != place.y || ImGui::IsMouseDown(0)) {
    place = corner;
    since = ImGui::GetTime();
  }
  return ImGui::GetTime() - since > rest_time;
}

void tooltip(const char* text) {
  if (!text || !ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled) || !pointer_rests()) return;
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(22 * ImGui::GetFontSize());
  ImGui::TextUnformatted(text);
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

void row(const char* name, const char* text) { row_with_reset(name, text, false); }

void right_aligned(const std::string& text) {
  const float room = ImGui::GetContentRegionAvail().x - ImGui::CalcTextSize(text.c_str()).x;
  ImGui::SetCursorPosX(ImGui::GetCursorPosX() + std::max(0.0f, room));
  ImGui::TextUnformatted(text.c_str());
}

void note(const char* text) {
  ImGui::PushStyleColor(ImGuiCol_Text, palette().faint);
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(text);
  ImGui::PopTextWrapPos();
  ImGui::PopStyleColor();
}

bool toggle_button(const char* text, bool on) {
  if (on) {
    ImGui::PushStyleColor(ImGuiCol_Button, palette().accent);
    ImGui::PushStyleColor(ImGuiCol_ButtonHovered, palette().accent);
    ImGui::PushStyleColor(ImGuiCol_Text, IM_COL32_WHITE);
  }
  const bool clicked = ImGui::Button(text);
  if (on) ImGui::PopStyleColor(3);
  return clicked;
}

bool slider(const char* name, const char* text, float& value, float default_value, const SliderRange& range) {
  ImGui::PushID(name);
  const bool reset = row_with_reset(name, text, value != default_value);
  ImGuiSliderFlags flags = ImGuiSliderFlags_NoRoundToFormat;
  if (range.logarithmic) flags |= ImGuiSliderFlags_Logarithmic;
  float edited = value;
  bool changed = ImGui::SliderFloat("##value", &edited, range.low, range.high, range.format, flags);
  tooltip("drag, or Ctrl-click to type");
  if (reset) {
    edited = default_value;
    changed = true;
  }
  ImGui::PopID();
  if (changed && std::isfinite(edited)) value = edited;
  return changed;
}

bool slider(const char* name, const char* text, Vec3& value, Vec3 default_value, const SliderRange& range) {
  ImGui::PushID(name);
  const bool reset = row_with_reset(name, text, value != default_value);
  float edited[3] = {value.x, value.y, value.z};
  bool changed =
      ImGui::DragFloat3("##value", edited, (range.high - range.low) / 400, range.low, range.high, range.format);
  tooltip("x, y and z: drag, or Ctrl-click to type");
  if (reset) {
    edited[0] = default_value.x, edited[1] = default_value.y, edited[2] = default_value.z;
    changed = true;
  }
  ImGui::PopID();
  if (changed && std::isfinite(edited[0]) && std::isfinite(edited[1]) && std::isfinite(edited[2]))
    value = {edited[0], edited[1], edited[2]};
  return changed;
}

bool combo(const char* name, const char* text, int& index, const std::vector<const char*>& names) {
  ImGui::PushID(name);
  row(name, text);
  const bool changed = ImGui::Combo("##choice", &index, names.data(), static_cast<int>(names.size()));
  ImGui::PopID();
  return changed;
}

bool text_field(const char* id, std::string& text, const char* placeholder) {
  std::array<char, 2048> letters{};
  std::snprintf(letters.data(), letters.size(), "%s", text.c_str());
  const bool entered =
      ImGui::InputTextWithHint(id, placeholder, letters.data(), letters.size(),
                               ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
  text = letters.data();
  return entered;
}

std::string shortened(const std::string& text, float width, bool middle) {
  if (ImGui::CalcTextSize(text.c_str()).x <= width) return text;
  const char* dots = "\xe2\x80\xa6";
  // Do not cut a UTF-8 character in two.
  const auto whole_end = [&](std::size_t length) {
    while (length > 0 && (static_cast<unsigned char>(text[length]) & 0xc0) == 0x80) --length;
    return length;
  };
  const auto whole_begin = [&](std::size_t start) {
    while (start < text.size() && (static_cast<unsigned char>(text[start]) & 0xc0) == 0x80) ++start;
    return start;
  };
  for (std::size_t kept = text.size() - 1; kept > 0; --kept) {
    const std::size_t head = whole_end(middle ? kept / 3 : kept);
    const std::string shorter =
        text.substr(0, head) + dots + (middle ? text.substr(whole_begin(text.size() - (kept - kept / 3))) : "");
    if (ImGui::CalcTextSize(shorter.c_str()).x <= width) return shorter;
  }
  return dots;
}

}  // namespace mercury::window
