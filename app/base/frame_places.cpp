// SPDX-License-Identifier: Apache-2.0
#include "app/base/frame_places.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "mercury/error.h"

namespace mercury {
namespace {

constexpr double rounding = 1e-6;        // of a step: a frame as near as this is at the step
constexpr double last_step_ever = 9e18;  // that an integer holds

// 1 / (30 * dt) of steps of 1/300 s is 10 and a few bits, which would add up.
double without_last_bits(double steps) {
  const double whole = std::round(steps);
  return std::abs(steps - whole) <= 1e-9 * whole ? whole : steps;
}

}  // namespace

FramePlace place_after(std::int64_t first, double steps) {
  steps = std::min(steps, last_step_ever - static_cast<double>(first));
  const double whole = std::floor(steps + rounding);
  const double share = steps - whole;
  return {.step = first + static_cast<std::int64_t>(whole), .share = share > rounding ? static_cast<float>(share) : 0};
}

FramePlaces::FramePlaces(std::int64_t first, std::int64_t every)
    : first_(first), steps_per_frame_(static_cast<double>(every)) {}

FramePlaces::FramePlaces(std::int64_t first, double rate, double dt)
    : first_(first), steps_per_frame_(without_last_bits(1 / (rate * dt))) {}

FramePlace FramePlaces::of(std::int64_t frame) const {
  return place_after(first_, static_cast<double>(frame) * steps_per_frame_);
}

std::int64_t FramePlaces::count(std::int64_t steps) const {
  return static_cast<std::int64_t>(std::floor((static_cast<double>(steps) + rounding) / steps_per_frame_)) + 1;
}

std::int64_t FramePlaces::every() const {
  return std::max<std::int64_t>(1, std::llround(std::min(steps_per_frame_, last_step_ever)));
}

void require_frame_rate(const char* option, double rate, double dt) {
  const double most = 1 / dt;
  if (!(rate > 0 && rate <= most * (1 + 1e-9)))
    throw InputError(
        option,
        fmt::format("{} is not accepted; give more than 0 and at most {:.6g} frames/s, one per step", rate, most));
}

void interpolate(std::span<Vec3> values, std::span<const Vec3> next, float share) {
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = interpolated(values[i], next[i], share);
}

}  // namespace mercury
