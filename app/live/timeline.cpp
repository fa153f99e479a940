// SPDX-License-Identifier: Apache-2.0
#include "app/live/timeline.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mercury {
namespace {

std::pair<std::int64_t, std::uint64_t> place_of(const Keyframe& keyframe) { return {keyframe.step(), keyframe.era}; }

bool same_base(const Clock& a, const Clock& b) {
  return a.dt == b.dt && a.base_time == b.base_time && a.base_step == b.base_step;
}

std::size_t brain_bytes(std::span<const BrainState> brains) {
  std::size_t sum = 0;
  for (const BrainState& brain : brains)
    sum +=
        sizeof(brain) + (brain.neurons.capacity() + brain.senses.capacity() + brain.weights.capacity()) * sizeof(float);
  return sum;
}

}  // namespace

std::size_t Keyframe::bytes() const {
  const auto bytes_of = [](const BatchState& all) {
    return (all.positions.capacity() + all.velocities.capacity()) * sizeof(Vec3) +
           all.explosions.capacity() * sizeof(BatchState::Explosion) + brain_bytes(all.brains);
  };
  std::size_t sum = sizeof(Keyframe) + bytes_of(state);
  for (const auto& companion : companions)
    if (companion) sum += sizeof(BatchState) + bytes_of(*companion);
  return sum;
}

void Timeline::clear() {
  keyframes_.clear();
  clocks_.clear();
  bytes_ = 0;
}

void Timeline::set_budget(std::size_t bytes) {
  budget_ = bytes;
  thin();
}

void Timeline::add(Keyframe keyframe) {
  const auto place = std::ranges::lower_bound(keyframes_, place_of(keyframe), {}, place_of);
  bytes_ += keyframe.bytes();
  if (place != keyframes_.end() && place_of(*place) == place_of(keyframe)) {
    bytes_ -= place->bytes();
    *place = std::move(keyframe);
  } else {
    keyframes_.insert(place, std::move(keyframe));
  }
  drop_instant_eras();
  thin();
}

// An era that ends at the step at which it began shows nothing.
void Timeline::drop_instant_eras() {
  for (std::size_t i = keyframes_.size(); i-- > 1;)
    if (keyframes_[i - 1].step() == keyframes_[i].step()) erase(i - 1);
}

void Timeline::cut(std::int64_t step, std::uint64_t era) {
  while (!keyframes_.empty() && (keyframes_.back().step() > step || keyframes_.back().era > era))
    erase(keyframes_.size() - 1);
  while (!clocks_.empty() && clocks_.back().base_step >= step) clocks_.pop_back();
}

const Keyframe* Timeline::before(std::int64_t step) const {
  const auto after = std::ranges::upper_bound(keyframes_, step, {}, &Keyframe::step);
  return after == keyframes_.begin() ? nullptr : &*std::prev(after);
}

const Keyframe* Timeline::before(std::int64_t step, const std::function<bool(const Keyframe&)>& usable) const {
  auto place = std::ranges::upper_bound(keyframes_, step, {}, &Keyframe::step);
  while (place != keyframes_.begin())
    if (usable(*--place)) return &*place;
  return nullptr;
}

const Keyframe* Timeline::next_era(std::uint64_t era) const {
  const auto next = std::ranges::find_if(keyframes_, [&](const Keyframe& keyframe) { return keyframe.era > era; });
  return next == keyframes_.end() ? nullptr : &*next;
}

void Timeline::note(const Clock& clock) {
  if (!clocks_.empty() && same_base(clocks_.back(), clock)) return;
  if (!clocks_.empty() && clocks_.back().base_step == clock.base_step) clocks_.pop_back();
  clocks_.push_back(clock);
}

std::int64_t Timeline::step_at(double time) const {
  if (clocks_.empty() || !std::isfinite(time)) return 0;
  auto clock = std::ranges::upper_bound(clocks_, time, {}, &Clock::base_time);
  if (clock != clocks_.begin()) --clock;
  const double steps = std::round((time - clock->base_time) / clock->dt);
  const auto next = std::next(clock);
  const std::int64_t last = next == clocks_.end() ? std::numeric_limits<std::int64_t>::max() : next->base_step;
  if (!(steps < 9e18)) return last;
  return std::clamp(clock->base_step + static_cast<std::int64_t>(std::max(0.0, steps)), clock->base_step, last);
}

double Timeline::time_at(std::int64_t step) const {
  if (clocks_.empty()) return 0;
  auto clock = std::ranges::upper_bound(clocks_, step, {}, &Clock::base_step);
  if (clock != clocks_.begin()) --clock;
  Clock then = *clock;
  then.step = step;
  return time_of(then);
}

void Timeline::erase(std::size_t index) {
  bytes_ -= keyframes_[index].bytes();
  keyframes_.erase(keyframes_.begin() + static_cast<std::ptrdiff_t>(index));
}

void Timeline::thin() {
  while (bytes_ > budget_ && !keyframes_.empty()) {
    std::size_t cheapest = 0;  // the oldest, if no other may go
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 1; i + 1 < keyframes_.size(); ++i) {
      if (keyframes_[i].era != keyframes_[i - 1].era) continue;  // the first of its era
      const double gap = keyframes_[i + 1].work - keyframes_[i - 1].work;
      if (gap > most_work) continue;
      const double age = keyframes_.back().work - keyframes_[i].work;
      if (const double cost = gap / (age + 0.5); cost < least) {
        least = cost;
        cheapest = i;
      }
    }
    erase(cheapest);
  }
}

void SceneEvents::clear() {
  events_.clear();
  copied_.reset();
  first_ = sealed_ = 0;
}

void SceneEvents::add(SceneEvent event) {
  copied_.reset();
  if (!events_.empty() && end() > sealed_) {
    SceneEvent& last = events_.back();
    const auto robot_of = [](const auto& part) { return part ? part->first : RobotId{0}; };
    const bool same_kind = last.configuration.has_value() == event.configuration.has_value() &&
                           last.perturbations.has_value() == event.perturbations.has_value() &&
                           robot_of(last.materials) == robot_of(event.materials) &&
                           robot_of(last.by_hand) == robot_of(event.by_hand);
    if (last.step == event.step && same_kind && !event.configuration) {
      last = std::move(event);
      return;
    }
  }
  events_.push_back(std::move(event));
}

void SceneEvents::forget_before(std::uint64_t number) {
  if (number <= first_) return;
  const std::uint64_t count = std::min<std::uint64_t>(number - first_, events_.size());
  events_.erase(events_.begin(), events_.begin() + static_cast<std::ptrdiff_t>(count));
  first_ += count;
  copied_.reset();
}

void SceneEvents::cut(std::uint64_t number) {
  if (number >= end()) return;
  events_.resize(number > first_ ? number - first_ : 0);
  sealed_ = std::min(sealed_, end());
  copied_.reset();
}

std::shared_ptr<const std::vector<SceneEvent>> SceneEvents::copy() {
  if (!copied_) copied_ = std::make_shared<const std::vector<SceneEvent>>(events_);
  return copied_;
}

}  // namespace mercury
