// SPDX-License-Identifier: Apache-2.0
// The progress of a long task, on standard error.
#pragma once

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <string>

#include "mercury/work_watch.h"

namespace mercury {

// How much of a task is done, in its units.
struct Done {
  std::int64_t whole = 0;  // are done
  double in_all = 0;       // the same and what is done in part of others, which counts for the bar and the time left

  Done(std::int64_t done) : Done(done, static_cast<double>(done)) {}
  Done(std::int64_t done, double with_parts) : whole(done), in_all(with_parts) {}
};

// Draws a bar with rate and time left on a terminal. Elsewhere prints a plain line at growing intervals, the first
// after 5 s or what MERCURY_PROGRESS_SECONDS says. Writes nothing if the program is quiet (app/base/messages.h); if it
// is verbose, says at the end how long the task took.
class Progress {
 public:
  // `what` names the task ("rendering"), `unit` what is counted ("frames").
  Progress(std::string what, std::string unit, std::int64_t total);
  ~Progress();  // clears the bar
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // Reports that `done` of the total are done. Cheap: writes at most ten times per second.
  void update(Done done);
  // Draws the bar now, on a terminal, with what is done so far: before a single step that may take long.
  void show();

 private:
  void draw();
  using Clock = std::chrono::steady_clock;

  std::string what_, unit_;
  std::int64_t total_;
  bool terminal_;
  std::chrono::duration<double> line_period_;
  bool shown_ = false;
  Done done_{0};
  Clock::time_point start_, last_;
};

// Whether standard error is a terminal on which a line can be drawn again.
bool draws_on_terminal();
// Columns of that terminal; 80 if unknown.
int terminal_columns();

// The bar: "rendering [#####     ]  50 %  150/300 frames  42.1 frames/s  0:04 left", cut to `columns`.
std::string progress_bar(const std::string& what, const std::string& unit, const Done& done, std::int64_t total,
                         double elapsed, int columns);
// The plain line: "rendering: 150/300 frames (50 %)  42.1 frames/s  0:04 left".
std::string progress_line(const std::string& what, const std::string& unit, const Done& done, std::int64_t total,
                          double elapsed);

// A number with three digits and k, M, G, T or P: "4", "1.50 k", "23.1 G".
std::string with_magnitude(double value);

// "0:04", "12:30", "1:02:03".
std::string clock_text(double seconds);
// "4.2 s", "53 s", "12 min 5 s", "3 h 7 min", "2 h".
std::string duration_text(double seconds);

// A watch that shows the progress on standard error, and throws Interrupted after the first Ctrl-C. Copies share what
// they show.
WorkWatch shown_work();

}  // namespace mercury
