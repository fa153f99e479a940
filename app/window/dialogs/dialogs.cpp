// SPDX-License-Identifier: Apache-2.0
#include "app/window/dialogs/dialogs.h"

#include <algorithm>

#include "app/window/toolkit/key_bindings.h"
#include "app/window/toolkit/widgets.h"

namespace mercury::window {

void Dialogs::ask(Question question) {
  question_ = std::move(question);
  on_text_ = nullptr;
  open_ = just_opened_ = true;
  accepted_ = canceled_ = false;
}

void Dialogs::ask_text(std::string title, std::string question, std::string text, std::string button,
                       std::function<void(const std::string&)> on_accept) {
  ask({.title = std::move(title), .text = std::move(question), .button = std::move(button), .on_accept = {}});
  files_.forget();
  text_ = std::move(text);
  on_text_ = std::move(on_accept);
}

void Dialogs::close() {
  if (open_)
    canceled_ = true;
  else
    files_.close();
}

void Dialogs::press(const KeyPress& press) {
  if (files_.open() && !open_) files_.press(press);
  if (open_ && is_enter(press)) accepted_ = true;
}

void Dialogs::draw(EventLog& log) {
  files_.draw(log);
  draw_question(log);
}

void Dialogs::draw_question(EventLog& log) {
  if (!open_ && !shown_) return;
  const std::string id = question_.title + "###dialog";
  if (open_ && just_opened_) ImGui::OpenPopup(id.c_str());
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  const float text = ImGui::GetFontSize();
  const bool low = screen.y < 26 * text;  // a form fills the screen
  ImGui::SetNextWindowPos({screen.x / 2, (low ? 0.5f : 0.42f) * screen.y}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSize({std::min(0.94f * screen.x, 34 * text), 0});
  const ImVec2 spacing = ImGui::GetStyle().ItemSpacing, padding = ImGui::GetStyle().FramePadding;
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {spacing.x, low ? 0.3f * spacing.y : spacing.y});
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {padding.x, low ? 0.5f * padding.y : padding.y});
  if (!ImGui::BeginPopupModal(id.c_str(), nullptr,
                              ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings)) {
    open_ = shown_ = false;
    ImGui::PopStyleVar(2);
    return;
  }
  shown_ = open_;
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(brief(question_.text, 2000).c_str());
  ImGui::PopTextWrapPos();
  // Not in the first frame: the text field has yet to receive what was typed before Enter.
  bool accepted = accepted_ && !just_opened_;
  if (on_text_) {
    if (just_opened_) ImGui::SetKeyboardFocusHere();
    ImGui::SetNextItemWidth(-1);
    accepted |= text_field("##text", text_);
    log.item("dialog.text");
  }
  const bool acceptable = !question_.form || question_.form(log);
  if (!acceptable) accepted = accepted_ = false;
  just_opened_ = false;
  Button pressed = draw_buttons(log, acceptable);
  if (canceled_) pressed = Button::cancel;
  if (accepted && pressed == Button::none) pressed = Button::accept;
  if (pressed != Button::none) {
    open_ = shown_ = accepted_ = canceled_ = false;
    ImGui::CloseCurrentPopup();
  }
  ImGui::EndPopup();
  ImGui::PopStyleVar(2);
  answer(pressed);
}

Dialogs::Button Dialogs::draw_buttons(EventLog& log, bool acceptable) {
  Button pressed = Button::none;
  const float text = ImGui::GetFontSize();
  const float width = std::max(7 * text, ImGui::CalcTextSize(question_.button.c_str()).x + 2 * text);
  ImGui::Dummy({0, 0.2f * text});
  const float buttons = question_.other_button.empty() ? 2 : 3;
  const float room =
      ImGui::GetContentRegionAvail().x - buttons * width - (buttons - 1) * ImGui::GetStyle().ItemSpacing.x;
  ImGui::SetCursorPosX(ImGui::GetCursorPosX() + std::max(0.0f, room));
  if (ImGui::Button("Cancel", {width, 0})) pressed = Button::cancel;
  log.item("dialog.cancel");
  ImGui::SameLine();
  if (!question_.other_button.empty()) {
    if (ImGui::Button(question_.other_button.c_str(), {width, 0})) pressed = Button::other;
    log.item("dialog.other");
    ImGui::SameLine();
  }
  ImGui::BeginDisabled(!acceptable);
  if (primary_button(question_.button.c_str(), {width, 0})) pressed = Button::accept;
  log.item("dialog.accept");
  ImGui::EndDisabled();
  return pressed;
}

// Works on copies, since each callback may open the next dialog.
void Dialogs::answer(Button pressed) {
  const Question question = question_;
  const auto on_text = on_text_;
  if (pressed == Button::cancel && question.on_cancel) question.on_cancel();
  if (pressed == Button::other) question.on_other();
  if (pressed != Button::accept) return;
  if (on_text)
    on_text(text_);
  else
    question.on_accept();
}

}  // namespace mercury::window
