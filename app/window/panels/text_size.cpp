// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/text_size.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/window/toolkit/widgets.h"

namespace mercury::window {

void change_text_size(PanelContext& context, int tenths) {
  const float wanted = std::round(10 * context.preferences.text_scale + static_cast<float>(tenths)) / 10;
  context.preferences.text_scale = std::clamp(wanted, Preferences::least_text, Preferences::most_text);
}

void TextSizeRow::draw(PanelContext& context) {
  row("text size", fmt::format("of the panels (keys {} and {})", context.keys.keys_of(Action::larger_text),
                               context.keys.keys_of(Action::smaller_text))
                       .c_str());
  const float font = ImGui::GetFontSize(), width = 1.8f * font, height = ImGui::GetFrameHeight();
  const ImVec2 low = ImGui::GetCursorScreenPos();
  if (pinned_) {
    ImGui::Dummy({width, height});
    draw_pinned(context);
    return;
  }
  const float before = context.preferences.text_scale;
  draw_buttons(context, width, height);
  if (context.preferences.text_scale == before) return;
  pinned_ = {low, {low.x + 2 * width + ImGui::GetStyle().ItemSpacing.x, low.y + height}, font};
  draw_pinned(context);  // at once, so that the next click finds it
}

void TextSizeRow::draw_buttons(PanelContext& context, float width, float height) {
  if (ImGui::Button("-##text", {width, height})) change_text_size(context, -1);
  context.log.item("text.smaller");
  ImGui::SameLine();
  if (ImGui::Button("+##text", {width, height})) change_text_size(context, 1);
  context.log.item("text.larger");
  ImGui::SameLine();
  ImGui::AlignTextToFramePadding();
  ImGui::Text("%.0f %%", 100 * static_cast<double>(context.preferences.text_scale));
}

void TextSizeRow::draw_pinned(PanelContext& context) {
  const Pinned pinned = *pinned_;
  const float scale = pinned.font / ImGui::GetFontSize(), height = pinned.high.y - pinned.low.y;
  const float spacing = 0.5f * pinned.font, width = (pinned.high.x - pinned.low.x - spacing) / 2;
  ImGui::SetNextWindowPos(pinned.low);
  ImGui::SetNextWindowSize({pinned.high.x - pinned.low.x + 4 * pinned.font, height});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {spacing, 0});
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {0, 0});
  ImGui::Begin("##textsize", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoNav);
  ImGui::SetWindowFontScale(scale);
  draw_buttons(context, width, height);
  ImGui::End();
  ImGui::PopStyleVar(4);
  const float margin = 0.6f * pinned.font;
  const ImVec2 low{pinned.low.x - margin, pinned.low.y - margin}, high{pinned.high.x + margin, pinned.high.y + margin};
  if (!ImGui::IsMouseHoveringRect(low, high, false)) pinned_.reset();
}

}  // namespace mercury::window
