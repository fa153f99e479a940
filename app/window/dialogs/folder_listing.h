// SPDX-License-Identifier: Apache-2.0
// A folder as a file dialog lists it: entries, filter, sort order and marks. Independent of ImGui.
#pragma once

#include <cstdint>
#include <ctime>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace mercury::window {

struct FolderItem {
  std::string name;
  bool folder = false;
  std::uintmax_t bytes = 0;  // of a file
  std::time_t changed = 0;   // last modification; 0 = unknown
  bool marked = false;
};

class FolderListing {
 public:
  enum class Order { name, size, changed };

  // Lists files with one of these extensions (".json") in lower or upper case; all files if none is given. Hidden files
  // are left out.
  explicit FolderListing(std::vector<std::string> extensions = {}) : extensions_(std::move(extensions)) {}

  // Lists a folder. Returns false and sets error() if it cannot be read; the listing then stays as it was.
  bool enter(const std::filesystem::path& folder);
  // Goes to the parent folder, if there is one, and marks the folder that was left.
  bool up();
  const std::filesystem::path& folder() const { return folder_; }
  const std::string& error() const { return error_; }

  // Shows only entries with this text in their names, in lower or upper case.
  void set_filter(const std::string& text);
  // Folders always stand above files.
  void sort(Order order, bool descending);
  const std::vector<FolderItem>& items() const { return shown_; }
  std::size_t file_count() const;  // in items()

  // As click, Ctrl-click and Shift-click do: mark only this item; mark or unmark it; mark all items from the cursor.
  void mark(std::size_t index);
  void toggle(std::size_t index);
  void mark_to(std::size_t index);
  // Moves the cursor down by `rows`, or up if negative, and marks only the item there.
  void move(int rows);
  void clear_marks();
  // The item that was marked last.
  std::optional<std::size_t> cursor() const { return cursor_; }
  std::vector<FolderItem> marked() const;

 private:
  bool is_shown(const FolderItem& item) const;
  void update_items();

  std::vector<std::string> extensions_;
  std::filesystem::path folder_;
  std::string error_, filter_;
  Order order_ = Order::name;
  bool descending_ = false;
  std::vector<FolderItem> all_, shown_;
  std::optional<std::size_t> cursor_;
};

// The path that a user typed in a folder: "~/a.json", "../b", "/c". Leading and trailing spaces are ignored.
std::filesystem::path typed_path(const std::filesystem::path& folder, std::string text);

}  // namespace mercury::window
