// SPDX-License-Identifier: Apache-2.0
#include "app/video/png_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <optional>
#include <string_view>

#include "app/video/picture_file.h"
#include "mercury/error.h"
#include "mercury/file_links.h"

namespace mercury {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view prefix = "frame-", suffix = ".png";

std::size_t worker_count() { return std::max(1u, std::thread::hardware_concurrency()); }

std::string frame_name(std::int64_t number) { return fmt::format("{}{:05}{}", prefix, number, suffix); }

// The number of a picture that frame_name() could have named.
std::optional<std::int64_t> frame_number(const std::string& name) {
  if (name.size() <= prefix.size() + suffix.size() || !name.starts_with(prefix)) return std::nullopt;
  std::int64_t number = -1;
  const char* digits = name.data() + prefix.size();
  if (std::from_chars(digits, name.data() + name.size(), number).ec != std::errc{} || number < 0) return std::nullopt;
  return frame_name(number) == name ? std::optional(number) : std::nullopt;
}

[[noreturn]] void refuse(const std::string& problem) { throw ParameterError("output", problem); }

}  // namespace

PngFolder::PngFolder(const fs::path& folder, bool force, std::string comment)
    : folder_(folder), comment_(std::move(comment)), queue_(worker_count()) {
  std::error_code error;
  made_folder_ = fs::create_directory(folder_, error);
  if (error) refuse("cannot make the folder " + folder.string() + ": " + error.message());
  try {
    open(force);
  } catch (...) {
    if (lock_ >= 0) ::close(lock_);
    throw;
  }
  for (std::size_t i = 0; i < worker_count(); ++i) workers_.emplace_back([this] { work(); });
}

void PngFolder::open(bool force) {
  const std::string name = folder_.string();
  lock_ = ::open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (lock_ < 0 && errno == ENOTDIR) refuse(name + " is a file, not a folder");
  if (lock_ < 0 || ::access(folder_.c_str(), W_OK) != 0)
    refuse("the folder " + name + " cannot be written into: " + std::strerror(errno));
  // Some network drives have no such locks. There, two that begin in the same moment are not noticed.
  if (::flock(lock_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    refuse(name + " is being filled by another process; give another folder");
  std::error_code error;
  for (fs::directory_iterator entry(folder_, error), end; !error && entry != end; entry.increment(error))
    if (entry->is_symlink() && frame_number(entry->path().filename().string())) require_inside(folder_, entry->path());
  if (!force && !fs::is_empty(folder_, error))
    refuse(error ? "the folder " + name + " cannot be read: " + error.message()
                 : name + " is not empty; give a new or empty folder");
}

PngFolder::~PngFolder() {
  queue_.abandon();
  stop();
  if (!finished_) {
    std::error_code ignored;
    for (std::int64_t number = 0; number < written_; ++number) fs::remove(path_of(number), ignored);
    if (made_folder_) fs::remove(folder_, ignored);
  }
  ::close(lock_);
}

fs::path PngFolder::path_of(std::int64_t number) const { return folder_ / frame_name(number); }

void PngFolder::write(const render::Image& frame) {
  queue_.push({written_, frame});
  ++written_;
  rethrow();
}

void PngFolder::finish() {
  queue_.close();
  stop();
  rethrow();
  finished_ = true;
  remove_frames_from(written_);
}

void PngFolder::work() {
  while (const auto frame = queue_.pop()) {
    try {
      write_picture(path_of(frame->number), frame->picture, comment_);
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!error_) error_ = std::current_exception();
      queue_.abandon();
    }
  }
}

void PngFolder::stop() {
  for (std::thread& worker : workers_)
    if (worker.joinable()) worker.join();
}

void PngFolder::rethrow() {
  const std::lock_guard lock(mutex_);
  if (error_) std::rethrow_exception(error_);
}

// What an earlier, longer video has left.
void PngFolder::remove_frames_from(std::int64_t first) const {
  std::error_code error;
  std::vector<fs::path> old;
  for (fs::directory_iterator entry(folder_, error), end; !error && entry != end; entry.increment(error)) {
    const auto number = frame_number(entry->path().filename().string());
    if (number && *number >= first) old.push_back(entry->path());
  }
  for (const fs::path& file : old) fs::remove(file, error);
}

}  // namespace mercury
