// SPDX-License-Identifier: Apache-2.0
// The history of messages, to read again and to copy.
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/live/messages.h"
#include "app/window/panels/panel.h"
#include "app/window/toolkit/theme.h"
#include "app/window/toolkit/widgets.h"

namespace mercury::window {

class MessagesPanel : public Panel {
 public:
  void draw(PanelContext& context) override;

 private:
  void draw_row(PanelContext& context, const PastMessage& message, std::size_t row);

  std::optional<Tone> only_;  // shows messages of this tone only
  std::size_t seen_ = 0;      // messages when the panel was drawn last
};

namespace {

constexpr std::size_t longest = 4000;  // of what is drawn [letters]; a copy has the rest

std::string line_of(const PastMessage& message) {
  return fmt::format("{}  {}  {}{}", time_of_day(message.time), name_of(message.tone), message.text,
                     message.count > 1 ? fmt::format("  (x{})", message.count) : "");
}

void copy(PanelContext& context, const std::string& text) {
  ImGui::SetClipboardText(text.c_str());
  context.log.write("copied", {{"text", text}});
}

Tone tone_of(Severity severity) {
  switch (severity) {
    case Severity::warning:
      return Tone::warning;
    case Severity::error:
      return Tone::error;
    default:
      return Tone::info;
  }
}

}  // namespace

void show_messages(Toasts& toasts, const std::vector<Message>& messages) {
  for (const Message& message : messages) toasts.show(tone_of(message.severity), message.text);
}

void MessagesPanel::draw(PanelContext& context) {
  const std::deque<PastMessage>& history = context.toasts.history();
  struct Filter {
    std::optional<Tone> tone;
    const char* name;
  };
  for (const Filter& filter : {Filter{std::nullopt, "All"}, {Tone::warning, "Warnings"}, {Tone::error, "Errors"}}) {
    if (filter.tone) ImGui::SameLine(0, 0.3f * ImGui::GetFontSize());
    if (toggle_button(filter.name, only_ == filter.tone)) only_ = filter.tone;
    context.log.item(fmt::format("messages.{}", filter.name));
  }
  const float button = ImGui::GetFrameHeightWithSpacing();
  if (ImGui::BeginChild("history", {0, -button})) {
    std::size_t row = 0;
    for (const PastMessage& message : history)
      if (!only_ || only_ == message.tone) draw_row(context, message, row++);
    if (row == 0) note("none so far");
    if (seen_ != history.size()) ImGui::SetScrollHereY(1);
    seen_ = history.size();
  }
  ImGui::EndChild();
  ImGui::BeginDisabled(history.empty());
  if (ImGui::Button("Copy all", {-1, 0})) {
    std::string text;
    for (const PastMessage& message : history)
      if (!only_ || only_ == message.tone) text += line_of(message) + "\n";
    copy(context, text);
  }
  context.log.item("messages.copy");
  tooltip("copy these messages; a click on one copies it alone");
  ImGui::EndDisabled();
}

void MessagesPanel::draw_row(PanelContext& context, const PastMessage& message, std::size_t row) {
  ImGui::PushID(static_cast<int>(row));
  const float text = ImGui::GetFontSize(), indent = 0.6f * text;
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x - indent;
  const std::string shown =
      brief(message.text, longest) + (message.count > 1 ? fmt::format("  (x{})", message.count) : "");
  const float height = text + ImGui::CalcTextSize(shown.c_str(), nullptr, false, width).y + 0.3f * text;
  if (ImGui::Selectable("##message", false, 0, {0, height})) copy(context, line_of(message));
  if (row < 20 && ImGui::IsItemVisible()) context.log.item(fmt::format("message.{}", row));
  tooltip("click to copy");
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(corner, {corner.x + 0.2f * text, corner.y + height}, color_of(message.tone));
  const std::string when = fmt::format("{}  {}", time_of_day(message.time), name_of(message.tone));
  list.AddText({corner.x + indent, corner.y}, palette().faint, when.c_str());
  list.AddText(nullptr, 0, {corner.x + indent, corner.y + text}, ImGui::GetColorU32(ImGuiCol_Text), shown.c_str(),
               nullptr, width);
  ImGui::PopID();
}

std::unique_ptr<Panel> make_messages_panel(PanelContext&) { return std::make_unique<MessagesPanel>(); }

}  // namespace mercury::window
