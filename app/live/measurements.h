// SPDX-License-Identifier: Apache-2.0
// What is measured of each robot over time, in memory that does not grow with the run.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "app/live/snapshot.h"

namespace mercury {

enum class Quantity { speed, distance, kinetic_energy, elastic_energy, strain };

struct QuantityName {
  Quantity quantity;
  const char* name;  // "distance"
  const char* unit;  // "m"
};
std::span<const QuantityName> quantities();

struct Sample {
  float speed = 0;           // of the centre of mass [m/s]
  float distance = 0;        // of the centre of mass from where it started [m]
  float kinetic_energy = 0;  // [J]
  float elastic_energy = 0;  // [J]
  float strain = 0;          // largest of any spring [1]
  float of(Quantity quantity) const;
};

// One robot's samples; those of before it came are missing.
struct Series {
  std::vector<double> times;    // [s], ascending
  std::vector<Sample> samples;  // as many
};

// One robot in the ranking.
struct RankingRow {
  RobotId robot = 0;
  double distance = 0;                            // of the centre of mass from where it started [m]
  double mean_speed = 0;                          // distance over the time since it started [m/s]
  double speed = 0;                               // now [m/s]
  double kinetic_energy = 0, elastic_energy = 0;  // now [J]
  double largest_strain = 0;                      // so far [1]
  bool exploded = false;
  double exploded_at = 0;  // [s]
};

// Takes a sample of all robots every so many steps. Where the buffers are full, every second sample is dropped and the
// interval doubled. The physics thread writes, the window reads.
class Measurements {
 public:
  // At least 4 samples fit.
  explicit Measurements(std::size_t capacity = 1024);

  // Forgets everything: time begins anew.
  void restart(const LiveRobots& robots, double time, std::int64_t step, double dt,
               std::span<const Telemetry> telemetry);
  // Robots came or went; the series of those that stay go on.
  void set_robots(const LiveRobots& robots, double time, std::span<const Telemetry> telemetry);
  // The step at which the next sample is due.
  std::int64_t next_step() const;
  // Takes a sample if one is due at this step, and notes extremes.
  void observe(double time, std::int64_t step, std::span<const Telemetry> telemetry);

  // Every second sample goes, and from now on so many fewer are taken; not beyond a thousandth of what it was at first.
  void thin_out();

  // Of one robot; empty if there is none.
  Series series(RobotId robot) const;
  // In the order of the robots, at the last observe().
  std::vector<RankingRow> ranking() const;

 private:
  struct Track {
    Vec3 start;             // centre of mass [m]
    double start_time = 0;  // [s]
    double largest_strain = 0;
    std::size_t missing = 0;  // samples of before it came
    std::vector<Sample> samples;
    RankingRow row;
  };
  void note(Track& track, const Telemetry& telemetry, double time) const;
  void thin();

  mutable std::mutex mutex_;
  const std::size_t capacity_;  // even, so that the samples that stay are evenly spaced
  std::vector<RobotId> order_;
  std::map<RobotId, Track> tracks_;
  std::vector<double> times_;
  std::int64_t interval_ = 1, first_interval_ = 1;  // in steps
  std::int64_t next_ = 0;
};

}  // namespace mercury
