// SPDX-License-Identifier: Apache-2.0
#include "app/live/scene_events.h"

#include <algorithm>
#include <cstddef>

namespace mercury {

void SceneEvents::clear() {
  events_.clear();
  copied_.reset();
  first_ = sealed_ = 0;
}

void SceneEvents::add(SceneEvent event) {
  copied_.reset();
  if (!events_.empty() && end() > sealed_) {
    SceneEvent& last = events_.back();
    const bool same_kind =
        last.configuration.has_value() == event.configuration.has_value() &&
        last.perturbations.has_value() == event.perturbations.has_value() &&
        (last.materials ? last.materials->first : 0) == (event.materials ? event.materials->first : 0);
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
