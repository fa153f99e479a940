// SPDX-License-Identifier: Apache-2.0
// Files of the window: nothing that exists is replaced unasked.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace mercury {

struct SaveResult {
  enum class Outcome { saved, exists, failed } outcome = Outcome::saved;
  std::vector<std::filesystem::path> files;  // saved; or those that exist, in which case nothing was written
  std::string message;                       // if failed: one line
  bool ok() const { return outcome == Outcome::saved; }
};

struct FileToSave {
  std::filesystem::path path;
  std::string content;
};

// Writes all of them, each whole or not at all; nothing if one exists and `overwrite` is not given. Missing folders are
// made.
SaveResult save_files(const std::vector<FileToSave>& files, bool overwrite);

// A name for a file, without what no file's name may have; "robot" if nothing is left.
std::string file_name_of(std::string_view name);

// `wanted`, or the first of wanted-2, wanted-3, ... that does not exist.
std::filesystem::path unused_name(const std::filesystem::path& wanted);

}  // namespace mercury
