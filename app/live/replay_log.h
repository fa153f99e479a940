// SPDX-License-Identifier: Apache-2.0
// What happened to each robot recently, so that its explosion can be repeated.
//
//   older state        newer state             explosion
//   ----|------------------|-----------------------X---->  time spent in steps
//       | 5 s              | up to 5 s             |
//       '--- events: parameters, materials, perturbations, each with its step ---'
//
// A repro is the older state and the events after it. Two states are kept per robot, so that a repro always covers
// between 5 and 10 seconds of stepping, or everything since the robot was added. A newer state replaces the older one
// every 5 s.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "app/live/snapshot.h"
#include "app/live/timeline.h"
#include "app/recording/repro.h"

namespace mercury {

// Events are never dropped while a state needs them (needed_events()). If new states would take too much memory, each
// robot keeps its first one. Not thread-safe; the physics thread owns it.
class ReplayLog {
 public:
  // Adds its events to the log, which others may read and shorten (needed_events()).
  explicit ReplayLog(SceneEvents& events) : events_(events) {}

  // Forgets everything, the events too: time starts again at 0.
  void restart();
  // The robots were put into states to which the steps so far do not lead. Events stay.
  void forget_states();
  // The robots went back to an earlier moment, and what came later is undone: call it after the events were cut.
  void cut(const Simulation& simulation, const LiveRobots& robots, const std::vector<LivePerturbation>& perturbations);
  // The number of the first event that a repro may need.
  std::uint64_t needed_events() const;
  // Records what changed. Call it after parameters, robots, materials or perturbations may have changed, before the
  // next step.
  void follow(const Simulation& simulation, const LiveRobots& robots,
              const std::vector<LivePerturbation>& perturbations);
  // Call it after steps that took `seconds` of wall time, and after repro() for each robot that exploded in them.
  void stepped(double seconds, const Simulation& simulation, const LiveRobots& robots);
  // Returns a function that makes the repro of a robot that has just exploded; empty if the robot is unknown, or was
  // driven by hand, which a repro cannot repeat. `index`
  // is its index in `simulation` and `robots`. The function may be called later and on any thread: thousands of robots
  // may explode at once, and few of their repros are ever needed.
  std::function<Repro()> repro(const Simulation& simulation, const LiveRobots& robots, std::size_t index,
                               const Telemetry& telemetry);

 private:
  using Materials = SceneEvent::Materials;
  struct Start {
    Clock clock;
    Configuration configuration;
    Materials materials;
    SceneEvent::Held by_hand;
    State state;
    std::vector<LivePerturbation> perturbations;
    std::uint64_t next = 0;  // number of the first event after it
  };
  struct Track {
    std::shared_ptr<const Robot> robot;
    Materials materials;
    SceneEvent::Held by_hand;
    std::shared_ptr<const Start> older, newer;
  };
  static constexpr double period = 5;                    // wall time of steps between two states [s]
  static constexpr std::size_t most_masses = 2'000'000;  // of all robots; above it no new states are kept

  // All that the repro of one robot needs, independent of the log.
  struct Record {
    LiveRobot robot;
    std::shared_ptr<const Start> start;
    std::shared_ptr<const std::vector<SceneEvent>> events;
    std::size_t first_event;  // after the start
    Telemetry telemetry;
    std::int64_t last_step;
    std::string device_name;
    Repro repro() const;
  };
  std::shared_ptr<const Start> start(const Simulation& simulation, std::size_t index, const Track& track) const;

  SceneEvents& events_;
  std::map<RobotId, Track> tracks_;
  Configuration configuration_;
  std::vector<LivePerturbation> perturbations_;
  double since_ = 0;  // wall time of steps since the last states [s]
};

// An explosion that the physics thread has seen.
struct Explosion {
  RobotId robot = 0;
  double time = 0;                           // [s]
  std::uint32_t culprit_spring = no_spring;  // index in Robot::springs
};

// Which robots have exploded, and what it takes to repeat it. The physics thread writes it; any thread may take from
// it.
class ExplosionLog {
 public:
  // Notes robots that are exploded and were not before. `repro_of`: of a robot that exploded in the steps just made, by
  // its index; without it, they came back exploded. Returns whether there are any.
  bool note(const LiveRobots& robots, const std::vector<Telemetry>& telemetry,
            const std::function<std::function<Repro()>(std::size_t)>& repro_of = {});
  void forget_absent(const LiveRobots& robots);  // when one comes back, it is noted again
  void forget_whole(const LiveRobots& robots, const std::vector<Telemetry>& telemetry);  // absent or not exploded now
  void clear();

  std::vector<Explosion> take();  // since the last call
  std::optional<Repro> repro(RobotId robot) const;

 private:
  mutable std::mutex mutex_;
  std::set<RobotId> exploded_;
  std::vector<Explosion> explosions_;
  std::map<RobotId, std::function<Repro()>> repros_;
};

}  // namespace mercury
