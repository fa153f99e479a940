// SPDX-License-Identifier: Apache-2.0
#include "app/live/timeline_marks.h"

#include <algorithm>
#include <cmath>

namespace mercury {
namespace {

constexpr double same_moment = 1e-9;  // [s]

}  // namespace

bool TimelineMarks::toggle_bookmark(double now) {
  const auto there = std::ranges::find_if(bookmarks_, [&](double time) { return std::abs(time - now) <= same_moment; });
  if (there != bookmarks_.end()) {
    bookmarks_.erase(there);
    return false;
  }
  bookmarks_.insert(std::ranges::upper_bound(bookmarks_, now), now);
  return true;
}

std::optional<double> TimelineMarks::next_bookmark(double now, int direction) const {
  if (direction > 0) {
    const auto next = std::ranges::upper_bound(bookmarks_, now + same_moment);
    return next == bookmarks_.end() ? std::nullopt : std::optional(*next);
  }
  const auto next = std::ranges::lower_bound(bookmarks_, now - same_moment);
  return next == bookmarks_.begin() ? std::nullopt : std::optional(*std::prev(next));
}

void TimelineMarks::forget_bookmarks_after(double moment) {
  std::erase_if(bookmarks_, [&](double time) { return time > moment + same_moment; });
}

std::optional<std::pair<double, double>> TimelineMarks::mark_loop(double now) {
  if (loop_begin_)
    if (const auto loop = loop_between(*loop_begin_, now)) return loop;
  loop_begin_ = now;
  return std::nullopt;
}

std::optional<std::pair<double, double>> TimelineMarks::loop_between(double a, double b) {
  if (!(std::isfinite(std::min(a, b)) && std::abs(b - a) > same_moment)) return std::nullopt;
  return std::minmax(a, b);
}

}  // namespace mercury
