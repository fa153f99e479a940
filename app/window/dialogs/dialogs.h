// SPDX-License-Identifier: Apache-2.0
// Questions in the middle of the window: one at a time.
#pragma once

#include <functional>
#include <string>

#include "app/window/dialogs/file_dialog.h"
#include "app/window/toolkit/event_log.h"

namespace mercury::window {

// A question with a button that does something, perhaps a second one, and "Cancel".
struct Question {
  std::string title, text;
  std::string button;
  std::function<void()> act;
  std::string other_button = {};
  std::function<void()> other_act = {};
  std::function<void()> refused = {};  // Cancel or Esc; nothing = nothing happens
};

class Dialogs {
 public:
  void ask(Question question);
  // Asks for a line of text that begins with `text`; `act` is given what was typed.
  void ask_text(std::string title, std::string question, std::string text, std::string button,
                std::function<void(const std::string&)> act);
  // Asks for files or a folder.
  void ask_files(FileQuestion question, std::function<void(const FileAnswer&)> act) {
    files_.ask(std::move(question), std::move(act));
  }
  // Asks for the files that were asked for last once more.
  void ask_files_again() { files_.ask_again(); }

  bool open() const { return open_ || files_.open(); }
  // Esc.
  void close();
  // A key pressed while one is open.
  void press(const Press& press);
  void draw(EventLog& log);

 private:
  void draw_question(EventLog& log);

  Question question_;
  std::string text_;
  std::function<void(const std::string&)> act_with_text_;  // of a question that wants text
  bool open_ = false, fresh_ = false;
  bool accepted_ = false, refused_ = false;  // by a key
  bool shown_ = false;                       // ImGui has it open
  FileDialog files_;
};

}  // namespace mercury::window
