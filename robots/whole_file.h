// SPDX-License-Identifier: Apache-2.0
// Files read and written whole.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace mercury {

// The content of a file. Throws InputError("eel.json: No such file or directory") for a file that cannot be read or is
// not a regular file.
std::string read_whole_file(const std::filesystem::path& path);

// Writes under a temporary name in the same folder, then renames, so readers find the whole old file or the whole new
// one. Follows links. Writes directly to what is no file, such as a device or a pipe. On failure (a missing folder, no
// permission, a full disk) throws InputError with the path and the system's reason, and leaves nothing behind.
void write_whole_file(const std::filesystem::path& path, std::string_view content);

// The same for a file that is written piece by piece. Without finish(), the file stays as it was.
class WholeFile {
 public:
  enum class Sync { yes, no };  // whether finish() waits until the disk has the file, so that it survives a power cut

  explicit WholeFile(const std::filesystem::path& path);
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  void append(std::string_view piece);
  void finish(Sync sync = Sync::yes);

 private:
  void discard();
  [[noreturn]] void fail_with(int error);

  std::filesystem::path path_, target_, temporary_;  // no temporary: it is written directly
  int descriptor_ = -1;
};

}  // namespace mercury
