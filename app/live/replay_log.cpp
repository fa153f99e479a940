// SPDX-License-Identifier: Apache-2.0
#include "app/live/replay_log.h"

#include <algorithm>

#include "app/live/scene_document.h"

namespace mercury {
namespace {

std::vector<Perturbation> perturbations_of(RobotId robot, const std::vector<LivePerturbation>& all) {
  std::vector<Perturbation> perturbations;
  for (const LivePerturbation& perturbation : all)
    if (perturbation.robot == robot)
      perturbations.push_back(
          {.mass = perturbation.mass, .target = perturbation.target, .stiffness = perturbation.stiffness});
  return perturbations;
}

bool same(const Perturbation& a, const Perturbation& b) {
  return a.mass == b.mass && a.target == b.target && a.stiffness == b.stiffness;
}

}  // namespace

void ReplayLog::restart() {
  forget_states();
  events_.clear();
}

void ReplayLog::forget_states() {
  tracks_.clear();
  since_ = 0;
}

// A state that is still to come is none: the one before it is the newest, or else the present.
void ReplayLog::cut(const Simulation& simulation, const LiveRobots& robots,
                    const std::vector<LivePerturbation>& perturbations) {
  configuration_ = simulation.configuration();
  perturbations_ = perturbations;
  std::map<RobotId, Track> tracks;
  const auto is_known = [&](const std::shared_ptr<const Start>& start) {
    return start && start->clock.step <= simulation.steps() && start->next >= events_.begin() &&
           start->next <= events_.end();
  };
  for (std::size_t i = 0; i < robots.size(); ++i) {
    const LiveRobot& robot = robots.robots[i];
    Track track{.robot = robot.robot, .materials = robot.materials, .by_hand = robot.by_hand};
    if (const auto found = tracks_.find(robot.id); found != tracks_.end() && found->second.robot == robot.robot) {
      track.older = found->second.older;
      track.newer = is_known(found->second.newer) ? found->second.newer : track.older;
    }
    if (!is_known(track.older)) track.older = track.newer = start(simulation, i, track);
    tracks[robot.id] = std::move(track);
  }
  tracks_ = std::move(tracks);
  events_.seal();
}

void ReplayLog::follow(const Simulation& simulation, const LiveRobots& robots,
                       const std::vector<LivePerturbation>& perturbations) {
  const std::int64_t step = simulation.steps();
  if (!tracks_.empty() && simulation.configuration() != configuration_)
    events_.add({.step = step, .configuration = simulation.configuration()});
  configuration_ = simulation.configuration();
  std::map<RobotId, Track> tracks;
  std::vector<std::size_t> fresh;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    const LiveRobot& robot = robots.robots[i];
    const auto known = tracks_.find(robot.id);
    Track& track = tracks[robot.id];
    if (known != tracks_.end() && known->second.robot == robot.robot) {
      track = std::move(known->second);
      if (track.materials != robot.materials)
        events_.add({.step = step, .materials = std::pair{robot.id, robot.materials}});
      if (track.by_hand != robot.by_hand) events_.add({.step = step, .by_hand = std::pair{robot.id, robot.by_hand}});
    } else {
      fresh.push_back(i);
    }
    track.robot = robot.robot;
    track.materials = robot.materials;
    track.by_hand = robot.by_hand;
  }
  tracks_ = std::move(tracks);
  if (perturbations != perturbations_ && !tracks_.empty()) events_.add({.step = step, .perturbations = perturbations});
  perturbations_ = perturbations;
  for (const std::size_t i : fresh) {
    Track& track = tracks_.at(robots.robots[i].id);
    track.older = track.newer = start(simulation, i, track);
  }
  if (!fresh.empty()) events_.seal();
}

std::shared_ptr<const ReplayLog::Start> ReplayLog::start(const Simulation& simulation, std::size_t index,
                                                         const Track& track) const {
  return std::make_shared<const Start>(Start{.clock = simulation.clock(),
                                             .configuration = simulation.configuration(),
                                             .materials = track.materials,
                                             .by_hand = track.by_hand,
                                             .state = simulation.state(index),
                                             .perturbations = perturbations_,
                                             .next = events_.end()});
}

