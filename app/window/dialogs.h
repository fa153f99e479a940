// Questions in the middle of the window: one at a time.
#pragma once

#include <functional>
#include <string>

#include "app/window/observations.h"

namespace mercury::window {

class Dialogs {
 public:
  // A question with a button that does something, and one that does nothing.
  void ask(std::string title, std::string question, std::string button, std::function<void()> act);
  // Asks for a line of text that begins with `text`; `act` is given what was typed.
  void ask_text(std::string title, std::string question, std::string text, std::string button,
                std::function<void(const std::string&)> act);

  bool open() const { return open_; }
  void close() { open_ = false; }
  // As its button does; what was typed before counts.
  void accept() { accepted_ = open_; }
  void draw(Observations& observations);

 private:
  std::string title_, question_, text_, button_;
  bool wants_text_ = false, open_ = false, fresh_ = false;
  bool accepted_ = false;
  bool shown_ = false;  // ImGui has it open
  std::function<void(const std::string&)> act_;
};

}  // namespace mercury::window
