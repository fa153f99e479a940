// SPDX-License-Identifier: Apache-2.0
// A folder with a PNG picture per frame.
#pragma once

#include <atomic>
#include <exception>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "app/base/bounded_queue.h"
#include "app/video/frame_writer.h"

namespace mercury {

// Writes frame-00000.png, frame-00001.png, ... on all cores, into a folder that is new or empty. With `force` it may
// hold files: pictures of an earlier video are replaced, and finish() removes those that are left of it. Other files
// stay.
//
// One process at a time fills a folder. It holds a lock on the folder itself (flock), which needs no file and ends with
// the process, even with kill -9.
class PngFolder final : public FrameWriter {
 public:
  // Throws InputError if the folder cannot be made or written into, is not empty, or is being filled.
  PngFolder(const std::filesystem::path& folder, bool force, std::string comment = {});
  ~PngFolder() override;
  void write(const render::Image& frame) override;
  void finish() override;
  std::string description() const override { return "PNG pictures"; }

 private:
  struct Frame {
    std::int64_t number;
    render::Image picture;
  };
  void open(bool force);
  void work();
  void stop();
  void rethrow();
  std::filesystem::path path_of(std::int64_t number) const;
  void remove_frames_from(std::int64_t first) const;

  std::filesystem::path folder_;
  const std::string comment_;  // of each picture
  int lock_ = -1;              // the open folder
  bool made_folder_ = false;
  bool finished_ = false;
  std::int64_t written_ = 0;
  BoundedQueue<Frame> queue_;
  std::mutex mutex_;
  std::exception_ptr error_;  // the first one; guarded by mutex_
  std::vector<std::thread> workers_;
};

}  // namespace mercury
