// SPDX-License-Identifier: Apache-2.0
// The private state of Physics. physics.h explains which thread owns what.
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

#include "app/live/companion.h"
#include "app/live/pace.h"
#include "app/live/physics.h"
#include "app/live/population.h"
#include "app/live/replay_log.h"
#include "app/live/snapshot_pool.h"
#include "app/live/timeline.h"

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
  using Loop = std::optional<std::pair<double, double>>;
  std::optional<Scene> scene;
  std::optional<ViewSettings> view;
  std::optional<std::vector<LivePerturbation>> perturbations;
  std::optional<std::shared_ptr<PositionBridge>> bridge;
  std::optional<bool> playing, pause_on_explosion;
  std::optional<double> speed, seek, seek_first;  // seek_first: before go_on
  std::optional<Loop> loop;
  std::optional<std::optional<SideDifference>> difference;
  std::optional<std::vector<LiveRobot>> ghosts;
  std::optional<std::size_t> timeline_budget;
  std::int64_t steps = 0, steps_back = 0;
  bool drop_steps = false, reset = false, go_on = false, quit = false;
  std::uint64_t ticket = 0;  // of the latest wait_until_done(), 0 = none

  bool any() const {
    return scene || view || perturbations || bridge || playing || pause_on_explosion || speed || seek || seek_first ||
           loop || difference || ghosts || timeline_budget || steps > 0 || steps_back > 0 || reset || go_on || quit ||
           ticket > 0;
  }
  // Forgets the moments that were asked for.
  void drop_timeline() {
    seek.reset();
    seek_first.reset();
    steps_back = 0;
    go_on = false;
  }
};

struct Physics::Parts {
  Parts(const Configuration& configuration, Messages& all)
      : messages(all), simulation(configuration), population(simulation), device(simulation.device_name()),
        cuda_device(simulation.cuda_device()) {}

  // Shared by both threads under the mutex.
  std::mutex mutex;
  std::condition_variable wake, done;  // for the physics thread; for wait_until_done()
  PendingCommands pending;
  std::shared_ptr<const Snapshot> snapshot;
  std::vector<Explosion> explosions;
  std::map<RobotId, std::function<Repro()>> repros;  // of robots that exploded
  bool snapshot_wanted = true;                       // newest() was called after the last snapshot
  std::uint64_t tickets = 0, tickets_done = 0;       // calls of wait_until_done() begun and served

  // Safe to use from any thread.
  Messages& messages;
  Measurements measurements, second_measurements, ghost_measurements;
  std::atomic<bool> velocities_wanted = false;

  // Owned by the physics thread.
  Simulation simulation;
  Population population;
  const std::string device;
  const int cuda_device;
  std::shared_ptr<PositionBridge> bridge;  // null = positions are read to the host
  SnapshotPool pool;
  ViewSettings view;
  std::optional<DetailObserver> details;
  std::vector<LivePerturbation> perturbations;
  std::vector<Telemetry> telemetry;
  std::set<RobotId> exploded;
  SceneEvents events;
  ReplayLog replay_log{events};
  std::uint64_t surroundings = 0;               // of the scene
  std::shared_ptr<const Repro> replayed_repro;  // or nothing
  std::size_t next_change = 0;                  // index in replayed_repro->changes
  Timeline timeline;
  bool viewing = false;                         // shows an earlier moment of the timeline, or a recording
  std::optional<std::int64_t> seek_target;      // the step on the way to which the robots are
  bool seek_is_near = false;                    // its last keyframe is kept, or not worth it
  std::uint64_t next_event = 0, era = 0;        // of the moment that is shown
  std::int64_t head_step = 0;                   // of the present, while `viewing`
  std::uint64_t head_era = 0;                   // the same
  PendingCommands::Loop loop;                   // [s]
  double work = 0, keyframe_work = 0;           // wall time of all steps, and of those before the last keyframe [s]
  double keyframe_seconds = 0;                  // wall time of making the last keyframe [s]
  std::shared_ptr<TrajectoryReader> recording;  // that is played, or nothing
  double recording_time = 0;                    // its moment that is shown [s]
  std::optional<SideDifference> difference;     // of the second side, or nothing
  std::vector<LiveRobot> ghost_list;            // each has the id of its robot
  std::unique_ptr<Companion> second, ghosts;    // null = not wanted, or a recording is played
  std::uint64_t companion_count = 0;            // made so far
  std::set<std::string> reported_notes;
  Pace pace;
  SpeedGauge gauge;
  bool playing = false, stop_at_explosion = false;
  double speed = 1;
  double step_seconds = 0;                             // wall time of a step, a running mean; 0 = unknown [s]
  double published_at = 0, gathering_seconds = 0;      // end and duration of the last publish_snapshot() [s]
  double stepping_seconds = 0, measuring_seconds = 0;  // since the last limit_measuring() [s]
  std::int64_t steps_left = 0;                         // of step()
  std::uint64_t ticket = 0;                            // the latest one taken
  std::uint64_t resets = 0, stops = 0, failed_seconds = 0, failed_ghosts = 0;
  bool dirty = true;        // something changed after the last snapshot
  bool is_watched = false;  // a snapshot was wanted when commands were last taken
  std::thread thread;       // last: it starts when all other members exist

  // The time of a scene without robots stands still.
  bool is_running() const { return playing && simulation.size() > 0; }
  void run();
  bool wait_for_commands(PendingCommands& taken);
  void carry_out(PendingCommands& taken);
  bool guarded(auto work);
  bool set_scene(const PendingCommands::Scene& scene);
  void enter_surroundings(std::uint64_t next, bool to_land);
  void start_over();
  void restart();
  void begin_replay();
  void apply_repro_changes();
  std::int64_t next_change_step() const;
  void prepare_changes(const PendingCommands& taken);
  void carry_out_seek(const PendingCommands& taken);
  void seek(double time);
  void restart_timeline();
  void clear_timeline();
  void keep_keyframe();
  void keep_due_keyframe();
  void follow_changes(bool robots_changed);
  void begin_seek(std::int64_t step);
  void finish_seek();
  void show_keyframe(const Keyframe& keyframe, bool jumps = true);
  void advance_seek();
  void apply_events();
  std::int64_t next_stop() const;
  void return_to_present();
  void make_present();
  void forget_later();
  bool loop_back();
  void begin_recording(std::shared_ptr<TrajectoryReader> reader);
  void advance_recording();
  void show_recording(double time);
  void leave_recording();
  TimelineState timeline_state() const;
  Leader leader() const;
  CompanionRobots robots_for(const Companion& companion) const;
  void guard_second(const std::function<void()>& attempt);
  void guard_ghosts(const std::function<void()>& attempt);
  void for_companions(const std::function<void(Companion&)>& use);
  void take_comparison(PendingCommands& taken);
  void begin_companions();
  void restart_companions();
  void follow_companions();
  void advance_companions();
  void observe_companions();
  std::int64_t next_sample() const;
  std::int64_t next_beginning() const;
  std::shared_ptr<const BatchState> state_of(const std::unique_ptr<Companion>& companion) const;
  const Keyframe* keyframe_before(std::int64_t step) const;
  void show_companions(const Keyframe& keyframe, bool jumps);
  void forget_later_companions();
  void publish_companions(Snapshot& next, bool with_velocities);
  void observe_details();
  void begin_pace();
  std::int64_t steps_at_once() const;
  void advance();
  void take_steps(std::int64_t count);
  void report_explosions(bool from_steps);
  bool may_publish() const;
  void publish_snapshot();
  void take_positions(SnapshotPositions& positions);
  void limit_measuring();
};

}  // namespace mercury
