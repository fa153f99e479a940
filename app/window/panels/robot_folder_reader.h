// SPDX-License-Identifier: Apache-2.0
// The robots of a folder, read one after the other on a thread of their own.
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

// A robot file, or why it cannot be used.
struct RobotFolderEntry {
  std::filesystem::path path;
  std::shared_ptr<const Robot> robot;  // nothing if it cannot be used
  Inspection figures;
  std::string error;
};

class RobotFolderReader {
 public:
  // Begins to read; the reading ends early when the reader is destroyed. At most `most` files are read.
  explicit RobotFolderReader(const std::filesystem::path& folder, std::size_t most = 500);

  const std::filesystem::path& folder() const { return folder_; }
  // Folders in it, the one above first; by name.
  const std::vector<std::filesystem::path>& folders() const { return folders_; }
  // Files in it that look like robots.
  std::size_t files() const { return files_.size(); }
  // Those read since the last call.
  std::vector<RobotFolderEntry> take();
  // Why the folder itself cannot be read; empty = it can.
  const std::string& error() const { return error_; }

 private:
  void list();
  void read(std::stop_token stop);

  std::filesystem::path folder_;
  std::size_t most_;
  std::vector<std::filesystem::path> folders_, files_;
  std::string error_;
  std::mutex mutex_;
  std::vector<RobotFolderEntry> read_;
  std::jthread thread_;
};

}  // namespace mercury::window
