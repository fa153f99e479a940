// SPDX-License-Identifier: Apache-2.0
#include "app/live/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <utility>

#include "mercury/error.h"

namespace mercury {
namespace {

// A step of the robots that takes a thousand steps of the companion would hold up the window.
void require_comparable(const Configuration& own, const Configuration& first) {
  constexpr double most = 1000;
  if (own.dt * most < first.dt)
    throw InputError(
        "dt", fmt::format("{:g} s is less than 1/{:g} of the {:g} s that the robots have", own.dt, most, first.dt));
}

}  // namespace

Companion::Companion(const LiveBatch& first, const Robots& wanted, Measurements& measurements, Messages& messages,
                     std::uint64_t number)
    : first_(first), batch_(first.configuration(), measurements, messages, number << 32) {
  begin(wanted);
}

void Companion::begin(const Robots& wanted) {
  begin_step_ = first_.steps();
  copy(wanted);
  batch_.branch_measures(first_);
}

bool Companion::copy(const Robots& wanted) {
  require_comparable(wanted.configuration, first_.configuration());
  const bool changed = batch_.copy(first_, wanted.robots, wanted.configuration);
  batch_.perturb(wanted.perturbations);
  return changed;
}

void Companion::follow(const Robots& wanted) {
  require_comparable(wanted.configuration, first_.configuration());
  if (first_.surroundings() != batch_.surroundings() || wanted.configuration != batch_.configuration() ||
      wanted.robots != batch_.robots()->robots) {
    batch_.move(wanted.robots, wanted.configuration, first_.surroundings());
    batch_.measure_robots();
  }
  batch_.perturb(wanted.perturbations);
}

void Companion::advance() {
  const Clock& clock = batch_.simulation().clock();
  const std::int64_t target = clock.base_step + std::llround((first_.time() - clock.base_time) / clock.dt);
  if (target > clock.step) batch_.step(target - clock.step);
}

void Companion::show(const Robots& wanted, const std::shared_ptr<const BatchState>& state, bool jumps) {
  if (first_.steps() <= begin_step_) {
    if (copy(wanted)) batch_.branch_measures(first_);
    return;
  }
  follow(wanted);
  if (state)
    batch_.restore(*state);
  else if (jumps)
    begin(wanted);  // the moments before are forgotten
}

void Companion::forget_later(const Robots& wanted) {
  if (first_.steps() < begin_step_) return begin(wanted);
  batch_.cut_measures(first_.steps());
}

// Nothing pulls at ghosts, and those of removed robots are left out.
Companion::Robots Comparison::robots_for(std::size_t side) const {
  if (side == 0) return {first_.robots()->robots, difference_->over(first_.configuration()), first_.perturbations()};
  Companion::Robots wanted{{}, first_.configuration(), {}};
  for (const LiveRobot& ghost : ghosts_)
    if (first_.robots()->index_of(ghost.id)) wanted.robots.push_back(ghost);
  return wanted;
}

void Comparison::attempt(std::size_t side, const std::function<void()>& task) {
  try {
    task();
  } catch (const std::exception& error) {
    messages_.add(Severity::error, fmt::format("{} ended: {}", sides_[side].name, error.what()));
    sides_[side].companion.reset();
    ++sides_[side].failures;
    side == 0 ? difference_.reset() : ghosts_.clear();
  }
}

void Comparison::for_each(const std::function<void(std::size_t, Companion&)>& use) {
  for (std::size_t side = 0; side < sides_.size(); ++side)
    if (Companion* companion = sides_[side].companion.get()) attempt(side, [&] { use(side, *companion); });
}

void Comparison::set_second(const std::optional<SideDifference>& difference) {
  if (difference == difference_) return;
  difference_ = difference;
  sides_[0].companion.reset();
}

void Comparison::set_ghosts(std::vector<LiveRobot> ghosts) {
  ghosts_ = std::move(ghosts);
  sides_[1].companion.reset();
}

void Comparison::watch(const ViewSettings& view) {
  view_ = view;
  if (sides_[0].companion) sides_[0].companion->batch().watch(view);
}

bool Comparison::must_begin() const {
  return (is_wanted(0) && !sides_[0].companion) || (is_wanted(1) && !sides_[1].companion);
}

void Comparison::begin() {
  for (std::size_t side = 0; side < sides_.size(); ++side) {
    if (!is_wanted(side) || sides_[side].companion) continue;
    attempt(side, [&] {
      sides_[side].companion =
          std::make_unique<Companion>(first_, robots_for(side), sides_[side].measurements, messages_, ++count_);
      if (side == 0 && view_) sides_[side].companion->batch().watch(*view_);
    });
  }
}

void Comparison::end() {
  for (Side& side : sides_) side.companion.reset();
}

void Comparison::restart() {
  for_each([&](std::size_t side, Companion& companion) { companion.begin(robots_for(side)); });
}
void Comparison::follow() {
  for_each([&](std::size_t side, Companion& companion) { companion.follow(robots_for(side)); });
}
void Comparison::advance() {
  for_each([&](std::size_t side, Companion& companion) {
    if (first_.steps() > companion.begin_step())
      companion.advance();
    else
      companion.show(robots_for(side), nullptr, false);
  });
}
void Comparison::forget_later() {
  for_each([&](std::size_t side, Companion& companion) { companion.forget_later(robots_for(side)); });
}

void Comparison::measure() {
  for_each([&](std::size_t, Companion& companion) {
    companion.batch().sample();
    companion.batch().measure(first_.steps());
  });
}

std::int64_t Comparison::next_measure() const {
  std::int64_t next = std::numeric_limits<std::int64_t>::max();
  for (const Side& side : sides_)
    if (side.companion) next = std::min(next, side.measurements.next_step());
  return next;
}

void Comparison::thin_measures() {
  for (Side& side : sides_) side.measurements.thin_out();
}

Keyframe::Companions Comparison::states() const {
  Keyframe::Companions states;
  for (std::size_t side = 0; side < sides_.size(); ++side)
    if (Companion* companion = sides_[side].companion.get(); companion && first_.steps() > companion->begin_step())
      states[side] = std::make_shared<const BatchState>(companion->batch().simulation().save());
  return states;
}

bool Comparison::can_show(const Keyframe& keyframe) const {
  const auto holds = [&](const Side& side, const std::shared_ptr<const BatchState>& state) {
    return !side.companion || keyframe.step() <= side.companion->begin_step() || state;
  };
  return holds(sides_[0], keyframe.companions[0]) && holds(sides_[1], keyframe.companions[1]);
}

void Comparison::show(const Keyframe& keyframe, bool jumps) {
  for_each([&](std::size_t side, Companion& companion) {
    companion.show(robots_for(side), keyframe.companions[side], jumps);
  });
}

std::int64_t Comparison::next_beginning() const {
  std::int64_t next = std::numeric_limits<std::int64_t>::max();
  for (const Side& side : sides_)
    if (side.companion && side.companion->begin_step() > first_.steps())
      next = std::min(next, side.companion->begin_step());
  return next;
}

void Comparison::publish(Snapshot& next, bool with_velocities) {
  for_each([&](std::size_t side, Companion& companion) {
    companion.batch().sample();
    std::shared_ptr<Snapshot> own = companion.batch().snapshot(with_velocities);
    own->playing = next.playing;
    own->speed = next.speed;
    own->due_at = next.due_at;
    (side == 0 ? next.second : next.ghosts) = std::move(own);
  });
  next.failed_seconds = sides_[0].failures;
  next.failed_ghosts = sides_[1].failures;
}

}  // namespace mercury
