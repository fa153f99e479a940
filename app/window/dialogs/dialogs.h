// SPDX-License-Identifier: Apache-2.0
// Modal dialogs in the middle of the window, one at a time.
#pragma once

#include <functional>
#include <string>
#include <utility>

#include "app/window/dialogs/file_dialog.h"
#include "app/window/toolkit/event_log.h"

namespace mercury::window {

// A message with a button, perhaps a second one, and "Cancel"; perhaps with controls below the text.
struct Question {
  std::string title, text;
  std::string button;
  std::function<void()> on_accept;
  std::string other_button = {};
  std::function<void()> on_other = {};
  std::function<void()> on_cancel = {};  // Cancel or Esc; may be empty
  // Draws controls; returns whether their values can be accepted. May be empty.
  std::function<bool(EventLog& log)> form = {};
};

class Dialogs {
 public:
  void ask(Question question);
  // Asks for a line of text, which starts as `text`; calls `on_accept` with what was typed.
  void ask_text(std::string title, std::string question, std::string text, std::string button,
                std::function<void(const std::string&)> on_accept);
  // Asks for files or a folder; calls `on_accept` with the choice.
  void ask_files(FileRequest request, std::function<void(const FileChoice&)> on_accept) {
    files_.ask(std::move(request), std::move(on_accept));
  }
  // Shows the last file dialog again, as the user left it. `error`: why its last answer could not be used; empty =
  // nothing to say.
  void reopen_file_dialog(std::string error = {}) { files_.reopen(std::move(error)); }

  bool open() const { return open_ || files_.open(); }
  // Closes the open dialog as Esc does.
  void close();
  // Handles a key press while a dialog is open.
  void press(const KeyPress& press);
  void draw(EventLog& log);

 private:
  enum class Button { none, accept, other, cancel };
  void draw_question(EventLog& log);
  Button draw_buttons(EventLog& log, bool acceptable);
  void answer(Button pressed);

  Question question_;
  std::string text_;
  std::function<void(const std::string&)> on_text_;  // of a question that asks for text
  bool open_ = false;
  bool just_opened_ = false;
  bool accepted_ = false, canceled_ = false;  // by a key
  bool shown_ = false;                        // ImGui has the popup open
  FileDialog files_;
};

}  // namespace mercury::window
