// SPDX-License-Identifier: Apache-2.0
#include "app/export/recorded_motion.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "app/scene/camera_controller.h"
#include "app/scene/group_layout.h"
#include "mercury/error.h"

namespace mercury {
namespace {

double length_of(const TrajectoryReader& recording) {
  return recording.time(recording.frames() - 1) - recording.time(0);
}

// The frame nearest to a time since the first one.
std::size_t nearest_frame(const TrajectoryReader& recording, double seconds) {
  const double time = recording.time(0) + seconds;
  const std::size_t frame = recording.frame_at(time);
  if (frame + 1 >= recording.frames()) return frame;
  return time - recording.time(frame) <= recording.time(frame + 1) - time ? frame : frame + 1;
}

}  // namespace

void require_moment(const TrajectoryReader& recording, const char* name, double seconds) {
  const double length = length_of(recording);
  // The run may have gone on for less than a frame after the last one.
  const double frame = static_cast<double>(recording.every()) * recording.configuration().dt;
  if (seconds >= 0 && seconds < length + frame) return;
  throw ParameterError(name, fmt::format("{} is not accepted; the recording has 0 to {:.6g} s", seconds, length));
}

RecordedMotion::RecordedMotion(std::shared_ptr<TrajectoryReader> recording, std::size_t robot, const FrameRange& range)
    : recording_(std::move(recording)), robot_(robot) {
  if (recording_->frames() == 0) throw InputError(recording_->path().string(), "holds no frames");
  if (range.every < 1) throw ParameterError("every", fmt::format("{} is not accepted; give 1 or more", range.every));
  std::size_t last = recording_->frames() - 1;
  if (range.from) {
    require_moment(*recording_, "from", *range.from);
    first_ = nearest_frame(*recording_, *range.from);
  }
  if (range.to) {
    require_moment(*recording_, "to", *range.to);
    last = nearest_frame(*recording_, *range.to);
  }
  if (last < first_)
    throw ParameterError("to",
                         fmt::format("{} is before the first moment, {}; give a later one", *range.to, *range.from));
  every_ = static_cast<std::size_t>(std::min<std::int64_t>(range.every, static_cast<std::int64_t>(last) + 1));
  count_ = (last - first_) / every_ + 1;
  end_at_explosion();
}

RecordedMotion RecordedMotion::still(std::shared_ptr<TrajectoryReader> recording, std::size_t robot, double seconds) {
  if (recording->frames() > 0) require_moment(*recording, "still", seconds);
  return RecordedMotion(std::move(recording), robot, {.from = seconds, .to = seconds});
}

// Explosions are not marked in a recording that was not finished.
void RecordedMotion::end_at_explosion() {
  const std::optional<double> exploded_at = recording_->robots()[robot_].exploded_at;
  if (!exploded_at && !recording_->unfinished()) return;
  for (std::size_t frame = 0; frame < count_; ++frame) {
    if (exploded_at && time(frame) < *exploded_at) continue;
    if (is_finite(pose(frame).positions)) continue;
    if (frame == 0)
      throw InputError(
          recording_->path().string(),
          fmt::format("{} has exploded: its positions at {:.6g} s are no numbers", robot().robot.name, time(0)));
    problem_ = fmt::format("{} explodes: its motion ends at {:.6g} s", robot().robot.name, time(frame - 1));
    count_ = frame;
    return;
  }
}

ExportedRobot RecordedMotion::robot() const {
  const Robot& robot = recording_->robots()[robot_].robot;
  return {.robot = robot, .materials = materials_of(robot), .environment = recording_->configuration().environment};
}

double RecordedMotion::frame_rate() const {
  return count_ > 1 ? static_cast<double>(count_ - 1) / (time(count_ - 1) - time(0)) : 0;
}

Pose RecordedMotion::pose(std::size_t frame) {
  const std::size_t recorded = recorded_frame(frame);
  return {
      .time = recording_->time(recorded), .positions = recording_->positions_of(robot_, recorded), .velocities = {}};
}

Pose RecordedMotion::pose_with_velocities(std::size_t frame) {
  Pose pose = this->pose(frame);
  pose.velocities = recording_->velocities_of(robot_, recorded_frame(frame));
  return pose;
}

std::vector<render::Vector3> side_by_side(std::span<RecordedMotion> motions) {
  if (motions.size() < 2) return std::vector<render::Vector3>(motions.size(), render::Vector3{0, 0, 0});
  std::vector<render::Bounds> boxes;
  for (const RecordedMotion& motion : motions) boxes.push_back(rest_bounds(motion.robot().robot));
  const bool ground = has_ground(motions.front().robot().environment);
  return grid_layout(boxes, {.view = direction_of({}, ground), .on_ground = ground});
}

}  // namespace mercury
