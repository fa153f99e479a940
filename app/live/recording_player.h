// SPDX-License-Identifier: Apache-2.0
// Plays what was recorded, on the physics thread: the frames of a recording, and the changes of a repro.
#pragma once

#include <cstdint>
#include <memory>

#include "app/live/live_batch.h"
#include "app/live/stepping.h"
#include "app/recording/repro.h"
#include "app/recording/trajectory_reader.h"

namespace mercury {

// The batch holds the recorded robots and is put into the state of each moment, so that colors, arrows and measures
// work as for live robots. Between two frames positions are interpolated; the steps between them are not computed
// again, since the recording may come from a much faster machine.
class RecordingPlayer {
 public:
  RecordingPlayer(LiveBatch& batch, Stepping& stepping) : batch_(batch), stepping_(stepping) {}

  bool is_open() const { return recording_ != nullptr; }
  void open(std::shared_ptr<TrajectoryReader> recording);  // shows its first frame
  void close() {
    recording_.reset();
    history_.reset();
  }
  // Puts the batch into the frame at or before the moment that is shown, and closes.
  void leave();

  double begin() const { return recording_->time(0); }  // [s]
  double end() const { return recording_->time(recording_->frames() - 1); }
  bool is_at_end() const { return time_ >= end(); }
  void show(double time);
  // Whether the recording has the senses and neurons of a robot; the batch has those of the moment then.
  bool has_brain_of(RobotId robot) const;
  // All of them, or some thousand evenly spread. It is read at the first call for a robot.
  std::shared_ptr<const BrainHistory> history_of(RobotId robot);
  double previous() const;  // the frame before the moment that is shown
  // Shows the next moment that is due, in a loop from `loop_begin` to `loop_end`. Returns whether there is one.
  bool advance(const std::optional<std::pair<double, double>>& loop);

 private:
  LiveBatch& batch_;
  Stepping& stepping_;
  std::shared_ptr<TrajectoryReader> recording_;  // or nothing
  std::shared_ptr<const BrainHistory> history_;  // that was asked for last
  double time_ = 0;                              // the moment that is shown [s]
};

// Repeats a repro: the same start and the same changes at the same steps.
class ReproPlayer {
 public:
  explicit ReproPlayer(LiveBatch& batch) : batch_(batch) {}

  void set(std::shared_ptr<const Repro> repro) { repro_ = std::move(repro); }  // or nothing
  bool is_set() const { return repro_ != nullptr; }
  void begin();  // puts the only robot at the start
  // Applies the changes that are due now. Returns whether there are any.
  bool advance();
  void skip();                     // the changes before this step, which the batch has gone back to
  std::int64_t next_step() const;  // of the next change

 private:
  LiveBatch& batch_;
  std::shared_ptr<const Repro> repro_;
  std::size_t next_ = 0;  // index in repro_->changes
};

}  // namespace mercury
