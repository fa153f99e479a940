// SPDX-License-Identifier: Apache-2.0
#include "app/live/physics.h"

#include <algorithm>
#include <utility>

#include "app/live/physics_parts.h"

namespace mercury {

Physics::Physics(const Configuration& configuration, Messages& messages)
    : parts_(std::make_unique<Parts>(configuration, messages)) {
  parts_->publish_snapshot();
  parts_->thread = std::thread([parts = parts_.get()] { parts->run(); });
}

Physics::~Physics() {
  {
    const std::lock_guard lock(parts_->mutex);
    parts_->pending.quit = true;
    parts_->wake.notify_all();
  }
  parts_->thread.join();
}

namespace {

// Changes the pending commands and wakes the physics thread.
template <class Change>
void request(auto& parts, Change change) {
  const std::lock_guard lock(parts.mutex);
  change(parts.pending);
  parts.wake.notify_all();
}

}  // namespace

void Physics::set_scene(std::vector<LiveRobot> robots, const Configuration& configuration, std::uint64_t surroundings) {
  request(*parts_, [&](PendingCommands& pending) {
    pending.scene = {std::move(robots), configuration, nullptr, nullptr, surroundings};
  });
}
void Physics::set_repro(const LiveRobot& robot, const Configuration& configuration,
                        std::shared_ptr<const Repro> repro) {
  request(*parts_, [&](PendingCommands& pending) {
    pending.scene = {std::vector{robot}, configuration, std::move(repro), nullptr};
    pending.steps = 0;
    pending.drop_timeline();
  });
}
void Physics::set_recording(std::vector<LiveRobot> robots, const Configuration& configuration,
                            std::shared_ptr<TrajectoryReader> recording) {
  request(*parts_, [&](PendingCommands& pending) {
    pending.scene = {std::move(robots), configuration, nullptr, std::move(recording)};
    pending.steps = 0;
    pending.drop_timeline();
  });
}
void Physics::seek(double time) {
  request(*parts_, [&](PendingCommands& pending) {
    pending.seek = time;
    pending.steps_back = 0;
  });
}
void Physics::step_back(std::int64_t count) {
  request(*parts_, [&](PendingCommands& pending) {
    pending.playing = false;
    pending.steps_back += std::max<std::int64_t>(0, count);
  });
}
void Physics::go_on() {
  request(*parts_, [&](PendingCommands& pending) {
    pending.go_on = true;
    if (pending.seek) pending.seek_first = std::exchange(pending.seek, {});
  });
}
void Physics::set_loop(std::optional<std::pair<double, double>> times) {
  request(*parts_, [&](PendingCommands& pending) { pending.loop = times; });
}
void Physics::set_timeline_budget(std::size_t bytes) {
  request(*parts_, [&](PendingCommands& pending) { pending.timeline_budget = bytes; });
}
void Physics::set_view(const ViewSettings& settings) {
  request(*parts_, [&](PendingCommands& pending) { pending.view = settings; });
}
void Physics::set_perturbations(std::vector<LivePerturbation> perturbations) {
  request(*parts_, [&](PendingCommands& pending) { pending.perturbations = std::move(perturbations); });
}
void Physics::set_bridge(std::shared_ptr<PositionBridge> bridge) {
  request(*parts_, [&](PendingCommands& pending) { pending.bridge = std::move(bridge); });
}
int Physics::cuda_device() const { return parts_->cuda_device; }
void Physics::play() {
  request(*parts_, [](PendingCommands& pending) {
    pending.playing = pending.drop_steps = true;
    pending.steps = 0;
  });
}
void Physics::pause() {
  request(*parts_, [](PendingCommands& pending) {
    pending.playing = false;
    pending.drop_steps = true;
    pending.steps = 0;
  });
}
void Physics::set_speed(double speed) {
  if (!(speed > 0)) return;
  request(*parts_, [&](PendingCommands& pending) { pending.speed = speed; });
}
void Physics::step(std::int64_t count) {
  request(*parts_, [&](PendingCommands& pending) {
    pending.playing = false;
    pending.steps += std::max<std::int64_t>(0, count);
  });
}
void Physics::reset() {
  request(*parts_, [](PendingCommands& pending) {
    pending.reset = true;
    pending.steps = 0;
    pending.drop_timeline();
  });
}
void Physics::pause_on_explosion(bool pause) {
  request(*parts_, [&](PendingCommands& pending) { pending.pause_on_explosion = pause; });
}

void Physics::set_second(std::optional<SideDifference> difference) {
  request(*parts_, [&](PendingCommands& pending) { pending.difference = std::move(difference); });
}
void Physics::set_ghosts(std::vector<LiveRobot> ghosts) {
  request(*parts_, [&](PendingCommands& pending) { pending.ghosts = std::move(ghosts); });
}
const Measurements& Physics::second_measurements() const { return parts_->second_measurements; }
const Measurements& Physics::ghost_measurements() const { return parts_->ghost_measurements; }

void Physics::watch_velocities(bool watch) { parts_->velocities_wanted = watch; }

std::shared_ptr<const Snapshot> Physics::newest() {
  const std::lock_guard lock(parts_->mutex);
  parts_->snapshot_wanted = true;
  parts_->wake.notify_all();
  return parts_->snapshot;
}

std::vector<Explosion> Physics::take_explosions() {
  const std::lock_guard lock(parts_->mutex);
  return std::exchange(parts_->explosions, {});
}

std::optional<Repro> Physics::repro(RobotId robot) const {
  std::function<Repro()> repro;
  {
    const std::lock_guard lock(parts_->mutex);
    if (const auto found = parts_->repros.find(robot); found != parts_->repros.end()) repro = found->second;
  }
  return repro ? std::optional(repro()) : std::nullopt;
}

const Measurements& Physics::measurements() const { return parts_->measurements; }
std::string Physics::device_name() const { return parts_->device; }

void Physics::wait_until_done() {
  std::unique_lock lock(parts_->mutex);
  const std::uint64_t ticket = parts_->pending.ticket = ++parts_->tickets;
  parts_->snapshot_wanted = true;
  parts_->wake.notify_all();
  parts_->done.wait(lock, [&] { return parts_->tickets_done >= ticket; });
}

}  // namespace mercury
