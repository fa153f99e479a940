// SPDX-License-Identifier: Apache-2.0
#include "app/window/toolkit/frame_times.h"

#include <algorithm>

namespace mercury::window {
namespace {

constexpr double frame_time = 1.0 / 60;  // minimum, if the display does not limit the frame rate [s]
constexpr double software_frame_time = 1.0 / 30;
constexpr double rare_frame_time = 1.0 / 20;  // while the GPU is left to the steps [s]
constexpr double longest_rest = 0.6;          // of the panels, then [s]
constexpr double frame_share = 0.05;          // of the GPU's time, then
// While input is waiting, frames are left out for this multiple of the time that the last one took.
constexpr double backlog_factor = 4;

}  // namespace

double Pacing::rest() const { return (1 / frame_share - 1) * robots_seconds_ - since(drawn_at_); }

double Pacing::wait(double spent, bool gpu_for_steps) const {
  if (gpu_for_steps) return std::max({0.0, rare_frame_time - spent, std::min(rest(), longest_rest - spent)});
  return paced_ ? std::max(0.0, (software_ ? software_frame_time : frame_time) - spent) : 0;
}

bool Pacing::leaves_out_frame(bool backlog) const {
  return backlog && since(shown_at_) < backlog_factor * frame_seconds_;
}

bool Pacing::keeps_robots(bool gpu_for_steps) const { return gpu_for_steps && rest() > 0; }

void Pacing::showed_frame(double seconds, bool robots) {
  shown_at_ = Clock::now();
  frame_seconds_ = seconds;
  if (!robots) return;
  drawn_at_ = shown_at_;
  robots_seconds_ = seconds;
}

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
    mean.drawn += share * times.drawn;
    mean.mouse += share * times.mouse;
    mean.panels += share * times.panels;
    mean.thumbnails += share * times.thumbnails;
    mean.waiting += share * times.waiting;
    mean.present += share * times.present;
  }
  return mean;
}

}  // namespace mercury::window
