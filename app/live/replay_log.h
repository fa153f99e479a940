// SPDX-License-Identifier: Apache-2.0
// What happened to each robot of late, so that its explosion can be made to happen again.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/live/snapshot.h"
#include "app/recording/repro.h"

namespace mercury {

// Keeps two states a robot from which it can be started again, the older one some seconds of stepping ago, and all that
// was changed since. Nothing is ever left out: where states would take too much memory, the robot's first one stays.
class ReplayLog {
 public:
  // Time began anew.
  void restart();
  // After parameters, robots, their materials or pulls may have changed, and before the next step.
  void follow(const Simulation& simulation, const LiveRobots& robots,
              const std::vector<LivePerturbation>& perturbations);
  // So long was stepped since the last call [s of wall time]; no robot has exploded without repro() being asked.
  void stepped(double seconds, const Simulation& simulation, const LiveRobots& robots);
  // Of a robot that has just exploded, at that place of both; nothing if it is not known. To be put together later, on
  // whatever thread: a thousand may explode at once, and few are ever asked for.
  std::function<Repro()> repro(const Simulation& simulation, const LiveRobots& robots, std::size_t index,
                               const Telemetry& telemetry);

 private:
  using Materials = std::shared_ptr<const std::vector<Material>>;
  struct Start {
    Clock clock;
    Configuration configuration;
    Materials materials;
    State state;
    std::vector<LivePerturbation> perturbations;
    std::uint64_t next = 0;  // number of the first event after it
  };
  struct Track {
    std::shared_ptr<const Robot> robot;
    Materials materials;
    std::shared_ptr<const Start> older, newer;
  };
  struct Event {
    std::int64_t step = 0;
    std::optional<Configuration> configuration;
    std::optional<std::pair<RobotId, Materials>> materials;
    std::optional<std::vector<LivePerturbation>> perturbations;
  };
  static constexpr double period = 5;                    // of stepping between two states [s]
  static constexpr std::size_t most_masses = 2'000'000;  // of all robots, for new states to be kept

  // What became of a robot, by itself.
  struct Record {
    LiveRobot robot;
    std::shared_ptr<const Start> start;
    std::shared_ptr<const std::vector<Event>> events;
    std::size_t first_event;  // of those, after the start
    Telemetry telemetry;
    std::int64_t last_step;
    std::string device_name;
    Repro repro() const;
  };
  void add(Event event);
  std::shared_ptr<const Start> start(const Simulation& simulation, std::size_t index, const Materials& materials) const;
  void forget_events();

  std::map<RobotId, Track> tracks_;
  std::vector<Event> events_;
  std::uint64_t first_event_ = 0;  // number of events_[0]
  std::uint64_t sealed_ = 0;       // events before this number may not change: a start lies after them
  Configuration configuration_;
  std::vector<LivePerturbation> perturbations_;
  std::shared_ptr<const std::vector<Event>> copied_;  // of all events, as long as they stay as they are
  double since_ = 0;                                  // of stepping since the last states [s]
};

}  // namespace mercury
