// SPDX-License-Identifier: Apache-2.0
// What the window's thread and the physics thread hand each other (physics.h, Threads): commands one way, snapshots the
// other.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "app/live/replay_log.h"
#include "app/live/snapshot.h"
#include "app/live/timeline_player.h"
#include "app/recording/trajectory_reader.h"
#include "app/scene/side_difference.h"
#include "app/scene/view_settings.h"

namespace mercury {

// Commands that the physics thread has not taken yet, the latest of each kind.
struct PendingCommands {
  struct Scene {
    std::vector<LiveRobot> robots;
    Configuration configuration;
    std::shared_ptr<const Repro> repro;           // to replay, or nothing
    std::shared_ptr<TrajectoryReader> recording;  // to play, or nothing
    std::uint64_t surroundings = 0;
  };
  std::optional<Scene> scene;
  std::optional<TrialStart> start;
  std::optional<ViewSettings> view;
  std::optional<std::vector<LivePerturbation>> perturbations;
  std::optional<std::shared_ptr<PositionBridge>> bridge;
  std::optional<bool> playing, pause_on_explosion;
  std::optional<double> speed, seek, seek_first;  // seek_first: before go_on
  std::optional<TimelinePlayer::Loop> loop;
  std::optional<std::optional<SideDifference>> difference;
  std::optional<std::vector<LiveRobot>> ghosts;
  std::optional<std::size_t> timeline_budget;
  std::optional<RobotId> brain;
  std::int64_t steps = 0, steps_back = 0;
  bool drop_steps = false, reset = false, go_on = false, quit = false;
  std::uint64_t ticket = 0;  // of the latest wait_until_done(), 0 = none

  bool any() const {
    return scene || start || view || perturbations || bridge || playing || pause_on_explosion || speed || seek ||
           seek_first || loop || difference || ghosts || timeline_budget || brain || steps > 0 || steps_back > 0 ||
           reset || go_on || quit || ticket > 0;
  }
  // Forgets the moments that were asked for.
  void drop_timeline() {
    seek.reset();
    seek_first.reset();
    steps_back = 0;
    go_on = false;
  }
};

// What both threads share, under one mutex.
class Exchange {
 public:
  // The window's side: changes the pending commands and wakes the physics thread.
  template <class Change>
  void request(Change change) {
    const std::lock_guard lock(mutex_);
    change(pending_);
    wake_.notify_all();
  }
  // The same, for a command that replaces the pending one of its kind.
  template <class Command>
  void set(std::optional<Command> PendingCommands::*kind, std::type_identity_t<Command> command) {
    request([&](PendingCommands& pending) { pending.*kind = std::move(command); });
  }
  std::shared_ptr<const Snapshot> newest() {
    const std::lock_guard lock(mutex_);
    wanted_ = true;
    wake_.notify_all();
    return snapshot_;
  }
  void wait_until_done() {
    std::unique_lock lock(mutex_);
    const std::uint64_t ticket = pending_.ticket = ++tickets_;
    wanted_ = true;
    wake_.notify_all();
    done_.wait(lock, [&] { return served_ >= ticket; });
  }

  // The physics thread's side. Takes the commands that are there. If it is `idle`, waits for them or until `due` (wall
  // time [s]; infinity = for ever), and wakes up for a snapshot: if there is an `unpublished` state, or if
  // `wakes_for_snapshot` and none was wanted so far.
  struct Waiting {
    bool idle = false, unpublished = false, wakes_for_snapshot = false;
    double due = 0;
  };
  PendingCommands take(const Waiting& waiting) {
    std::unique_lock lock(mutex_);
    const auto ready = [&] {
      return pending_.any() || (waiting.unpublished && (wanted_ || taken_ > served_)) ||
             (waiting.wakes_for_snapshot && wanted_);
    };
    if (waiting.idle && !ready()) {
      served_ = taken_;
      done_.notify_all();
      if (std::isfinite(waiting.due))
        wake_.wait_until(
            lock,
            std::chrono::steady_clock::time_point(std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                std::chrono::duration<double>(waiting.due))),
            ready);
      else
        wake_.wait(lock, ready);
    }
    watched_ = wanted_;
    PendingCommands taken = std::exchange(pending_, {});
    taken_ = std::max(taken_, taken.ticket);
    return taken;
  }
  void publish(std::shared_ptr<const Snapshot> next) {
    const std::lock_guard lock(mutex_);
    snapshot_ = std::move(next);
    wanted_ = false;
  }
  bool is_wanted() const {  // a snapshot
    const std::lock_guard lock(mutex_);
    return wanted_ || is_awaited();
  }
  bool is_awaited() const { return taken_ > served_; }  // wait_until_done() waits; for the physics thread
  bool was_watched() const { return watched_; }         // a snapshot was wanted at the last take(); the same

 private:
  mutable std::mutex mutex_;
  std::condition_variable wake_, done_;  // for the physics thread; for wait_until_done()
  PendingCommands pending_;
  std::shared_ptr<const Snapshot> snapshot_;
  bool wanted_ = true;                      // newest() was called after the last snapshot
  std::uint64_t tickets_ = 0, served_ = 0;  // calls of wait_until_done() begun and served
  std::uint64_t taken_ = 0;                 // the latest one that the physics thread has taken
  bool watched_ = false;
};

}  // namespace mercury
