// SPDX-License-Identifier: Apache-2.0
#include "app/recording/trajectory_playback.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "mercury/backend.h"
#include "mercury/error.h"

namespace mercury {
namespace {

// Writes recorded states into a CPU backend, which answers all questions about them.
class Playback final : public Backend {
 public:
  Playback(std::shared_ptr<TrajectoryReader> trajectory, std::shared_ptr<const float> share)
      : trajectory_(std::move(trajectory)), robots_(make_cpu_backend({.kind = DeviceKind::cpu})),
        share_(std::move(share)) {}

  std::string device_name() const override { return "recording of " + trajectory_->device_name(); }
  std::vector<std::string> notes() const override { return {}; }
  std::size_t robots_at_once() const override { return robots_->robots_at_once(); }
  double spring_limit() const override { return robots_->spring_limit(); }
  double busy_seconds() const override { return 0; }

  void load(std::span<const Robot* const> robots, const Configuration& configuration) override {
    robots_->load(robots, configuration);
    configuration_ = configuration;
    go_to(0);
  }
  void add(std::span<const Robot* const>, std::size_t) override { refuse_edit(); }
  void keep(std::span<const Robot* const>, std::span<const std::size_t>) override { refuse_edit(); }
  void configure(const Configuration& configuration) override { robots_->configure(configuration); }
  void step(const Clock& clock, std::int64_t steps) override { go_to(clock.step + steps); }

  void read(std::size_t robot, std::span<Vec3> positions, std::span<Vec3> velocities) const override {
    current().read(robot, positions, velocities);
  }
  // A simulation writes the rest state when it restarts.
  void write(std::size_t, std::span<const Vec3>, std::span<const Vec3>) override { go_to(0); }
  void set_status(std::size_t, const RobotStatus&) override {}
  void read_positions(std::span<Vec3> out) const override { current().read_positions(out); }
  void read_velocities(std::span<Vec3> out) const override { current().read_velocities(out); }
  RobotStatus status(std::size_t robot) const override { return current().status(robot); }
  std::vector<RobotStatus> statuses() const override { return current().statuses(); }
  void write_materials(std::span<const Material> tables) override { robots_->write_materials(tables); }
  void write_materials(std::size_t robot, std::span<const Material> table) override {
    robots_->write_materials(robot, table);
  }
  void set_perturbations(std::span<const Perturbation>) override {}
  void report(const Clock& clock, std::span<Telemetry> telemetry, std::span<RobotStatus> statuses) const override {
    current().report(clock, telemetry, statuses);
  }

 private:
  [[noreturn]] static void refuse_edit() {
    throw std::logic_error("the robots of a recording are those that it was made with");
  }

  void go_to(std::int64_t step) {
    step_ = step;
    shown_.reset();
  }

  // Frames are read on demand, not for every step.
  Backend& current() const {
    const float share = share_ ? *share_ : 0;
    if (shown_ != share) show(share);
    shown_ = share;
    return *robots_;
  }

  void show(float share_of_step) const {
    const std::int64_t step = trajectory_->step(0) + step_;
    const auto [frame, share] = place_of(step, share_of_step);
    State now = state(frame);
    if (share > 0) {
      const State next = state(frame + 1);
      interpolate(now.positions, next.positions, share);
      interpolate(now.velocities, next.velocities, share);
    }
    const auto offsets = trajectory_->mass_offsets();
    for (std::size_t i = 0; i + 1 < offsets.size(); ++i) {
      const std::size_t masses = offsets[i + 1] - offsets[i];
      robots_->write(i, std::span(now.positions).subspan(offsets[i], masses),
                     std::span(now.velocities).subspan(offsets[i], masses));
      robots_->set_status(i, status_at(trajectory_->robots()[i], step));
    }
  }

  State state(std::size_t frame) const {
    const auto positions = trajectory_->positions(frame), velocities = trajectory_->velocities(frame);
    return {{positions.begin(), positions.end()}, {velocities.begin(), velocities.end()}};
  }

  // The last frame at or before a moment, and the share of the way to the next one.
  std::pair<std::size_t, float> place_of(std::int64_t step, double share_of_step) const {
    const TrajectoryReader& frames = *trajectory_;
    const double steps = static_cast<double>(step - frames.step(0)) + share_of_step;
    const auto between = [&frames](std::size_t frame, double now, const auto& at) -> std::pair<std::size_t, float> {
      if (!(at(frame) < now) || frame + 1 >= frames.frames()) return {frame, 0.0f};
      return {frame, static_cast<float>((now - at(frame)) / (at(frame + 1) - at(frame)))};
    };
    if (!frames.frame_rate()) {
      const auto step_at = [&](std::size_t frame) { return static_cast<double>(frames.step(frame) - frames.step(0)); };
      return between(frames.frame_of_step(step), steps, step_at);
    }
    const double time = frames.time(0) + steps * frames.configuration().dt;
    return between(frames.frame_at(time), time, [&](std::size_t frame) { return frames.time(frame); });
  }

  RobotStatus status_at(const RecordedRobot& robot, std::int64_t step) const {
    if (!robot.exploded_at) return {};
    const std::int64_t exploded =
        trajectory_->step(0) + std::llround((*robot.exploded_at - trajectory_->time(0)) / configuration_.dt);
    return exploded <= step ? RobotStatus{.exploded_step = exploded - trajectory_->step(0)} : RobotStatus{};
  }

  std::shared_ptr<TrajectoryReader> trajectory_;
  std::unique_ptr<Backend> robots_;
  Configuration configuration_;
  std::shared_ptr<const float> share_;
  std::int64_t step_ = 0;               // since the first frame
  mutable std::optional<float> shown_;  // the share that robots_ are at
};

}  // namespace

Simulation playback(std::shared_ptr<TrajectoryReader> trajectory, std::shared_ptr<const float> share) {
  if (trajectory->frames() == 0) throw InputError(trajectory->path().string(), "holds no frames");
  std::vector<Robot> robots;
  for (const RecordedRobot& recorded : trajectory->robots()) robots.push_back(recorded.robot);
  return Simulation(trajectory->configuration(), robots, std::make_unique<Playback>(trajectory, std::move(share)));
}

}  // namespace mercury
