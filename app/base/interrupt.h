// SPDX-License-Identifier: Apache-2.0
// Ctrl-C, kill and a closed terminal: noted, so that work ends in good order.
#pragma once

#include <filesystem>

namespace mercury {

// From here on SIGINT, SIGTERM and SIGHUP are noted; a second one removes the files of UnfinishedFile and ends the
// program at once. A signal that the program was started to ignore (nohup) stays ignored.
void catch_interrupts();

// Whether the user asked to stop.
bool interrupted();

// A file under a temporary name: removed when the program is made to end before the file is done.
class UnfinishedFile {
 public:
  // `path` in the folder of `target`, named after it and this process; not created here.
  explicit UnfinishedFile(const std::filesystem::path& target);
  ~UnfinishedFile();  // removes the file if it was not kept
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  // Gives it its name, replacing a file of that name. Throws std::filesystem::filesystem_error.
  void keep();

 private:
  std::filesystem::path target_, path_;
  int slot_ = -1;
};

}  // namespace mercury
