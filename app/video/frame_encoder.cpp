// SPDX-License-Identifier: Apache-2.0
#include "app/video/frame_encoder.h"

#include <optional>
#include <utility>

#include "app/video/side_by_side.h"

namespace mercury {
namespace {

constexpr std::size_t waiting_pictures = 6;  // drawn, not yet written

}  // namespace

FrameEncoder::FrameEncoder(FrameWriter& writer, std::function<void(std::int64_t)> on_frame)
    : writer_(writer), on_frame_(std::move(on_frame)), pictures_(waiting_pictures), spare_(waiting_pictures + 2) {
  for (std::size_t i = 0; i < waiting_pictures + 2; ++i) spare_.push({});
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

bool FrameEncoder::take(render::Readback& readback) { return take(std::span(&readback, 1)); }

bool FrameEncoder::take(std::span<render::Readback> readbacks) {
  std::optional<render::Image> picture = spare_.pop();
  if (!picture) return false;
  if (readbacks.size() == 1) {
    readbacks.front().finish(*picture);
  } else {
    parts_.resize(readbacks.size());
    for (std::size_t i = 0; i < readbacks.size(); ++i) readbacks[i].finish(parts_[i]);
    join(parts_, *picture);
  }
  return pictures_.push(std::move(*picture));
}

void FrameEncoder::finish() {
  pictures_.close();
  if (thread_.joinable()) thread_.join();
  rethrow();
}

void FrameEncoder::abandon() {
  pictures_.abandon();
  spare_.abandon();
}

void FrameEncoder::rethrow() {
  const std::lock_guard lock(mutex_);
  if (error_) std::rethrow_exception(error_);
}

void FrameEncoder::encode() {
  while (auto picture = pictures_.pop()) {
    writer_.write(*picture);
    const std::int64_t written = ++frames_;
    if (on_frame_) on_frame_(written);
    spare_.push(std::move(*picture));
  }
}

}  // namespace mercury
