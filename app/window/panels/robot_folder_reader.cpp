// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/robot_folder_reader.h"

#include <algorithm>
#include <utility>

#include "mercury/robot_file.h"

namespace mercury::window {

RobotFolderReader::RobotFolderReader(const std::filesystem::path& folder, std::size_t max_files)
    : folder_(folder.lexically_normal()), max_files_(max_files) {
  list();
  thread_ = std::jthread([this](std::stop_token stop) { read(std::move(stop)); });
}

void RobotFolderReader::list() {
  std::error_code failure;
  std::filesystem::directory_iterator entries(folder_, failure);
  if (failure) error_ = failure.message();
  for (; !failure && entries != std::filesystem::directory_iterator(); entries.increment(failure)) {
    const std::filesystem::path& path = entries->path();
    std::error_code unknown;
    if (path.filename().string().starts_with(".")) continue;
    if (entries->is_directory(unknown))
      folders_.push_back(path);
    else if (path.extension() == ".json" || path.extension() == ".cbor")
      files_.push_back(path);
  }
  std::sort(folders_.begin(), folders_.end());
  std::sort(files_.begin(), files_.end());
  if (files_.size() > max_files_) files_.resize(max_files_);
  if (folder_.has_parent_path() && folder_ != folder_.root_path())
    folders_.insert(folders_.begin(), folder_.parent_path());
}

void RobotFolderReader::read(std::stop_token stop) {
  for (const std::filesystem::path& path : files_) {
    if (stop.stop_requested()) return;
    RobotFolderEntry entry{.path = path};
    try {
      auto robot = std::make_shared<Robot>(load_robot(path));
      entry.figures = inspect(*robot);
      entry.robot = std::move(robot);
    } catch (const std::exception& error) {
      entry.error = error.what();
    }
    const std::lock_guard lock(mutex_);
    read_.push_back(std::move(entry));
  }
}

std::vector<RobotFolderEntry> RobotFolderReader::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(read_, {});
}

}  // namespace mercury::window
