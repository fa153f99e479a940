// SPDX-License-Identifier: Apache-2.0
// What goes along with the robots on the physics thread: the second side of the picture, and ghosts (companion.h).
#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <limits>

#include "app/live/physics_parts.h"

namespace mercury {

Leader Physics::Parts::leader() const { return {simulation, population, measurements, surroundings}; }

// What a companion simulates now. Nothing pulls at ghosts, and those of removed robots are left out.
CompanionRobots Physics::Parts::robots_for(const Companion& companion) const {
  if (&companion == second.get())
    return {population.robots()->robots, difference->over(simulation.configuration()), perturbations};
  CompanionRobots wanted{{}, simulation.configuration(), {}};
  for (const LiveRobot& ghost : ghost_list)
    if (population.robots()->index_of(ghost.id)) wanted.robots.push_back(ghost);
  return wanted;
}

// A companion that fails, such as for lack of memory, ends; the robots go on.
void Physics::Parts::guard_second(const std::function<void()>& attempt) {
  try {
    attempt();
  } catch (const std::exception& error) {
    messages.add(Severity::error, fmt::format("the second view ended: {}", error.what()));
    second.reset();
    difference.reset();
    ++failed_seconds;
    dirty = true;
  }
}

void Physics::Parts::guard_ghosts(const std::function<void()>& attempt) {
  try {
    attempt();
  } catch (const std::exception& error) {
    messages.add(Severity::error, fmt::format("the ghosts ended: {}", error.what()));
    ghosts.reset();
    ghost_list.clear();
    ++failed_ghosts;
    dirty = true;
  }
}

// Calls use(companion) for each companion.
void Physics::Parts::for_companions(const std::function<void(Companion&)>& use) {
  guard_second([&] {
    if (second) use(*second);
  });
  guard_ghosts([&] {
    if (ghosts) use(*ghosts);
  });
}

void Physics::Parts::take_comparison(PendingCommands& taken) {
  if (taken.difference && *taken.difference != difference) {
    difference = *taken.difference;
    second.reset();
  }
  if (taken.ghosts) {
    ghost_list = std::move(*taken.ghosts);
    ghosts.reset();
  }
  if (taken.view && second) second->watch(view);
}

// Companions that are wanted and not there begin at the moment that is shown. While a recording is played there are
// none: nothing is simulated.
void Physics::Parts::begin_companions() {
  if (recording || simulation.size() == 0) {
    second.reset();
    ghosts.reset();
    return;
  }
  const auto begin = [&](std::unique_ptr<Companion>& companion, Measurements& measured) {
    finish_seek();
    companion = std::make_unique<Companion>(simulation.configuration(), measured, ++companion_count);
    if (&companion == &second) companion->watch(view);
    companion->begin(robots_for(*companion), leader());
    begin_pace();
  };
  if (difference && !second) guard_second([&] { begin(second, second_measurements); });
  if (!ghost_list.empty() && !ghosts) guard_ghosts([&] { begin(ghosts, ghost_measurements); });
}

void Physics::Parts::restart_companions() {
  for_companions([&](Companion& companion) { companion.begin(robots_for(companion), leader()); });
}

// Call it after robots, parameters or what acts on them may have changed.
void Physics::Parts::follow_companions() {
  for_companions([&](Companion& companion) { companion.follow(robots_for(companion), leader()); });
}

void Physics::Parts::advance_companions() {
  for_companions([&](Companion& companion) {
    if (simulation.steps() <= companion.begin_step())
      companion.show_common_past(robots_for(companion), leader());
    else
      companion.advance(leader());
  });
}

void Physics::Parts::observe_companions() {
  for_companions([&](Companion& companion) { companion.observe(simulation.steps()); });
}

// The step at which a sample is due.
std::int64_t Physics::Parts::next_sample() const {
  std::int64_t next = measurements.next_step();
  if (second) next = std::min(next, second_measurements.next_step());
  if (ghosts) next = std::min(next, ghost_measurements.next_step());
  return next;
}

// The step at which a companion begins, if it is still to come.
std::int64_t Physics::Parts::next_beginning() const {
  std::int64_t next = std::numeric_limits<std::int64_t>::max();
  for (const Companion* companion : {second.get(), ghosts.get()})
    if (companion && companion->begin_step() > simulation.steps()) next = std::min(next, companion->begin_step());
  return next;
}

// The state for a keyframe; null if the companion had not begun before.
std::shared_ptr<const BatchState> Physics::Parts::state_of(const std::unique_ptr<Companion>& companion) const {
  if (!companion || simulation.steps() <= companion->begin_step()) return nullptr;
  return std::make_shared<const BatchState>(companion->save());
}

// The last keyframe from which a moment of all robots can be computed. The companions may have begun at a moment before
// others that were kept already.
const Keyframe* Physics::Parts::keyframe_before(std::int64_t step) const {
  const auto holds = [](const Keyframe& keyframe, const Companion* companion, const auto& state) {
    return !companion || keyframe.step() <= companion->begin_step() || state;
  };
  const Keyframe* found = timeline.before(step, [&](const Keyframe& keyframe) {
    return holds(keyframe, second.get(), keyframe.second) && holds(keyframe, ghosts.get(), keyframe.ghosts);
  });
  return found ? found : timeline.before(step);
}

// `jumps`: the robots do not come here by stepping.
void Physics::Parts::show_companions(const Keyframe& keyframe, bool jumps) {
  for_companions([&](Companion& companion) {
    const CompanionRobots wanted = robots_for(companion);
    const auto& state = &companion == second.get() ? keyframe.second : keyframe.ghosts;
    if (keyframe.step() <= companion.begin_step()) return companion.show_common_past(wanted, leader());
    companion.follow(wanted, leader());
    if (state)
      companion.restore(*state);
    else if (jumps)
      companion.begin(wanted, leader());  // the moments before are forgotten
  });
  if (era == head_era) observe_companions();
}

void Physics::Parts::forget_later_companions() {
  for_companions([&](Companion& companion) { companion.forget_later(robots_for(companion), leader()); });
}

void Physics::Parts::publish_companions(Snapshot& next, bool with_velocities) {
  for_companions([&](Companion& companion) {
    std::shared_ptr<Snapshot> own = companion.snapshot(with_velocities);
    own->playing = next.playing;
    own->speed = next.speed;
    own->due_at = next.due_at;
    (&companion == second.get() ? next.second : next.ghosts) = std::move(own);
  });
}

}  // namespace mercury
