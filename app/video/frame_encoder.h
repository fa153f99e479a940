// SPDX-License-Identifier: Apache-2.0
// Writes frames on a thread of its own, so that drawing goes on meanwhile.
#pragma once

#include <atomic>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <span>
#include <thread>
#include <vector>

#include "app/base/bounded_queue.h"
#include "app/video/frame_writer.h"
#include "render/readback.h"

namespace mercury {

class FrameEncoder {
 public:
  // Makes one picture of several.
  using Combine = std::function<void(std::span<const render::Image> parts, render::Image& into)>;

  // `on_frame` is called on the encoding thread with the number of frames written so far.
  explicit FrameEncoder(FrameWriter& writer, std::function<void(std::int64_t)> on_frame = {});
  ~FrameEncoder();  // frames that are not written yet are dropped
  FrameEncoder(const FrameEncoder&) = delete;
  FrameEncoder& operator=(const FrameEncoder&) = delete;

  // Passes the oldest frame that is being read back to the encoder. Waits while the encoder is busy. False when it
  // has failed or was abandoned.
  bool take(render::Readback& readback);
  // The same for the parts of a frame.
  bool take(std::span<render::Readback> readbacks, const Combine& combine);
  // Writes all frames that were taken, and ends. Throws what the writer threw. The caller finishes the writer.
  void finish();
  // Drops the frames that are not written yet; take() returns false from now on.
  void abandon();

  std::int64_t frames() const { return frames_; }  // written so far
  // Throws what the writer threw, if anything.
  void rethrow();

 private:
  void encode();

  FrameWriter& writer_;
  std::function<void(std::int64_t)> on_frame_;
  BoundedQueue<render::Image> drawn_;  // not yet written
  std::vector<render::Image> parts_;   // of the frame that is taken
  BoundedQueue<render::Image> spare_;  // written; their memory is used again
  std::atomic<std::int64_t> frames_ = 0;
  std::mutex mutex_;
  std::exception_ptr error_;  // guarded by mutex_
  std::thread thread_;
};

}  // namespace mercury
