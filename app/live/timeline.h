// SPDX-License-Identifier: Apache-2.0
// The last minutes of a live run, so that every moment of them can be shown again, to the bit.
//
//   keyframes    K0           K1      K2  K3 head
//   steps     ---|------------|-------|---|--|--->
//   events           ^   ^        ^                 parameters, materials, perturbations
//
// A moment is the keyframe before it, stepped on with the events in between. Keyframes are dense near the head and thin
// out as they grow old: the one goes whose absence costs least against its age. Two neighbors never become so far
// apart that a moment between them takes longer than `most_work` to compute; rather, the oldest goes.
//
// Robots that come and go begin a new era. Between two keyframes of one era the list of robots is the same, and the
// first keyframe of an era is the state right after the change.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "app/live/snapshot.h"

namespace mercury {

struct Keyframe {
  BatchState state;
  Configuration configuration;
  std::shared_ptr<const LiveRobots> robots;
  std::vector<LivePerturbation> perturbations;
  std::uint64_t next_event = 0;  // number of the first event after it
  std::uint64_t era = 0;
  double work = 0;  // wall time that all steps before it took [s]
  // States of the second side and of the ghosts (comparison.h), if they had begun before.
  using Companions = std::array<std::shared_ptr<const BatchState>, 2>;
  Companions companions;

  std::int64_t step() const { return state.clock.step; }
  std::size_t bytes() const;
};

// Not thread-safe; the physics thread owns it.
class Timeline {
 public:
  static constexpr std::size_t usual_budget = std::size_t{512} << 20;  // [bytes]
  static constexpr double most_work = 8;                               // wall time of steps between two keyframes [s]

  void clear();
  // Drops keyframes until they fit.
  void set_budget(std::size_t bytes);
  // Puts a keyframe into its place; one of the same step and era is replaced.
  void add(Keyframe keyframe);
  // Forgets what comes after this step of this era.
  void cut(std::int64_t step, std::uint64_t era);

  bool empty() const { return keyframes_.empty(); }
  std::size_t size() const { return keyframes_.size(); }
  std::size_t bytes() const { return bytes_; }
  std::size_t budget() const { return budget_; }
  const Keyframe& front() const { return keyframes_.front(); }
  // The last keyframe at or before a step; null if there is none. Valid until the next change.
  const Keyframe* before(std::int64_t step) const;
  // The same among those that `usable` accepts.
  const Keyframe* before(std::int64_t step, const std::function<bool(const Keyframe&)>& usable) const;
  // The first keyframe of the next era; null if there is none.
  const Keyframe* next_era(std::uint64_t era) const;

  // The clock of the run from its base on; dt changes at the base.
  void note(const Clock& clock);
  // The step at a time of the run [s], the nearest.
  std::int64_t step_at(double time) const;
  double time_at(std::int64_t step) const;

 private:
  void drop_instant_eras();
  void thin();
  void erase(std::size_t index);

  std::vector<Keyframe> keyframes_;  // by step and era
  std::vector<Clock> clocks_;        // by base_step
  std::size_t bytes_ = 0, budget_ = usual_budget;
};

// What the user changed while robots were simulated, each with its step: what a repro repeats (replay_log.h), and what
// the timeline applies again between two keyframes.
//
// A change after `step` steps, before the next one.
struct SceneEvent {
  using Materials = std::shared_ptr<const std::vector<Material>>;
  using Held = std::shared_ptr<const ByHand>;
  std::int64_t step = 0;
  std::optional<Configuration> configuration;
  std::optional<std::pair<RobotId, Materials>> materials;  // a robot and its table; null = the robot's own
  std::optional<std::pair<RobotId, Held>> by_hand;         // a robot and what is held of it by hand; null = nothing
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
