// SPDX-License-Identifier: Apache-2.0
#include "app/video/film.h"

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

constexpr std::size_t waiting_moments = 4;   // simulated, not yet drawn
constexpr std::size_t waiting_pictures = 6;  // drawn, not yet encoded

// The group at one moment, ready to be drawn.
struct Moment {
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

class Production {
 public:
  Production(const FilmSet& set, const FilmTiming& timing, bool quiet, FilmControl& control)
      : set_(set), timing_(timing), quiet_(quiet), control_(control) {}

  FilmResult run() {
    const auto start = std::chrono::steady_clock::now();
    std::thread simulating([this] { guarded([this] { simulate(); }); });
    std::thread encoding([this] { guarded([this] { encode(); }); });
    guarded([this] { draw(); });
    pictures_.close();
    moments_.abandon();
    simulating.join();
    encoding.join();
    error_.rethrow();
    result_.interrupted = interrupted_;
    result_.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result_;
  }

 private:
  // Where one stage fails, the others stop.
  template <class Stage>
  void guarded(Stage stage) {
    try {
      stage();
    } catch (...) {
      error_.keep(std::current_exception());
      moments_.abandon();
      pictures_.abandon();
      spare_.abandon();
    }
  }

  void simulate() {
    Stepper stepper(set_.simulation);
    const std::int64_t first = set_.simulation.steps();
    const double dt = set_.simulation.configuration().dt;
    for (std::int64_t frame = 0; frame < timing_.frames; ++frame) {
      if (control_.stop || !stepper.advance_to(first + step_of_frame(frame, timing_, dt))) {
        interrupted_ = true;
        break;
      }
      std::vector<Telemetry> telemetry = set_.simulation.telemetry();
      SceneDetails details = set_.details.observe(telemetry);
      if (!moments_.push(
              {set_.simulation.time(), set_.bridge.take(set_.simulation), std::move(telemetry), std::move(details)}))
        return;
    }
    moments_.close();
  }

  void draw() {
    render::Readback readback(set_.pixels, set_.renderer.width(), set_.renderer.height());
    for (std::size_t i = 0; i < waiting_pictures + 2; ++i) spare_.push({});
    while (auto moment = moments_.pop()) {
      set_.scene.update(moment->time, moment->telemetry, std::move(moment->details));
      set_.bridge.show(*moment->positions, set_.renderer, set_.scene.scene());
      const render::Camera camera = set_.camera.at(set_.scene.bounds(), timing_.pace);
      set_.renderer.draw(set_.scene.scene(), camera);
      if (readback.full() && !hand_on(readback)) return;
      readback.start(set_.renderer);
    }
    while (readback.pending() > 0)
      if (!hand_on(readback)) return;
  }

  // The oldest picture under way to the encoder. False when that has failed.
  bool hand_on(render::Readback& readback) {
    std::optional<render::Image> picture = spare_.pop();
    if (!picture) return false;
    readback.finish(*picture);
    return pictures_.push(std::move(*picture));
  }

  void encode() {
    Progress progress("rendering", "frames", timing_.frames, quiet_);
    while (auto picture = pictures_.pop()) {
      set_.writer.write(*picture);
      progress.update(control_.frames = ++result_.frames);
      spare_.push(std::move(*picture));
    }
  }

  const FilmSet& set_;
  const FilmTiming& timing_;
  const bool quiet_;
  FilmControl& control_;
  BoundedQueue<Moment> moments_{waiting_moments};
  BoundedQueue<render::Image> pictures_{waiting_pictures};
  BoundedQueue<render::Image> spare_{waiting_pictures + 2};  // pictures whose memory is free to be used again
  FirstError error_;
  FilmResult result_;
  bool interrupted_ = false;
};

}  // namespace

std::int64_t step_of_frame(std::int64_t frame, const FilmTiming& timing, double dt) {
  return std::llround((timing.start + static_cast<double>(frame) * timing.interval) / dt);
}

FilmResult film(const FilmSet& set, const FilmTiming& timing, bool quiet, FilmControl* control) {
  FilmControl unwatched;
  return Production(set, timing, quiet, control ? *control : unwatched).run();
}

}  // namespace mercury
