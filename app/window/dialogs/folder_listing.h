// SPDX-License-Identifier: Apache-2.0
// A folder as a file dialog shows it: what is in it, filtered and sorted, and what is marked. Knows no window.
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
  std::time_t changed = 0;   // 0 = unknown
  bool marked = false;
};

class FolderListing {
 public:
  enum class Order { name, size, changed };

  // Files with one of these extensions (".json"), in lower or upper case; all of them if none is given. Hidden ones are
  // left out.
  explicit FolderListing(std::vector<std::string> extensions = {}) : extensions_(std::move(extensions)) {}

  // Lists it. False, with error(), where it cannot be read: the one shown before stays.
  bool enter(const std::filesystem::path& folder);
  // The folder above, where there is one; the one left is marked.
  bool up();
  const std::filesystem::path& folder() const { return folder_; }
  const std::string& error() const { return error_; }

  // Only those with this text in their names, in lower or upper case.
  void set_filter(const std::string& text);
  // Folders stay above files.
  void sort(Order order, bool descending);
  const std::vector<FolderItem>& items() const { return shown_; }
  std::size_t file_count() const;  // of those shown

  // Marks one alone; adds or takes it away; marks all from the one marked last.
  void mark(std::size_t index);
  void toggle(std::size_t index);
  void mark_to(std::size_t index);
  // Marks the one so many rows below the one marked last.
  void move(int rows);
  void clear_marks();
  std::optional<std::size_t> cursor() const { return cursor_; }
  std::vector<FolderItem> marked() const;

 private:
  bool is_shown(const FolderItem& item) const;
  void choose();

  std::vector<std::string> extensions_;
  std::filesystem::path folder_;
  std::string error_, filter_;
  Order order_ = Order::name;
  bool descending_ = false;
  std::vector<FolderItem> all_, shown_;
  std::optional<std::size_t> cursor_;
};

// What a user typed in a folder: "~/a.json", "../b", "/c". Blanks at its ends do not count.
std::filesystem::path typed_path(const std::filesystem::path& folder, std::string text);

}  // namespace mercury::window
