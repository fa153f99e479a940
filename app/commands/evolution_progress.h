// SPDX-License-Identifier: Apache-2.0
// The progress line of `mercury evolve`, on standard error.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>

namespace mercury {

// One line that is drawn over and over on a terminal:
//   generation 12/200  best 1.23  median 0.81  8.1 k robots/s  0:34 left
// Elsewhere the same as plain lines, at growing intervals.
class EvolutionProgress {
 public:
  EvolutionProgress(int first_generation, int last_generation);
  ~EvolutionProgress();  // clears the line
  EvolutionProgress(const EvolutionProgress&) = delete;
  EvolutionProgress& operator=(const EvolutionProgress&) = delete;

  // `done` of `all` trials of the current generation.
  void update(std::size_t done, std::size_t all);
  // A generation is complete.
  void finish_generation(std::size_t trials, double best, double median);

 private:
  using Clock = std::chrono::steady_clock;

  void draw();
  std::string line() const;

  const int first_, last_;
  const bool terminal_;
  int generation_;
  double share_ = 0;                     // of the current generation that is done
  std::size_t trials_ = 0, partly_ = 0;  // of all generations that are done, of the current one
  bool is_known_ = false, shown_ = false;
  double best_ = 0, median_ = 0;
  const Clock::time_point start_;
  Clock::time_point last_drawn_;
};

}  // namespace mercury
