// SPDX-License-Identifier: Apache-2.0
// How far a long piece of work has come, on standard error.
#pragma once

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <string>

namespace mercury {

// On a terminal a bar that renews itself, with rate and time left; elsewhere a plain line now and then.
class Progress {
 public:
  // `what` names the work ("rendering"), `unit` what is counted ("frames"). A quiet one writes nothing.
  Progress(std::string what, std::string unit, std::int64_t total, bool quiet = false);
  ~Progress();  // clears the bar
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // `done` of the total are done. Cheap: writes at most ten times a second.
  void update(std::int64_t done);

 private:
  using Clock = std::chrono::steady_clock;

  std::string what_, unit_;
  std::int64_t total_;
  bool quiet_, terminal_;
  bool shown_ = false;
  Clock::time_point start_, last_;
};

// The bar: "rendering [#####     ]  50 %  150/300 frames  42.1 frames/s  0:04 left", cut to `columns`.
std::string progress_bar(const std::string& what, const std::string& unit, std::int64_t done, std::int64_t total,
                         double elapsed, int columns);
// The plain line, without the drawing.
std::string progress_line(const std::string& what, const std::string& unit, std::int64_t done, std::int64_t total,
                          double elapsed);

// "4", "1.5 k", "2.31e+10" would be hard to compare: three digits and k, M, G, T.
std::string with_magnitude(double value);

// "0:04", "12:30", "1:02:03".
std::string clock_text(double seconds);

}  // namespace mercury
