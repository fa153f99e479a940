// SPDX-License-Identifier: Apache-2.0
#include "app/video/video_stages.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <optional>
#include <thread>

#include "app/base/bounded_queue.h"
#include "app/base/progress.h"
#include "app/base/stepping.h"
#include "app/video/frame_encoder.h"
#include "mercury/error.h"

namespace mercury {
namespace {

constexpr std::size_t waiting_snapshots = 4;  // simulated, not yet drawn

class VideoStages {
 public:
  VideoStages(const VideoParts& parts, const VideoTiming& timing, bool quiet, VideoControl& control)
      : parts_(parts), timing_(timing), control_(control),
        progress_(quiet ? std::optional<Progress>()
                        : std::optional<Progress>(std::in_place, "rendering", "frames", timing.frames)),
        encoder_(parts.writer, [this](std::int64_t written) {
          control_.frames = written;
          if (progress_) progress_->update(written);
        }) {}

  VideoResult run() {
    const auto start = std::chrono::steady_clock::now();
    std::exception_ptr failure_of_simulation, failure_of_drawing;
    std::thread simulating([&] { guard(failure_of_simulation, [this] { simulate(); }); });
    guard(failure_of_drawing, [this] { draw(); });
    snapshots_.abandon();
    simulating.join();
    for (const std::exception_ptr& failure : {failure_of_simulation, failure_of_drawing})
      if (failure) std::rethrow_exception(failure);
    encoder_.finish();
    return {.frames = encoder_.frames(),
            .interrupted = interrupted_,
            .wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()};
  }

 private:
  // Runs a stage; if it throws, ends the others.
  template <class Stage>
  void guard(std::exception_ptr& failure, Stage stage) {
    try {
      stage();
    } catch (...) {
      failure = std::current_exception();
      snapshots_.abandon();
      encoder_.abandon();
    }
  }

  void simulate() {
    Stepper stepper(parts_.simulation);
    const std::int64_t first = parts_.simulation.steps();
    const double dt = parts_.simulation.configuration().dt;
    for (std::int64_t frame = 0; frame < timing_.frames; ++frame) {
      if (control_.stop || !stepper.advance_to(first + step_of_frame(frame, timing_, dt))) {
        interrupted_ = true;
        break;
      }
      if (!snapshots_.push(parts_.drawing.take(parts_.bridge))) return;
    }
    snapshots_.close();
  }

  void draw() {
    render::Readback readback(parts_.pixels, parts_.renderer.width(), parts_.renderer.height());
    while (auto snapshot = snapshots_.pop()) {
      parts_.drawing.draw(*snapshot, parts_.bridge, parts_.renderer, timing_.pace);
      if (readback.full() && !encoder_.take(readback)) return;
      readback.start(parts_.renderer);
    }
    while (readback.pending() > 0)
      if (!encoder_.take(readback)) return;
  }

  const VideoParts& parts_;
  const VideoTiming& timing_;
  VideoControl& control_;
  std::optional<Progress> progress_;
  BoundedQueue<FrameSnapshot> snapshots_{waiting_snapshots};
  FrameEncoder encoder_;
  bool interrupted_ = false;
};

}  // namespace

VideoTiming video_timing(double seconds, double speed, double frames_per_second) {
  const auto require = [](const char* parameter, double value, bool zero, const char* accepted) {
    if (!(std::isfinite(value) && (zero ? value >= 0 : value > 0)))
      throw ParameterError(parameter, fmt::format("{} is not accepted; give a finite number {}", value, accepted));
  };
  require("seconds", seconds, true, ">= 0 s");
  require("fps", frames_per_second, false, "> 0 frames/s");
  require("speed", speed, false, "> 0");
  const double frames = seconds / speed * frames_per_second;
  if (frames > 1e8) throw ParameterError("seconds", fmt::format("{:.3g} frames are too many for a video", frames));
  return {.frames = std::max<std::int64_t>(1, std::llround(frames)),
          .interval = speed / frames_per_second,
          .pace = 1 / frames_per_second};
}

std::int64_t step_of_frame(std::int64_t frame, const VideoTiming& timing, double dt) {
  return std::llround((timing.start + static_cast<double>(frame) * timing.interval) / dt);
}

VideoResult run_video_stages(const VideoParts& parts, const VideoTiming& timing, bool quiet, VideoControl* control) {
  VideoControl unwatched;
  return VideoStages(parts, timing, quiet, control ? *control : unwatched).run();
}

}  // namespace mercury
