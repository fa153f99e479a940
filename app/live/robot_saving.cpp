// SPDX-License-Identifier: Apache-2.0
#include "app/live/robot_saving.h"

#include <exception>
#include <system_error>

#include "mercury/error.h"
#include "robots/file/whole_file.h"

namespace mercury {
namespace {

namespace fs = std::filesystem;

}  // namespace

SaveResult save_files(const std::vector<FileToSave>& files, bool overwrite) {
  SaveResult result;
  try {
    for (const FileToSave& file : files) {
      if (file.path.filename().empty()) return not_saved("give a file name");
      if (fs::is_directory(file.path)) return not_saved(file.path.string() + " is a folder");
      if (!overwrite && fs::exists(fs::symlink_status(file.path))) result.files.push_back(file.path);
    }
    if (!result.files.empty()) {
      result.outcome = SaveResult::Outcome::exists;
      return result;
    }
    for (const FileToSave& file : files) {
      if (file.path.has_parent_path()) fs::create_directories(file.path.parent_path());
      write_whole_file(file.path, file.content);
      result.files.push_back(file.path);
    }
  } catch (const fs::filesystem_error& error) {
    return not_saved(error.path1().string() + ": " + reason_of(error.code().value()));
  } catch (const std::exception& error) {
    return not_saved(error.what());
  }
  return result;
}

fs::path unused_name(const fs::path& wanted) {
  std::error_code ignored;
  fs::path name = wanted;
  for (int number = 2; fs::exists(name, ignored); ++number)
    name = wanted.parent_path() / (wanted.stem().string() + "-" + std::to_string(number) + wanted.extension().string());
  return name;
}

}  // namespace mercury
