// SPDX-License-Identifier: Apache-2.0
#include "app/live/recording_player.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mercury {
namespace {

std::vector<LivePerturbation> live_perturbations(RobotId robot, const std::vector<Perturbation>& perturbations) {
  std::vector<LivePerturbation> live;
  for (const Perturbation& perturbation : perturbations)
    live.push_back({.robot = robot,
                    .mass = perturbation.mass,
                    .target = perturbation.target,
                    .stiffness = perturbation.stiffness});
  return live;
}

}  // namespace

void RecordingPlayer::open(std::shared_ptr<TrajectoryReader> recording) {
  recording_ = std::move(recording);
  history_.reset();
  batch_.perturb({});
  stepping_.drop();
  show(begin());
  batch_.restart_measures();
  batch_.measure();
}

void RecordingPlayer::show(double time) {
  TrajectoryReader& reader = *recording_;
  time = std::clamp(time, begin(), end());
  const std::size_t frame = reader.frame_at(time);
  BatchState state = reader.state(frame);
  if (frame + 1 < reader.frames() && time > reader.time(frame)) {
    const double share = (time - reader.time(frame)) / (reader.time(frame + 1) - reader.time(frame));
    interpolate(state.positions, reader.positions(frame + 1), static_cast<float>(share));
    interpolate(state.velocities, reader.velocities(frame + 1), static_cast<float>(share));
    state.clock.step += std::llround(share * static_cast<double>(reader.step(frame + 1) - reader.step(frame)));
  }
  batch_.restore(state, time < time_);
  time_ = time;
  batch_.measure();
}

bool RecordingPlayer::has_brain_of(RobotId robot) const {
  const auto index = batch_.robots()->index_of(robot);
  return index && recording_->has_brains(*index);
}

std::shared_ptr<const BrainHistory> RecordingPlayer::history_of(RobotId robot) {
  if (history_ && history_->robot == robot) return history_;
  constexpr std::size_t most = 2000;
  auto history = std::make_shared<BrainHistory>();
  history->robot = robot;
  const std::size_t index = *batch_.robots()->index_of(robot), stride = (recording_->frames() - 1) / most + 1;
  for (std::size_t frame = 0; frame < recording_->frames(); frame += stride) {
    const auto senses = recording_->senses_of(index, frame), neurons = recording_->neurons_of(index, frame);
    history->times.push_back(recording_->time(frame));
    history->activity.push_back({robot, {senses.begin(), senses.end()}, {neurons.begin(), neurons.end()}});
  }
  return history_ = std::move(history);
}

double RecordingPlayer::previous() const {
  return recording_->time(recording_->frame_at(std::nextafter(time_, begin())));
}

bool RecordingPlayer::advance(const std::optional<std::pair<double, double>>& loop) {
  const double next = recording_->time(std::min(recording_->frames() - 1, recording_->frame_at(time_) + 1));
  if (stepping_.left() > 0) {
    stepping_.drop();
    show(next);
    return true;
  }
  double time = next;
  std::int64_t due = 0;
  if (!stepping_.is_unlimited()) {
    due = stepping_.due(true);
    if (due <= 0) return false;
    time = time_ + static_cast<double>(due) * batch_.configuration().dt;
  }
  if (time >= (loop ? std::min(loop->second, end()) : end()) && loop)
    time = loop->first;
  else if (is_at_end())
    stepping_.stop();
  show(time);
  stepping_.done(due);
  return true;
}

void RecordingPlayer::leave() {
  batch_.restore(recording_->state(recording_->frame_at(time_)));
  close();
}

void ReproPlayer::begin() {
  LiveRobot robot = batch_.robots()->robots.front();
  robot.materials.reset();  // the repro's robot has the materials of the start
  batch_.follow({robot});
  batch_.configure(repro_->configuration);
  batch_.begin(repro_->clock, repro_->state);
  batch_.perturb(live_perturbations(robot.id, repro_->perturbations));
  next_ = 0;
}

std::int64_t ReproPlayer::next_step() const {
  return repro_ && next_ < repro_->changes.size() ? repro_->changes[next_].step
                                                  : std::numeric_limits<std::int64_t>::max();
}

bool ReproPlayer::advance() {
  if (next_step() > batch_.steps()) return false;
  LiveRobot robot = batch_.robots()->robots.front();
  std::vector<LivePerturbation> perturbations = batch_.perturbations();
  for (; next_step() <= batch_.steps(); ++next_) {
    const ReproChange& change = repro_->changes[next_];
    if (change.configuration) batch_.configure(*change.configuration);
    if (change.materials) robot.materials = std::make_shared<const std::vector<Material>>(*change.materials);
    if (change.perturbations) perturbations = live_perturbations(robot.id, *change.perturbations);
  }
  batch_.follow({robot});
  batch_.perturb(std::move(perturbations));
  return true;
}

void ReproPlayer::skip() {
  for (next_ = 0; next_step() < batch_.steps();) ++next_;
}

}  // namespace mercury
