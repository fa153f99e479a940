// SPDX-License-Identifier: Apache-2.0
// What the user changed while robots were simulated, each with its step: what a repro repeats (replay_log.h), and what
// the timeline applies again between two keyframes (timeline.h).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "app/live/snapshot.h"

namespace mercury {

// A change after `step` steps, before the next one.
struct SceneEvent {
  using Materials = std::shared_ptr<const std::vector<Material>>;
  std::int64_t step = 0;
  std::optional<Configuration> configuration;
  std::optional<std::pair<RobotId, Materials>> materials;  // a robot and its table; null = the robot's own
  std::optional<std::vector<LivePerturbation>> perturbations;
};

// Events have consecutive numbers. Not thread-safe; the physics thread owns it.
class SceneEvents {
 public:
  void clear();
  // A slider or the mouse makes many changes of one kind between two steps. Only the last one counts, unless a state in
  // between needs the others.
  void add(SceneEvent event);
  // A state follows the events so far: they must not change any more.
  void seal() { sealed_ = end(); }
  std::uint64_t begin() const { return first_; }
  std::uint64_t end() const { return first_ + events_.size(); }
  // Null if there is no such event.
  const SceneEvent* find(std::uint64_t number) const {
    return number >= first_ && number < end() ? &events_[number - first_] : nullptr;
  }
  void forget_before(std::uint64_t number);
  void cut(std::uint64_t number);  // forgets this event and all later ones
  // A copy of all events from begin() on, shared by callers until the log changes.
  std::shared_ptr<const std::vector<SceneEvent>> copy();

 private:
  std::vector<SceneEvent> events_;
  std::uint64_t first_ = 0;   // number of events_[0]
  std::uint64_t sealed_ = 0;  // events before this number do not change
  std::shared_ptr<const std::vector<SceneEvent>> copied_;
};

}  // namespace mercury
