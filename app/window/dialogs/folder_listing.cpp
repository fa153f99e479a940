// SPDX-License-Identifier: Apache-2.0
#include "app/window/dialogs/folder_listing.h"

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cstdlib>
#include <utility>

#include "mercury/robot_file.h"

namespace mercury::window {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_entries = 20'000;  // per folder

std::string lower(std::string text) {
  for (char& letter : text) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  return text;
}

std::time_t time_of(fs::file_time_type time) {
  const auto system = std::chrono::file_clock::to_sys(time);
  return std::chrono::system_clock::to_time_t(
      std::chrono::time_point_cast<std::chrono::system_clock::duration>(system));
}

FolderItem item_of(const fs::directory_entry& entry) {
  std::error_code unknown;
  FolderItem item{.name = entry.path().filename().string(), .folder = entry.is_directory(unknown)};
  if (!item.folder) item.bytes = entry.file_size(unknown);
  if (unknown) item.bytes = 0;
  const fs::file_time_type changed = entry.last_write_time(unknown);
  if (!unknown) item.changed = time_of(changed);
  return item;
}

}  // namespace

fs::path typed_path(const fs::path& folder, std::string text) {
  const std::size_t begin = text.find_first_not_of(' ');
  if (begin == std::string::npos) return {};
  text = text.substr(begin, text.find_last_not_of(' ') - begin + 1);
  if (const char* home = std::getenv("HOME"); home && (text == "~" || text.starts_with("~/")))
    text = home + text.substr(1);
  return (folder / text).lexically_normal();
}

bool FolderListing::enter(const fs::path& folder) {
  std::error_code failure;
  fs::path wanted = fs::absolute(folder.empty() ? fs::path(".") : folder, failure).lexically_normal();
  if (!wanted.has_filename() && wanted.has_parent_path() && wanted != wanted.root_path()) wanted = wanted.parent_path();
  fs::directory_iterator entries(wanted, failure);
  std::vector<FolderItem> found;
  for (; !failure && entries != fs::directory_iterator() && found.size() < max_entries; entries.increment(failure))
    if (!entries->path().filename().string().starts_with(".")) found.push_back(item_of(*entries));
  if (failure) {
    error_ = wanted.string() + ": " + failure.message();
    return false;
  }
  error_.clear();
  folder_ = wanted;
  all_ = std::move(found);
  filter_.clear();
  cursor_.reset();
  update_items();
  return true;
}

bool FolderListing::up() {
  const fs::path left = folder_;
  if (folder_ == folder_.root_path() || !enter(folder_.parent_path())) return false;
  for (std::size_t i = 0; i < shown_.size(); ++i)
    if (shown_[i].name == left.filename().string()) mark(i);
  return true;
}

void FolderListing::set_filter(const std::string& text) {
  if (lower(text) == filter_) return;
  filter_ = lower(text);
  clear_marks();
  update_items();
}

void FolderListing::sort(Order order, bool descending) {
  if (order == order_ && descending == descending_) return;
  order_ = order;
  descending_ = descending;
  update_items();
}

std::size_t FolderListing::file_count() const {
  return static_cast<std::size_t>(
      std::count_if(shown_.begin(), shown_.end(), [](const FolderItem& item) { return !item.folder; }));
}

bool FolderListing::is_shown(const FolderItem& item) const {
  if (!filter_.empty() && lower(item.name).find(filter_) == std::string::npos) return false;
  if (item.folder || extensions_.empty()) return true;
  return std::ranges::find(extensions_, extension_of(item.name)) != extensions_.end();
}

// Fills shown_ from all_ and keeps the marks.
void FolderListing::update_items() {
  const std::vector<FolderItem> before = std::exchange(shown_, {});
  const std::string at = cursor_ ? before[*cursor_].name : "";
  for (const FolderItem& item : all_)
    if (is_shown(item)) shown_.push_back(item);
  const auto first = [&](const FolderItem& a, const FolderItem& b) {
    if (order_ == Order::size && a.bytes != b.bytes) return a.bytes < b.bytes;
    if (order_ == Order::changed && a.changed != b.changed) return a.changed < b.changed;
    const std::string x = lower(a.name), y = lower(b.name);
    return x != y ? x < y : a.name < b.name;
  };
  std::sort(shown_.begin(), shown_.end(), [&](const FolderItem& a, const FolderItem& b) {
    if (a.folder != b.folder) return a.folder;
    return descending_ ? first(b, a) : first(a, b);
  });
  cursor_.reset();
  for (std::size_t i = 0; i < shown_.size(); ++i) {
    for (const FolderItem& item : before)
      if (item.marked && item.name == shown_[i].name) shown_[i].marked = true;
    if (!at.empty() && shown_[i].name == at) cursor_ = i;
  }
}

void FolderListing::mark(std::size_t index) {
  clear_marks();
  toggle(index);
}

void FolderListing::toggle(std::size_t index) {
  if (index >= shown_.size()) return;
  shown_[index].marked = !shown_[index].marked;
  cursor_ = index;
}

void FolderListing::mark_to(std::size_t index) {
  if (index >= shown_.size()) return;
  const std::size_t from = cursor_.value_or(index);
  for (FolderItem& item : shown_) item.marked = false;
  for (std::size_t i = std::min(from, index); i <= std::max(from, index); ++i) shown_[i].marked = true;
  cursor_ = from;
}

void FolderListing::move(int rows) {
  if (shown_.empty()) return;
  const auto last = static_cast<std::ptrdiff_t>(shown_.size()) - 1;
  const std::ptrdiff_t now = cursor_ ? static_cast<std::ptrdiff_t>(*cursor_) + rows : rows > 0 ? rows - 1 : last;
  mark(static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(now, 0, last)));
}

void FolderListing::clear_marks() {
  for (FolderItem& item : shown_) item.marked = false;
  cursor_.reset();
}

std::vector<FolderItem> FolderListing::marked() const {
  std::vector<FolderItem> marked;
  for (const FolderItem& item : shown_)
    if (item.marked) marked.push_back(item);
  return marked;
}

}  // namespace mercury::window
