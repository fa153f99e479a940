// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/frame_history.h"

namespace mercury::window {

void FrameHistory::add(const FrameTimes& times) {
  constexpr std::size_t max_frames = 240;
  frames_.push_back(times);
  if (frames_.size() > max_frames) frames_.pop_front();
}

FrameTimes FrameHistory::mean() const {
  FrameTimes mean;
  for (const FrameTimes& times : frames_) {
    const double share = 1.0 / static_cast<double>(frames_.size());
    mean.whole += share * times.whole;
    mean.scene += share * times.scene;
    mean.positions += share * times.positions;
    mean.picture += share * times.picture;
    mean.panels += share * times.panels;
    mean.thumbnails += share * times.thumbnails;
    mean.present += share * times.present;
  }
  return mean;
}

}  // namespace mercury::window
