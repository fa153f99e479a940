// SPDX-License-Identifier: Apache-2.0
#include "app/video/video_stages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <optional>
#include <thread>

#include "app/base/bounded_queue.h"
#include "app/base/progress.h"
#include "app/base/stepping.h"
#include "app/video/moment_sampler.h"
#include "mercury/error.h"
#include "mercury/stopwatch.h"

namespace mercury {
namespace {

using Moment = std::vector<FrameSnapshot>;  // one per side

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
    const double start = wall_now();
    std::exception_ptr failure_of_simulation, failure_of_drawing;
    std::thread simulating([&] { guard(failure_of_simulation, [this] { simulate(); }); });
    guard(failure_of_drawing, [this] { draw(); });
    snapshots_.abandon();
    simulating.join();
    for (const std::exception_ptr& failure : {failure_of_simulation, failure_of_drawing})
      if (failure) std::rethrow_exception(failure);
    encoder_.finish();
    return {.frames = encoder_.frames(), .interrupted = interrupted_, .wall_seconds = wall_now() - start};
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

  // One of the sides.
  struct Sampling {
    Stepper stepper;
    MomentSampler sampler;
    std::int64_t first;  // step
    double dt;
  };

  void simulate() {
    std::vector<Sampling> sides;
    for (const VideoSide& side : parts_.sides) {
      const double dt = side.simulation.configuration().dt;
      sides.push_back({Stepper(side.simulation),
                       MomentSampler(side.simulation, side.drawing, side.bridge, timing_.interval < dt, side.share),
                       side.simulation.steps(), dt});
    }
    for (std::int64_t frame = 0; frame < timing_.frames; ++frame) {
      std::vector<FramePlace> places;
      for (const Sampling& side : sides) {
        places.push_back(place_of_frame(frame, timing_, side.dt));
        places.back().step += side.first;
      }
      // Sides may share a simulation: all of them see a step before it goes on.
      while (!interrupted_ && observe_next(sides, places)) {
      }
      if (interrupted_) break;
      Moment moment;
      for (std::size_t i = 0; i < sides.size(); ++i) moment.push_back(sides[i].sampler.moment(places[i]));
      if (!snapshots_.push(std::move(moment))) return;
    }
    snapshots_.close();
  }

  // Takes the next step that each side needs for its place. Returns false if none does.
  bool observe_next(std::vector<Sampling>& sides, const std::vector<FramePlace>& places) {
    bool any = false;
    for (std::size_t i = 0; i < sides.size() && !interrupted_; ++i) {
      const std::optional<std::int64_t> step = sides[i].sampler.next_step(places[i]);
      if (!step) continue;
      any = true;
      interrupted_ = control_.stop || !sides[i].stepper.advance_to(*step);
      if (!interrupted_) sides[i].sampler.observe(places[i]);
    }
    return any;
  }

  void draw() {
    std::vector<render::Readback> readbacks;
    for (const VideoSide& side : parts_.sides)
      readbacks.emplace_back(parts_.pixels, side.renderer.width(), side.renderer.height());
    if (progress_) progress_->show();  // the first frame takes longest, and none is written before
    while (auto moment = snapshots_.pop()) {
      const render::Camera camera = show(*moment);
      if (readbacks.front().full() && !encoder_.take(readbacks, parts_.combine)) return;
      for (std::size_t i = 0; i < readbacks.size(); ++i) {
        const VideoSide& side = parts_.sides[i];
        side.renderer.draw(side.drawing.scene(), camera);
        readbacks[i].start(side.renderer);
      }
    }
    while (readbacks.front().pending() > 0)
      if (!encoder_.take(readbacks, parts_.combine)) return;
  }

  render::Camera show(Moment& moment) {
    const VideoSide& first = parts_.sides.front();
    std::vector<render::Bounds> boxes;
    for (std::size_t i = 0; i < moment.size(); ++i) {
      const VideoSide& side = parts_.sides[i];
      if (i > 0) side.drawing.share_scale(first.drawing);
      side.drawing.show(moment[i], side.bridge, side.renderer);
      const auto of_side = side.drawing.camera_boxes();
      boxes.insert(boxes.end(), of_side.begin(), of_side.end());
    }
    return first.drawing.camera(boxes, timing_.pace);
  }

  const VideoParts& parts_;
  const VideoTiming& timing_;
  VideoControl& control_;
  std::optional<Progress> progress_;
  BoundedQueue<Moment> snapshots_{waiting_snapshots};
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

FramePlace place_of_frame(std::int64_t frame, const VideoTiming& timing, double dt) {
  return place_after(0, (timing.start + static_cast<double>(frame) * timing.interval) / dt);
}

VideoResult run_video_stages(const VideoParts& parts, const VideoTiming& timing, bool quiet, VideoControl* control) {
  VideoControl unwatched;
  return VideoStages(parts, timing, quiet, control ? *control : unwatched).run();
}

}  // namespace mercury
