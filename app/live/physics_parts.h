// SPDX-License-Identifier: Apache-2.0
// What Physics holds: what is asked of its thread, and what that thread works on.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <thread>
#include <utility>

#include "app/live/pace.h"
#include "app/live/physics.h"
#include "app/live/population.h"
#include "app/live/replay_log.h"
#include "app/live/snapshot_pool.h"

namespace mercury {

// What is asked for and not yet carried out.
struct PendingCommands {
  struct Scene {
    std::vector<LiveRobot> robots;
    Configuration configuration;
    std::shared_ptr<const Repro> repro;  // to start from; or nothing
  };
  std::optional<Scene> scene;
  std::optional<ViewSettings> view;
  std::optional<std::vector<LivePerturbation>> perturbations;
  std::optional<bool> playing, pause_on_explosion;
  std::optional<double> speed;
  std::int64_t steps = 0;
  bool drop_steps = false, reset = false, quit = false;
  std::uint64_t ticket = 0;  // of the last who waits until all is done; 0 = nobody

  bool any() const {
    return scene || view || perturbations || playing || pause_on_explosion || speed || steps > 0 || reset || quit ||
           ticket > 0;
  }
};

struct Physics::Parts {
  Parts(const Configuration& configuration, Messages& all)
      : messages(all), simulation(configuration), population(simulation), device(simulation.device_name()) {}

  // Shared by both threads, under the mutex.
  std::mutex mutex;
  std::condition_variable asked, done;
  PendingCommands pending;
  std::shared_ptr<const Snapshot> snapshot;
  std::vector<Explosion> explosions;
  std::map<RobotId, std::function<Repro()>> repros;  // of robots that exploded
  bool looked_at = true;                             // newest() was called since the last snapshot
  std::uint64_t tickets = 0, tickets_done = 0;

  Messages& messages;
  Measurements measurements;

  std::atomic<bool> velocities_wanted = false;

  // The physics thread's own.
  Simulation simulation;
  Population population;
  const std::string device;
  SnapshotPool pool;
  ViewSettings view;
  std::optional<DetailObserver> details;
  std::vector<LivePerturbation> perturbations;
  std::vector<Telemetry> telemetry;
  std::set<RobotId> exploded;
  ReplayLog replay_log;
  std::shared_ptr<const Repro> replayed;  // what is made to happen again; or nothing
  std::size_t next_change = 0;            // of it
  std::set<std::string> told_notes;
  Pace pace;
  SpeedGauge gauge;
  bool playing = false, stop_at_explosion = false;
  double speed = 1, step_seconds = 0;
  double told_at = 0, gathering_seconds = 0;           // end and length of the last tell() [s]
  double stepping_seconds = 0, measuring_seconds = 0;  // since measuring was last weighed [s]
  std::int64_t steps_left = 0;                         // asked for one by one
  std::uint64_t ticket = 0;                            // the last one taken
  std::uint64_t resets = 0, stops = 0;
  bool dirty = true;   // something changed since the last snapshot told
  std::thread thread;  // last: begins when all else is there

  void run();
  bool take_pending(PendingCommands& taken);
  void carry_out(PendingCommands& taken);
  void guarded(auto work);
  bool set_scene(const PendingCommands::Scene& scene);
  void start_over();
  void begin_time();
  void begin_replay();
  void make_changes();
  std::int64_t next_change_step() const;
  void watch();
  void begin_pace();
  void advance();
  void take_steps(std::int64_t count);
  void note_explosions(bool now);
  bool may_tell() const;
  void tell();
  void weigh_measuring();
};

}  // namespace mercury
