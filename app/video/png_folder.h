// SPDX-License-Identifier: Apache-2.0
// A folder with a PNG picture per frame.
#pragma once

#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "app/base/bounded_queue.h"
#include "app/video/frame_writer.h"

namespace mercury {

// Writes frame-00000.png, frame-00001.png, ... on all cores. Frames of an earlier, longer video in the same folder are
// removed by finish().
class PngFolder final : public FrameWriter {
 public:
  // Throws InputError if the folder cannot be made or written into.
  explicit PngFolder(const std::filesystem::path& folder);
  ~PngFolder() override;
  void write(const render::Image& frame) override;
  void finish() override;
  std::string description() const override { return "PNG pictures"; }

 private:
  struct Frame {
    std::int64_t number;
    render::Image picture;
  };
  void work();
  void stop();
  void rethrow();
  std::filesystem::path path_of(std::int64_t number) const;
  void remove_frames_from(std::int64_t first) const;

  std::filesystem::path folder_;
  bool made_folder_ = false;
  bool finished_ = false;
  std::int64_t written_ = 0;
  BoundedQueue<Frame> queue_;
  std::mutex mutex_;
  std::exception_ptr error_;  // the first one; guarded by mutex_
  std::vector<std::thread> workers_;
};

}  // namespace mercury
