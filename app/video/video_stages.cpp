// SPDX-License-Identifier: Apache-2.0
#include "app/video/video_stages.h"

#include <chrono>
#include <cmath>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>

#include "app/base/bounded_queue.h"
#include "app/base/progress.h"
#include "app/base/stepping.h"

namespace mercury {
namespace {

constexpr std::size_t waiting_snapshots = 4;  // simulated, not yet drawn
constexpr std::size_t waiting_pictures = 6;   // drawn, not yet encoded

// What one frame shows.
struct FrameSnapshot {
  double time;
  std::unique_ptr<PositionSnapshot> positions;
  std::vector<Telemetry> telemetry;
  SceneDetails details;
};

// The first exception of several threads.
class FirstError {
 public:
  void keep(std::exception_ptr error) {
    const std::lock_guard lock(mutex_);
    if (!error_) error_ = error;
  }
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  std::mutex mutex_;
  std::exception_ptr error_;
};

class VideoStages {
 public:
  VideoStages(const VideoParts& parts, const VideoTiming& timing, bool quiet, VideoControl& control)
      : parts_(parts), timing_(timing), quiet_(quiet), control_(control) {}

  VideoResult run() {
    const auto start = std::chrono::steady_clock::now();
    std::thread simulating([this] { guarded([this] { simulate(); }); });
    std::thread encoding([this] { guarded([this] { encode(); }); });
    guarded([this] { draw(); });
    pictures_.close();
    snapshots_.abandon();
    simulating.join();
    encoding.join();
    error_.rethrow();
    result_.interrupted = interrupted_;
    result_.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result_;
  }

 private:
  // Runs a stage; if it throws, ends the others.
  template <class Stage>
  void guarded(Stage stage) {
    try {
      stage();
    } catch (...) {
      error_.keep(std::current_exception());
      snapshots_.abandon();
      pictures_.abandon();
      spare_.abandon();
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
      std::vector<Telemetry> telemetry = parts_.simulation.telemetry();
      SceneDetails details = parts_.details.observe(telemetry);
      if (!snapshots_.push({parts_.simulation.time(), parts_.bridge.take(parts_.simulation), std::move(telemetry),
                            std::move(details)}))
        return;
    }
    snapshots_.close();
  }

  void draw() {
    render::Readback readback(parts_.pixels, parts_.renderer.width(), parts_.renderer.height());
    for (std::size_t i = 0; i < waiting_pictures + 2; ++i) spare_.push({});
    while (auto snapshot = snapshots_.pop()) {
      parts_.scene.update(snapshot->time, snapshot->telemetry, std::move(snapshot->details));
      parts_.bridge.show(*snapshot->positions, parts_.renderer, parts_.scene.scene());
      const render::Camera camera = parts_.camera.at(parts_.scene.bounds(), timing_.pace);
      parts_.renderer.draw(parts_.scene.scene(), camera);
      if (readback.full() && !pass_on(readback)) return;
      readback.start(parts_.renderer);
    }
    while (readback.pending() > 0)
      if (!pass_on(readback)) return;
  }

  // Passes the oldest picture that is being read back to the encoder. False when the encoder has failed.
  bool pass_on(render::Readback& readback) {
    std::optional<render::Image> picture = spare_.pop();
    if (!picture) return false;
    readback.finish(*picture);
    return pictures_.push(std::move(*picture));
  }

  void encode() {
    Progress progress("rendering", "frames", timing_.frames, quiet_);
    while (auto picture = pictures_.pop()) {
      parts_.writer.write(*picture);
      progress.update(control_.frames = ++result_.frames);
      spare_.push(std::move(*picture));
    }
  }

  const VideoParts& parts_;
  const VideoTiming& timing_;
  const bool quiet_;
  VideoControl& control_;
  BoundedQueue<FrameSnapshot> snapshots_{waiting_snapshots};
  BoundedQueue<render::Image> pictures_{waiting_pictures};
  BoundedQueue<render::Image> spare_{waiting_pictures + 2};  // written; their memory is used again
  FirstError error_;
  VideoResult result_;
  bool interrupted_ = false;
};

}  // namespace

std::int64_t step_of_frame(std::int64_t frame, const VideoTiming& timing, double dt) {
  return std::llround((timing.start + static_cast<double>(frame) * timing.interval) / dt);
}

VideoResult run_video_stages(const VideoParts& parts, const VideoTiming& timing, bool quiet, VideoControl* control) {
  VideoControl unwatched;
  return VideoStages(parts, timing, quiet, control ? *control : unwatched).run();
}

}  // namespace mercury
