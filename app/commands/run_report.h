// SPDX-License-Identifier: Apache-2.0
// The results of `mercury run` as a table, CSV or JSON.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/commands/robot_results.h"
#include "mercury/configuration.h"

namespace mercury {

struct RunReport {
  Configuration configuration;
  double settle = 0;   // of the time, at the start, during which nothing was measured [s]
  int trials = 1;      // of each robot
  double jitter = 0;   // with which they began
  std::string device;  // device name, for people
  std::int64_t steps = 0;
  double seconds = 0;        // simulated
  std::int64_t resumed = 0;  // of the steps: those before a checkpoint or repro
  double wall_seconds = 0;   // during which the others were stepped, on any device
  bool interrupted = false;  // it ended early: the user stopped it, or the device failed
  std::string problem;       // of the device; empty = none
  std::size_t missing = 0;   // robots that are not in an interrupted report, as they have not come so far
  std::vector<std::string> notes;
  std::vector<RobotResult> robots;

  std::size_t count(Fate fate) const;
  std::size_t springs() const;  // of all robots
  double springs_per_second() const;
};

// Robots in the order of the command. A figure that means nothing is "-".
std::string table_of(const RunReport& report);
// A line of names, then one line per robot (RFC 4180).
std::string csv_of(const RunReport& report);
std::string json_of(const RunReport& report);

}  // namespace mercury
