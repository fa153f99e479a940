// SPDX-License-Identifier: Apache-2.0
// Writes files for the window. An existing file is replaced only if the user agreed.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/base/file_name.h"

namespace mercury {

struct SaveResult {
  enum class Outcome { saved, exists, failed } outcome = Outcome::saved;
  std::vector<std::filesystem::path> files;  // those saved; or those that exist, and nothing was written
  std::string message;                       // if failed: one line
  bool ok() const { return outcome == Outcome::saved; }
};

struct FileToSave {
  std::filesystem::path path;
  std::string content;
};

inline SaveResult not_saved(const std::string& message) { return {SaveResult::Outcome::failed, {}, message}; }

// Writes all files, each whole or not at all, and makes missing folders. Writes nothing if a file exists and
// `overwrite` is false.
SaveResult save_files(const std::vector<FileToSave>& files, bool overwrite);

// Returns `wanted`, or the first of wanted-2, wanted-3, ... that does not exist.
std::filesystem::path unused_name(const std::filesystem::path& wanted);

}  // namespace mercury
