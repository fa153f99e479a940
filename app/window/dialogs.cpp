#include "app/window/dialogs.h"

#include <algorithm>
#include <utility>

#include "app/window/widgets.h"

namespace mercury::window {

void Dialogs::ask(std::string title, std::string question, std::string button, std::function<void()> act) {
  ask_text(std::move(title), std::move(question), "", std::move(button), [act = std::move(act)](const std::string&) { act(); });
  wants_text_ = false;
}

void Dialogs::ask_text(std::string title, std::string question, std::string text, std::string button,
                       std::function<void(const std::string&)> act) {
  title_ = std::move(title);
  question_ = std::move(question);
  text_ = std::move(text);
  button_ = std::move(button);
  act_ = std::move(act);
  wants_text_ = open_ = fresh_ = true;
  accepted_ = false;
}

void Dialogs::draw(Observations& observations) {
  if (!open_ && !shown_) return;
  const std::string id = title_ + "###dialog";
  if (open_ && fresh_) ImGui::OpenPopup(id.c_str());
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  const float text = ImGui::GetFontSize();
  ImGui::SetNextWindowPos({screen.x / 2, 0.42f * screen.y}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSize({std::min(0.94f * screen.x, 34 * text), 0});
  if (!ImGui::BeginPopupModal(id.c_str(), nullptr, ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings)) {
    open_ = shown_ = false;
    return;
  }
  shown_ = open_;
  if (!open_) {  // Esc
    ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
    return;
  }
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(question_.c_str());
  ImGui::PopTextWrapPos();
  bool accepted = accepted_ && !fresh_;
  if (wants_text_) {
    if (fresh_) ImGui::SetKeyboardFocusHere();
    ImGui::SetNextItemWidth(-1);
    accepted |= text_field("##text", text_);
    observations.item("dialog.text");
  }
  fresh_ = false;
  const float width = std::max(7 * text, ImGui::CalcTextSize(button_.c_str()).x + 2 * text);
  ImGui::Dummy({0, 0.2f * text});
  const float room = ImGui::GetContentRegionAvail().x - 2 * width - ImGui::GetStyle().ItemSpacing.x;
  ImGui::SetCursorPosX(ImGui::GetCursorPosX() + std::max(0.0f, room));
  const bool refused = ImGui::Button("Cancel", {width, 0});
  observations.item("dialog.cancel");
  ImGui::SameLine();
  accepted |= ImGui::Button(button_.c_str(), {width, 0});
  observations.item("dialog.accept");
  if (accepted || refused) {
    open_ = shown_ = accepted_ = false;
    ImGui::CloseCurrentPopup();
  }
  ImGui::EndPopup();
  // It may open the next dialog.
  if (accepted) std::exchange(act_, nullptr)(text_);
}

}  // namespace mercury::window
