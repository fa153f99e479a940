// SPDX-License-Identifier: Apache-2.0
// What the user marks on the timeline. Times in s; those that differ by less than a step of any run are one.
#pragma once

#include <optional>
#include <utility>
#include <vector>

namespace mercury {

class TimelineMarks {
 public:
  const std::vector<double>& bookmarks() const { return bookmarks_; }  // ascending
  bool toggle_bookmark(double now);                                    // returns whether there is one now
  std::optional<double> next_bookmark(double now, int direction) const;
  void forget_bookmarks_after(double time);

  // A loop that has its begin, but not its end.
  const std::optional<double>& loop_begin() const { return loop_begin_; }
  // Begins a loop, or returns its times.
  std::optional<std::pair<double, double>> mark_loop(double now);
  void forget_loop() { loop_begin_.reset(); }
  // The times in ascending order, if there is a loop between them.
  static std::optional<std::pair<double, double>> loop_between(double a, double b);

 private:
  std::vector<double> bookmarks_;
  std::optional<double> loop_begin_;
};

}  // namespace mercury
