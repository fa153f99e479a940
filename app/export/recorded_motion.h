// SPDX-License-Identifier: Apache-2.0
// The motion of one robot of a recording, or a part of it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/export/exported_robot.h"
#include "app/recording/trajectory_reader.h"
#include "render/vector.h"

namespace mercury {

// Throws ParameterError(name, ...) for a moment that the recording does not have, from its first frame [s].
void require_moment(const TrajectoryReader& recording, const char* name, double seconds);

// Which frames of a recording. Times count from its first frame [s].
struct FrameRange {
  std::optional<double> from, to;  // the whole recording if absent
  std::int64_t every = 1;          // takes the first of every N frames
};

class RecordedMotion {
 public:
  // Throws ParameterError("from" | "to" | "every", ...) for a range that the recording does not have, and InputError if
  // it has no frames. A robot that exploded may have positions that are no numbers: the motion ends before them, and
  // problem() says so.
  RecordedMotion(std::shared_ptr<TrajectoryReader> recording, std::size_t robot, const FrameRange& range = {});

  // At the moment of --still, the nearest frame alone. Throws ParameterError("still", ...).
  static RecordedMotion still(std::shared_ptr<TrajectoryReader> recording, std::size_t robot, double seconds);

  ExportedRobot robot() const;
  std::size_t frames() const { return count_; }
  double time(std::size_t frame) const { return recording_->time(recorded_frame(frame)); }  // [s]
  // Frames per second, from the first to the last; 0 for a single frame.
  double frame_rate() const;
  // Valid until the next call. Throws InputError if the recording cannot be read. Velocities take as long to read as
  // positions, and few formats have them.
  Pose pose(std::size_t frame);
  Pose pose_with_velocities(std::size_t frame);
  // Whether it has the senses and neurons of the robot's brain, and those of a frame; nothing if it has not.
  bool has_brain() const { return recording_->has_brains(robot_); }
  std::span<const float> senses(std::size_t frame) { return recording_->senses_of(robot_, recorded_frame(frame)); }
  std::span<const float> neurons(std::size_t frame) { return recording_->neurons_of(robot_, recorded_frame(frame)); }
  const std::string& problem() const { return problem_; }  // empty = none

  // Where the frames are in the file, for formats that refer to it.
  const TrajectoryReader& recording() const { return *recording_; }
  const std::string& group() const { return recording_->robots()[robot_].group; }
  std::size_t recorded_frame(std::size_t frame) const { return first_ + frame * every_; }

 private:
  void end_at_explosion();

  std::shared_ptr<TrajectoryReader> recording_;
  std::size_t robot_, first_ = 0, every_ = 1, count_ = 0;
  std::string problem_;
};

// Where robots stand that are exported together, as pictures lay them out: added to their coordinates [m]. One robot
// stays where it is.
std::vector<render::Vector3> side_by_side(std::span<RecordedMotion> motions);

}  // namespace mercury
