// SPDX-License-Identifier: Apache-2.0
#include "mercury/file_links.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <mutex>
#include <set>
#include <string>
#include <system_error>
#include <utility>

#include "mercury/error.h"

namespace mercury {

namespace fs = std::filesystem;

namespace {

// Names that were free, without links.
class FreeNames {
 public:
  void note(const fs::path& name, bool is_free) {
    const std::lock_guard lock(mutex_);
    if (is_free)
      names_.insert(name);
    else
      names_.erase(name);
  }
  bool contain(const fs::path& name) {
    const std::lock_guard lock(mutex_);
    return names_.contains(name);
  }

 private:
  std::mutex mutex_;
  std::set<fs::path> names_;
};

FreeNames& free_names() {
  static FreeNames names;
  return names;
}

fs::path end_of(const fs::path& file) {
  std::error_code error;
  const fs::path end = follow_links(file), whole = fs::weakly_canonical(fs::absolute(end, error), error);
  return error ? end : whole;
}

// Returns false if there is a file of that name. Throws std::filesystem::filesystem_error.
bool rename_to_new(const fs::path& from, const fs::path& to) {
  if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return true;
  if (errno == EEXIST) return false;
  // Some file systems cannot rename this way; some of them cannot link, either.
  if (::link(from.c_str(), to.c_str()) == 0) return ::unlink(from.c_str()) == 0;
  if (errno == EEXIST) return false;
  fs::rename(from, to);
  return true;
}

}  // namespace

bool is_device_or_pipe(const fs::path& path) {
  // An open file of some process, such as /dev/stderr: it may be a regular file, which somebody else writes.
  const std::string name = path.string();
  if (name.starts_with("/dev/fd/") || name.starts_with("/dev/std") || name.starts_with("/proc/")) return true;
  struct stat status {};
  return ::stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode);
}

fs::path follow_links(fs::path path) {
  constexpr int longest_chain = 40;  // as the system's own limit
  std::error_code error;
  for (int i = 0; i < longest_chain && fs::is_symlink(path, error); ++i) {
    const fs::path next = fs::read_symlink(path, error);
    if (error) break;
    path = path.parent_path() / next;
  }
  return path;
}

void require_inside(const fs::path& folder, const fs::path& file) {
  std::error_code error;
  const fs::path root = fs::canonical(folder, error);
  const fs::path end = error ? fs::path() : fs::weakly_canonical(fs::absolute(follow_links(file)), error);
  if (error) throw InputError(file.string(), reason_of(error.value()));
  if (std::ranges::mismatch(root, end).in1 != root.end())
    throw InputError(file.string(),
                     "is a link out of " + folder.string() + "; remove the link, or put its file in its place");
}

void note_output(const fs::path& file, bool exists) { free_names().note(end_of(file), !exists); }

bool is_taken(const fs::path& file) {
  const fs::path end = end_of(file);
  std::error_code ignored;
  const bool is_there =
      fs::is_directory(end, ignored) ? !fs::is_empty(end, ignored) : fs::exists(fs::symlink_status(end, ignored));
  return is_there && free_names().contain(end);
}

NameTaken::NameTaken(const fs::path& wanted, fs::path given)
    : std::runtime_error(wanted.string() + " was written by another program in the meantime; this one is " +
                         given.string()),
      name(std::move(given)) {}

fs::path numbered(const fs::path& file, int number) {
  return file.parent_path() / (file.stem().string() + "-" + std::to_string(number) + file.extension().string());
}

void publish(const fs::path& finished, const fs::path& target, bool replaces) {
  const fs::path end = end_of(target);
  if (replaces && !free_names().contain(end)) return fs::rename(finished, target);
  fs::path given = target;
  for (int number = 2; !rename_to_new(finished, given); ++number) given = numbered(target, number);
  if (given != target) throw NameTaken(target, given);
  free_names().note(end, false);
}

}  // namespace mercury
