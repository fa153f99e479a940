// SPDX-License-Identifier: Apache-2.0
// The results of `mercury run` as a table, CSV or JSON.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "mercury/configuration.h"
#include "mercury/telemetry.h"

namespace mercury {

struct RobotResult {
  std::string name;
  std::size_t masses = 0, springs = 0;
  double displacement = 0;    // of the centre of mass, from start to end [m]
  double mean_speed = 0;      // length of the path of the centre of mass per time [m/s]
  double largest_strain = 0;  // over all samples [1]
  double strained_share = 0;  // largest share of the springs that a sample has above strained_limit [1]
  bool exploded = false;
  double exploded_at = 0;  // [s]
  std::uint32_t culprit_spring = no_spring;
  std::uint64_t hash = 0;  // of the final positions and velocities
};

struct RunReport {
  Configuration configuration;
  std::string device;  // device name, for people
  std::int64_t steps = 0;
  double seconds = 0;        // simulated
  double wall_seconds = 0;   // during which robots were stepped, on any device
  bool interrupted = false;  // the user stopped it before the end
  std::size_t missing = 0;   // robots that are not in an interrupted report, as they have not come so far
  std::vector<std::string> notes;
  std::vector<RobotResult> robots;

  std::size_t springs() const;  // of all robots
  double springs_per_second() const;
};

// A field of a CSV line, in quotes where RFC 4180 requires them.
std::string csv_field(const std::string& text);

std::string table_of(const RunReport& report);
// A line of names, then one line per robot (RFC 4180).
std::string csv_of(const RunReport& report);
// Numbers that are not finite become null.
std::string json_of(const RunReport& report);

}  // namespace mercury
