// SPDX-License-Identifier: Apache-2.0
// Asks for files or a folder, in the middle of the window.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "app/window/dialogs/folder_listing.h"
#include "app/window/toolkit/event_log.h"
#include "app/window/toolkit/window.h"

namespace mercury::window {

struct FileQuestion {
  // Files that there are; a name for one that there need not be; a folder. A name typed for the latter need not be
  // there.
  enum class Kind { open, save, folder } kind = Kind::open;
  std::string title, button;
  std::vector<std::string> extensions;  // of the files shown; the first is given to a name without one
  std::filesystem::path folder;         // at the beginning; where it is missing, the present one
  std::string name;                     // at the beginning
  std::vector<const char*> formats;     // to choose from; of Kind::save, one an extension
};

struct FileAnswer {
  std::vector<std::filesystem::path> paths;  // one, but for Kind::open
  std::size_t format = 0;
};

class FileDialog {
 public:
  void ask(FileQuestion question, std::function<void(const FileAnswer&)> act);
  // The last question once more, as it was left; nothing if it is forgotten.
  void ask_again() { open_ = fresh_ = act_ != nullptr; }
  void forget() { act_ = nullptr; }

  bool open() const { return open_; }
  void close() { open_ = false; }
  // A key pressed while it is open.
  void press(const Press& press);
  void draw(EventLog& log);

 private:
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

  FileQuestion question_;
  std::function<void(const FileAnswer&)> act_;
  FolderListing view_;
  std::string text_, place_, error_;  // name, folder as they are typed; why nothing came of them
  int text_edition_ = 0;              // counts what was put into the name's field by us
  int format_ = 0;
  bool open_ = false, fresh_ = false, shown_ = false;
  bool focus_ = false, reveal_ = false;          // to come: the name's field is typed into, the marked row is seen
  bool place_active_ = false, entered_ = false;  // the folder's field is typed into; Enter was pressed
  FileAnswer answer_;
  bool answered_ = false;
};

}  // namespace mercury::window
