// SPDX-License-Identifier: Apache-2.0
#include "app/video/frame_encoder.h"

#include <optional>
#include <utility>

namespace mercury {
namespace {

constexpr std::size_t waiting_frames = 6;  // drawn, not yet written

}  // namespace

FrameEncoder::FrameEncoder(FrameWriter& writer, std::function<void(std::int64_t)> on_frame)
    : writer_(writer), on_frame_(std::move(on_frame)), drawn_(waiting_frames), spare_(waiting_frames + 2) {
  for (std::size_t i = 0; i < waiting_frames + 2; ++i) spare_.push({});
  thread_ = std::thread([this] {
    try {
      encode();
    } catch (...) {
      const std::lock_guard lock(mutex_);
      error_ = std::current_exception();
      abandon();
    }
  });
}

FrameEncoder::~FrameEncoder() {
  abandon();
  if (thread_.joinable()) thread_.join();
}

bool FrameEncoder::take(render::Readback& readback) { return take(std::span(&readback, 1), {}); }

bool FrameEncoder::take(std::span<render::Readback> readbacks, const Combine& combine) {
  std::optional<render::Image> frame = spare_.pop();
  if (!frame) return false;
  if (readbacks.size() == 1) {
    readbacks.front().finish(*frame);
  } else {
    parts_.resize(readbacks.size());
    for (std::size_t i = 0; i < readbacks.size(); ++i) readbacks[i].finish(parts_[i]);
    combine(parts_, *frame);
  }
  return drawn_.push(std::move(*frame));
}

void FrameEncoder::finish() {
  drawn_.close();
  if (thread_.joinable()) thread_.join();
  rethrow();
}

void FrameEncoder::abandon() {
  drawn_.abandon();
  spare_.abandon();
}

void FrameEncoder::rethrow() {
  const std::lock_guard lock(mutex_);
  if (error_) std::rethrow_exception(error_);
}

void FrameEncoder::encode() {
  while (auto frame = drawn_.pop()) {
    writer_.write(*frame);
    const std::int64_t written = ++frames_;
    if (on_frame_) on_frame_(written);
    spare_.push(std::move(*frame));
  }
}

}  // namespace mercury
