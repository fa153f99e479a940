// SPDX-License-Identifier: Apache-2.0
#include "app/window/dialogs/dialogs.h"

#include <algorithm>
#include <utility>

#include "app/window/toolkit/key_bindings.h"
#include "app/window/toolkit/widgets.h"

namespace mercury::window {

void Dialogs::ask(Question question) {
  question_ = std::move(question);
  act_with_text_ = nullptr;
  open_ = fresh_ = true;
  accepted_ = refused_ = false;
}

void Dialogs::ask_text(std::string title, std::string question, std::string text, std::string button,
                       std::function<void(const std::string&)> act) {
  ask({.title = std::move(title), .text = std::move(question), .button = std::move(button), .act = {}});
  files_.forget();
  text_ = std::move(text);
  act_with_text_ = std::move(act);
}

void Dialogs::close() {
  if (open_)
    refused_ = true;
  else
    files_.close();
}

void Dialogs::press(const Press& press) {
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
  if (open_ && fresh_) ImGui::OpenPopup(id.c_str());
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  const float text = ImGui::GetFontSize();
  ImGui::SetNextWindowPos({screen.x / 2, 0.42f * screen.y}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSize({std::min(0.94f * screen.x, 34 * text), 0});
  if (!ImGui::BeginPopupModal(id.c_str(), nullptr,
                              ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings)) {
    open_ = shown_ = false;
    return;
  }
  shown_ = open_;
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(question_.text.c_str());
  ImGui::PopTextWrapPos();
  // What was typed before Enter counts.
  bool accepted = accepted_ && !fresh_, other = false;
  if (act_with_text_) {
    if (fresh_) ImGui::SetKeyboardFocusHere();
    ImGui::SetNextItemWidth(-1);
    accepted |= text_field("##text", text_);
    log.item("dialog.text");
  }
  fresh_ = false;
  const float width = std::max(7 * text, ImGui::CalcTextSize(question_.button.c_str()).x + 2 * text);
  ImGui::Dummy({0, 0.2f * text});
  const float buttons = question_.other_button.empty() ? 2 : 3;
  const float room =
      ImGui::GetContentRegionAvail().x - buttons * width - (buttons - 1) * ImGui::GetStyle().ItemSpacing.x;
  ImGui::SetCursorPosX(ImGui::GetCursorPosX() + std::max(0.0f, room));
  const bool refused = ImGui::Button("Cancel", {width, 0}) || refused_;
  log.item("dialog.cancel");
  ImGui::SameLine();
  if (!question_.other_button.empty()) {
    other = ImGui::Button(question_.other_button.c_str(), {width, 0});
    log.item("dialog.other");
    ImGui::SameLine();
  }
  accepted |= ImGui::Button(question_.button.c_str(), {width, 0});
  log.item("dialog.accept");
  if (accepted || refused || other) {
    open_ = shown_ = accepted_ = refused_ = false;
    ImGui::CloseCurrentPopup();
  }
  ImGui::EndPopup();
  // Any of them may open the next dialog, in the place of this one.
  const Question asked = question_;
  const auto with_text = act_with_text_;
  if (refused && asked.refused) asked.refused();
  if (refused) return;
  if (other)
    asked.other_act();
  else if (accepted && with_text)
    with_text(text_);
  else if (accepted)
    asked.act();
}

}  // namespace mercury::window