void ReplayLog::stepped(double seconds, const Simulation& simulation, const LiveRobots& robots) {
  since_ += seconds;
  if (since_ < period || simulation.mass_count() > most_masses) return;
  since_ = 0;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    const auto track = tracks_.find(robots.robots[i].id);
    if (track == tracks_.end()) continue;
    track->second.older = std::move(track->second.newer);
    track->second.newer = start(simulation, i, track->second);
  }
  events_.seal();
}

std::uint64_t ReplayLog::needed_events() const {
  std::uint64_t needed = events_.end();
  for (const auto& [id, track] : tracks_) needed = std::min(needed, track.older->next);
  return needed;
}

std::function<Repro()> ReplayLog::repro(const Simulation& simulation, const LiveRobots& robots, std::size_t index,
                                        const Telemetry& telemetry) {
  const LiveRobot& robot = robots.robots[index];
  const auto found = tracks_.find(robot.id);
  if (found == tracks_.end() || found->second.robot != robot.robot) return {};
  const auto& start = found->second.older;
  bool by_hand = start->by_hand != nullptr;
  for (std::uint64_t number = start->next; const SceneEvent* event = events_.find(number); ++number)
    by_hand = by_hand || (event->by_hand && event->by_hand->first == robot.id);
  if (by_hand) return {};
  return [record = Record{robot, start, events_.copy(), start->next - events_.begin(), telemetry, simulation.steps(),
                          simulation.device_name()}] { return record.repro(); };
}

Repro ReplayLog::Record::repro() const {
  LiveRobot then = robot;
  then.materials = start->materials;
  Repro repro{.robot = whole_robot(then),
              .configuration = start->configuration,
              .clock = start->clock,
              .state = start->state,
              .perturbations = perturbations_of(robot.id, start->perturbations),
              .exploded_at = telemetry.exploded_at,
              .culprit_spring = telemetry.culprit_spring,
              .last_step = last_step,
              .device_name = device_name};
  std::vector<Perturbation> perturbations = repro.perturbations;
  for (std::size_t i = first_event; i < events->size(); ++i) {
    const SceneEvent& event = (*events)[i];
    ReproChange change{.step = event.step, .configuration = event.configuration};
    if (event.materials && event.materials->first == robot.id) {
      then.materials = event.materials->second;
      const auto table = materials_of(then);
      change.materials.emplace(table.begin(), table.end());
    }
    if (event.perturbations) {
      std::vector<Perturbation> now = perturbations_of(robot.id, *event.perturbations);
      if (!std::ranges::equal(now, perturbations, same)) change.perturbations = perturbations = std::move(now);
    }
    if (change.configuration || change.materials || change.perturbations) repro.changes.push_back(std::move(change));
  }
  return repro;
}

bool ExplosionLog::note(const LiveRobots& robots, const std::vector<Telemetry>& telemetry,
                        const std::function<std::function<Repro()>(std::size_t)>& repro_of) {
  const std::lock_guard lock(mutex_);
  bool any = false;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    const RobotId id = robots.robots[i].id;
    if (!telemetry[i].exploded || !exploded_.insert(id).second) continue;
    any = true;
    if (std::function<Repro()> repro = repro_of ? repro_of(i) : nullptr) repros_[id] = std::move(repro);
    explosions_.push_back({id, telemetry[i].exploded_at, telemetry[i].culprit_spring});
  }
  return any;
}

void ExplosionLog::forget_absent(const LiveRobots& robots) {
  std::erase_if(exploded_, [&](RobotId id) { return !robots.index_of(id); });
}

void ExplosionLog::forget_whole(const LiveRobots& robots, const std::vector<Telemetry>& telemetry) {
  const std::lock_guard lock(mutex_);
  std::erase_if(exploded_, [&](RobotId id) {
    const auto index = robots.index_of(id);
    const bool whole = !index || !telemetry[*index].exploded;
    if (whole) repros_.erase(id);
    return whole;
  });
}

void ExplosionLog::clear() {
  const std::lock_guard lock(mutex_);
  exploded_.clear();
  repros_.clear();
}

std::vector<Explosion> ExplosionLog::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(explosions_, {});
}

std::optional<Repro> ExplosionLog::repro(RobotId robot) const {
  std::function<Repro()> repro;
  {
    const std::lock_guard lock(mutex_);
    if (const auto found = repros_.find(robot); found != repros_.end()) repro = found->second;
  }
  return repro ? std::optional(repro()) : std::nullopt;
}

}  // namespace mercury
