// SPDX-License-Identifier: Apache-2.0
// What goes along with the robots for comparison: the second side of the view, which is the same robots under
// another configuration, and ghosts of robots as they were before a change.
//
//   first     ---*------+------+---x----+--->   steps; x: robots, parameters or materials change
//                | copy |      |   | same change
//   companion    *------+------+---x----+--->
//
// A companion begins at a moment of the first batch, in the states that its robots have then. From there on it is
// stepped after each slice of the first batch's steps, on the same thread, so that both always show the same time.
// Before that moment both were one: an earlier moment of the timeline shows copies. The keyframes of later moments hold
// the states of both.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "app/live/live_batch.h"
#include "app/live/timeline.h"
#include "app/scene/side_difference.h"

namespace mercury {

// A batch that goes along with the first one. Its robots have the ids of those that they are compared with.
class Companion {
 public:
  // What it simulates.
  struct Robots {
    std::vector<LiveRobot> robots;
    Configuration configuration;
    std::vector<LivePerturbation> perturbations;
  };

  // Begins at the first batch's current moment. `number`: of the companions so far. Pictures know by it that it is
  // another one.
  Companion(const LiveBatch& first, const Robots& wanted, Measurements& measurements, Messages& messages,
            std::uint64_t number);

  // Begins again, at the first batch's current moment.
  void begin(const Robots& wanted);
  // Follows changes of robots, parameters, materials and perturbations.
  void follow(const Robots& wanted);
  // Steps to the first batch's time, the nearest that its own time step allows.
  void advance();
  // Shows the first batch's moment. `state`: its own one there, or null; `jumps`: the first did not step there.
  void show(const Robots& wanted, const std::shared_ptr<const BatchState>& state, bool jumps);
  // The first batch went back to an earlier moment, which is the present now.
  void forget_later(const Robots& wanted);

  // The step of the first batch at which it began.
  std::int64_t begin_step() const { return begin_step_; }
  LiveBatch& batch() { return batch_; }

 private:
  bool copy(const Robots& wanted);  // returns whether the list of robots changed

  const LiveBatch& first_;
  LiveBatch batch_;
  std::int64_t begin_step_ = 0;
};

// The second side and the ghosts. One that fails, such as for lack of memory, ends with a message; the robots go on.
// Not thread-safe, except that anybody may read the measurements; the physics thread owns it.
class Comparison {
 public:
  Comparison(const LiveBatch& first, Messages& messages) : first_(first), messages_(messages) {}

  // What is wanted: the second side under these settings, or none; these ghosts.
  void set_second(const std::optional<SideDifference>& difference);
  void set_ghosts(std::vector<LiveRobot> ghosts);
  void watch(const ViewSettings& view);  // of the second side
  // Whether begin() has something to do: companions that are wanted and not there begin at the moment that is shown.
  bool must_begin() const;
  void begin();
  void end();  // until the next begin()

  // To be called after the first batch was reset, was changed, was stepped, and went back for good.
  void restart();
  void follow();
  void advance();
  void forget_later();

  // Samples.
  void measure();
  std::int64_t next_measure() const;
  void thin_measures();
  const Measurements& second_measurements() const { return sides_[0].measurements; }
  const Measurements& ghost_measurements() const { return sides_[1].measurements; }

  // Keyframes. states() are null where a companion had not begun before.
  Keyframe::Companions states() const;
  bool can_show(const Keyframe& keyframe) const;  // whether all moments after it can be computed
  void show(const Keyframe& keyframe, bool jumps);
  // The step at which a companion begins, if it is still to come.
  std::int64_t next_beginning() const;

  // Adds them to a snapshot of the first batch.
  void publish(Snapshot& next, bool with_velocities);

 private:
  struct Side {
    const char* name;
    Measurements measurements = Measurements();
    std::unique_ptr<Companion> companion = nullptr;  // null = not wanted, or a recording is played
    std::uint64_t failures = 0;
  };
  bool is_wanted(std::size_t side) const { return side == 0 ? difference_.has_value() : !ghosts_.empty(); }
  Companion::Robots robots_for(std::size_t side) const;
  void attempt(std::size_t side, const std::function<void()>& task);
  void for_each(const std::function<void(std::size_t side, Companion& companion)>& use);

  const LiveBatch& first_;
  Messages& messages_;
  std::array<Side, 2> sides_ = {{{"the second view"}, {"the ghosts"}}};
  std::optional<SideDifference> difference_;  // of the second side
  std::vector<LiveRobot> ghosts_;
  std::optional<ViewSettings> view_;
  std::uint64_t count_ = 0;  // of companions so far
};

}  // namespace mercury
