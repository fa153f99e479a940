// SPDX-License-Identifier: Apache-2.0
// Reads the robots of a folder on a background thread.
#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "mercury/inspect.h"
#include "mercury/robot.h"

namespace mercury::window {

// A robot file, or the reason why it cannot be used.
struct RobotFolderEntry {
  std::filesystem::path path;
  std::shared_ptr<const Robot> robot;  // null if the file cannot be used
  Inspection figures;
  std::string error;
};

class RobotFolderReader {
 public:
  // Starts to read at max_files `max_files` files. The destructor stops early.
  explicit RobotFolderReader(const std::filesystem::path& folder, std::size_t max_files = 500);

  const std::filesystem::path& folder() const { return folder_; }
  // The parent folder, then the folders inside, sorted by name.
  const std::vector<std::filesystem::path>& folders() const { return folders_; }
  // How many files look like robots.
  std::size_t files() const { return files_.size(); }
  // The robots read since the last call.
  std::vector<RobotFolderEntry> take();
  // Why the folder cannot be read; empty = no error.
  const std::string& error() const { return error_; }

 private:
  void list();
  void read(std::stop_token stop);

  std::filesystem::path folder_;
  std::size_t max_files_;
  std::vector<std::filesystem::path> folders_, files_;
  std::string error_;
  std::mutex mutex_;
  std::vector<RobotFolderEntry> read_;
  std::jthread thread_;
};

}  // namespace mercury::window
