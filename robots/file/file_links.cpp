// SPDX-License-Identifier: Apache-2.0
#include "mercury/file_links.h"

#include <sys/stat.h>

#include <algorithm>
#include <string>
#include <system_error>

#include "mercury/error.h"

namespace mercury {

namespace fs = std::filesystem;

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

}  // namespace mercury
