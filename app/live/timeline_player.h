// SPDX-License-Identifier: Apache-2.0
// Keeps the past of the robots on the physics thread, shows earlier moments of it, and makes one the present again.
//
// A moment is shown by restoring the keyframe before it and stepping on, with the same changes at the same steps. The
// steps are made in slices like all others, so a new command, such as the next moment of a scrubbing mouse, takes
// effect at once. On the way a keyframe is kept shortly before the moment: stepping back from there is quick.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <utility>

#include "app/live/comparison.h"
#include "app/live/replay_log.h"
#include "app/live/stepping.h"

namespace mercury {

class TimelinePlayer {
 public:
  using Steps = std::function<void(std::int64_t count)>;
  using Loop = std::optional<std::pair<double, double>>;  // [s]
  // `take_steps` makes steps of the batch and of what goes along.
  TimelinePlayer(LiveBatch& batch, Comparison& comparison, Stepping& stepping, Steps take_steps)
      : batch_(batch), comparison_(comparison), stepping_(stepping), take_steps_(std::move(take_steps)) {}

  void set_budget(std::size_t bytes) { timeline_.set_budget(bytes); }
  void set_loop(Loop loop) { loop_ = loop; }
  const Loop& loop() const { return loop_; }

  // The past.
  void clear();                                          // forgets it
  void restart(bool with_keyframe = true);               // the same, and begins at the present
  void forget_states() { replay_log_.forget_states(); }  // the steps before do not lead to the current ones
  // Call it after the robots, their parameters or what acts on them may have changed.
  void follow_changes(bool robots_changed);
  void stepped(double seconds);                     // of wall time, in the present
  std::function<Repro()> repro(std::size_t robot);  // of a robot that has just exploded

  // Earlier moments.
  bool is_viewing() const { return viewing_; }
  bool is_seeking() const { return seek_target_.has_value(); }
  // Whether the robots are those of the present, which are measured.
  bool shows_present_robots() const { return !viewing_ || era_ == head_era_; }
  void seek(double time) { begin_seek(timeline_.step_at(time)); }
  void step_back(std::int64_t count) { begin_seek(seek_target_.value_or(batch_.steps()) - count); }
  void advance_seek();  // a slice of the steps to the moment that is to be shown
  void finish_seek();
  void stop_seeking() { seek_target_.reset(); }
  // Starts the loop again if it is at its end. Returns whether it was.
  bool loop_back();
  // At most that many steps until the end of the loop and the present; at least 1, or 0 at the present.
  std::int64_t limited(std::int64_t steps) const;
  // While an earlier moment is shown: the changes of the past that are due now, and the step of the next one.
  void apply_events();
  std::int64_t next_event_step() const;
  // Steps have been made: ends the view of the past if they led to the present.
  void arrive();
  void return_to_present();
  // The moment that is shown becomes the present. Returns whether it was none before. Without a keyframe for a past
  // that is forgotten next.
  bool make_present(bool with_keyframe = true);

  TimelineState state() const;

 private:
  void keep_keyframe();
  const Keyframe* keyframe_before(std::int64_t step) const;
  void begin_seek(std::int64_t step);
  void show_keyframe(const Keyframe& keyframe, bool jumps = true);

  LiveBatch& batch_;
  Comparison& comparison_;
  Stepping& stepping_;
  Steps take_steps_;
  SceneEvents events_;
  ReplayLog replay_log_{events_};
  Timeline timeline_;
  Loop loop_;
  bool viewing_ = false;                     // an earlier moment
  std::optional<std::int64_t> seek_target_;  // the step on the way to which the robots are
  bool seek_is_near_ = false;                // its last keyframe is kept, or not worth it
  std::uint64_t next_event_ = 0, era_ = 0;   // of the moment that is shown
  std::int64_t head_step_ = 0;               // of the present, while `viewing_`
  std::uint64_t head_era_ = 0;               // the same
  double work_ = 0, keyframe_work_ = 0;      // wall time of all steps, and of those before the last keyframe [s]
  double keyframe_seconds_ = 0;              // wall time of making the last keyframe [s]
};

}  // namespace mercury
