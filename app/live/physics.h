// SPDX-License-Identifier: Apache-2.0
// The simulation of the window, on its own thread.
//
// Threads. Two threads share this class. Each object belongs to one of them, or to both under one mutex:
//
//   window thread                          shared, under the mutex              physics thread
//   -------------                          -----------------------              --------------
//   play(), step(), set_scene(), ... --->  PendingCommands  ----------------->  carry_out(): Simulation, Population,
//                                          (latest command of each kind)        ReplayLog, Pace
//                                                                               advance(): a slice of steps
//   newest() <---------------------------  newest Snapshot  <-----------------  publish_snapshot(), if newest() was
//     draws it, holds it as long           "snapshot wanted" flag  ---------->  called since the last one
//     as it likes
//   take_explosions(), repro() <---------  Explosions, repros <---------------  report_explosions()
//
// Background tasks (background.h) never touch PhysicsThread; their results reach it through the window thread.
//
// The timeline (timeline.h) belongs to the physics thread, too: it keeps keyframes while robots play, and computes the
// moments between them again when the window asks for one. A recording is played in the same way, from its file.
//
// A snapshot is written once by the physics thread and is constant from then on, so the window reads it without a lock.
// The last reader, on whatever thread, returns its memory to the SnapshotPool.
//
// Why it is built this way:
// 1. The window never waits for physics. A slice of steps takes several milliseconds, in a large scene much longer, but
//    a click must take effect in the next frame. Only wait_until_done() waits; tests use it.
// 2. Commands replace each other. A slider sends a value per frame; only the latest counts. Commands that must not be
//    lost, such as step(), add up.
// 3. A snapshot is made only after newest() was called. Reading positions from a GPU interrupts the steps, so physics
//    reads them as often as the window draws and no more. At unlimited speed snapshots take at most a
//    twentieth of the time.
// 4. Commands take effect between slices and in a fixed order: scene, view, reset, perturbations, speed, steps. The
//    results depend on the steps and not on how they fall into slices.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/live/measurements.h"
#include "app/live/messages.h"
#include "app/live/replay_log.h"
#include "app/live/snapshot.h"
#include "app/recording/trajectory_reader.h"
#include "app/scene/side_difference.h"
#include "app/scene/view_settings.h"

namespace mercury {

// All members are called from one thread, the window's.
class PhysicsThread {
 public:
  // Throws InputError for an invalid configuration and DeviceError for a missing device. Reports later failures to
  // `messages`.
  explicit PhysicsThread(const Configuration& configuration, Messages& messages);
  ~PhysicsThread();
  PhysicsThread(const PhysicsThread&) = delete;
  PhysicsThread& operator=(const PhysicsThread&) = delete;

  // Replaces the robots and the configuration. The robots must be valid, and the device must be that of the
  // constructor. A robot that is already simulated keeps its state. A robot that was removed and comes back continues
  // from its last state, unless reset() was called in between. A new robot begins at the current time. If the
  // robots cannot be simulated, for example for lack of memory, a message says so and no robot is simulated until the
  // next call.
  // `surroundings` names what the robots live in. With a new number, robots that come to land are set down at rest;
  // with a number that was in use before, clock and robots continue from where they were when it changed.
  void set_scene(std::vector<LiveRobot> robots, const Configuration& configuration, std::uint64_t surroundings = 0);
  // Replays a repro: simulates its robot from its start and applies its changes at their steps. reset() returns to the
  // start. Pending steps are dropped. The next set_scene() ends the replay, and later changes of the repro are not
  // applied. `configuration` is the repro's.
  void set_repro(const LiveRobot& robot, const Configuration& configuration, std::uint64_t surroundings,
                 std::shared_ptr<const Repro> repro);
  // Plays a recording of these robots: its frames, and straight lines between them. reset() returns to its first frame.
  // go_on() ends it, and so does the next set_scene().
  void set_recording(std::vector<LiveRobot> robots, const Configuration& configuration, std::uint64_t surroundings,
                     std::shared_ptr<TrajectoryReader> recording);
  // Where robots begin: new ones, and all after a reset().
  void set_start(const TrialStart& start);
  void set_view(const ViewSettings& settings);  // selects the details that snapshots hold
  // Replaces all perturbations. Those on missing robots or masses are ignored.
  void set_perturbations(std::vector<LivePerturbation> perturbations);
  void play();
  void pause();
  void set_speed(double speed);   // simulated seconds per second, above 0, or unlimited_speed
  void step(std::int64_t count);  // pauses, then makes `count` steps; several calls add up
  void reset();                   // back to time 0 and to where robots begin; drops pending steps
  void pause_on_explosion(bool pause);

  // The timeline. Snapshot::timeline says which moments there are; others become the nearest one. Whatever changes the
  // robots while an earlier moment is shown makes that moment the present first, as go_on() does.
  void seek(double time);              // shows a moment, given in simulated seconds
  void step_back(std::int64_t count);  // pauses, then shows the moment that many steps before; several calls add up
  void go_on();                        // the moment shown is the present from now on; what came after it is forgotten
  void set_loop(std::optional<std::pair<double, double>> times);  // plays from the first time to the second [s]
  void set_timeline_budget(std::size_t bytes);                    // of memory for keyframes

  // The second side: the same robots under other settings, from the moment shown on, or nothing. Snapshot::second is
  // its state at the same time. What changes the robots changes both sides.
  void set_second(std::optional<SideDifference> difference);
  // Ghosts: these bodies in the scene's configuration, from the moment shown on. Each has the id of its robot. It
  // begins in the state of its robot if its masses are joined in the same way, else at rest. Replaces those there were.
  // Snapshot::ghosts is their state.
  void set_ghosts(std::vector<LiveRobot> ghosts);
  const Measurements& second_measurements() const;
  const Measurements& ghost_measurements() const;

  // Snapshots have velocities while physics pauses and after wait_until_done(). With `watch`, those of playing robots
  // have them, too.
  void watch_velocities(bool watch);

  // Snapshots have the activity of this robot's brain, in a recording if it has that; 0 = of none.
  void watch_brain(RobotId robot);

  // Returns the newest snapshot, never null, and requests the next one.
  std::shared_ptr<const Snapshot> newest();
  // Returns the explosions since the last call, and the robots that came back exploded.
  std::vector<Explosion> take_explosions();
  // Returns what it takes to repeat a robot's explosion, or nothing if it has not exploded since the last reset().
  std::optional<Repro> repro(RobotId robot) const;
  const Measurements& measurements() const;
  std::string device_name() const;
  int cuda_device() const;  // of all robots; -1 = none, or several
  // Snapshots leave positions on the GPU, for this bridge. Until then, and if that fails, they are on the host.
  void set_bridge(std::shared_ptr<PositionBridge> bridge);

  // Waits until all commands are carried out, steps included, and newest() shows the result.
  void wait_until_done();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace mercury
