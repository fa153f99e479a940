// SPDX-License-Identifier: Apache-2.0
// The dialog that opens and saves files.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "app/window/dialogs/folder_listing.h"
#include "app/window/toolkit/event_log.h"
#include "app/window/toolkit/window.h"

namespace mercury::window {

struct FileRequest {
  // open: existing files. save: one file, which may be new. folder: one folder, which may be new.
  enum class Kind { open, save, folder } kind = Kind::open;
  std::string title, button;
  std::vector<std::string> extensions;  // of the files listed; the first is the default
  std::filesystem::path folder;         // shown first; the working directory if it does not exist
  std::string name;                     // shown first
  std::vector<const char*> formats;     // to choose from, may be empty; for Kind::save, one per extension
};

struct FileChoice {
  std::vector<std::filesystem::path> paths;  // not empty; several only for Kind::open
  std::size_t format = 0;                    // index into FileRequest::formats
};

class FileDialog {
 public:
  void ask(FileRequest request, std::function<void(const FileChoice&)> on_accept);
  // Shows the last request again, as the user left it, with a line that says what was wrong; does nothing after
  // forget().
  void reopen(std::string error);
  void forget() { on_accept_ = nullptr; }

  bool open() const { return open_; }
  void close() { open_ = false; }
  // Handles a key press while the dialog is open.
  void press(const KeyPress& press);
  void draw(EventLog& log);

 private:
  bool opens_robots() const;
  void draw_places(EventLog& log);
  void draw_items(EventLog& log);
  void draw_row(std::size_t index, EventLog& log);
  void draw_name(EventLog& log);
  void draw_buttons(EventLog& log);
  void set_text(std::string text);
  void typed();
  void enter(const std::filesystem::path& folder);
  void go_up();
  void click(std::size_t index);
  void accept();
  void accept_typed();
  void finish(std::vector<std::filesystem::path> paths);

  FileRequest request_;
  std::function<void(const FileChoice&)> on_accept_;
  FolderListing view_;
  std::string text_, folder_text_;  // the fields for name and folder
  std::string error_;               // why they cannot be used; empty = no error
  int text_edition_ = 0;            // grows when the program sets text_, so that ImGui drops its own copy
  int format_ = 0;
  bool open_ = false, just_opened_ = false, shown_ = false;
  bool focus_ = false;          // the next frame gives the name field the keyboard
  bool reveal_ = false;         // the next frame scrolls to the marked row
  bool folder_active_ = false;  // the folder field has the keyboard
  bool entered_ = false;        // Enter was pressed
  FileChoice choice_;
  bool chosen_ = false;
};

}  // namespace mercury::window
