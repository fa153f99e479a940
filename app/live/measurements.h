// SPDX-License-Identifier: Apache-2.0
// Time series and a ranking of the robots, in memory that does not grow with the length of the run.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "app/live/snapshot.h"
#include "mercury/configuration.h"

namespace mercury {

struct SceneDocument;

// What the measure panel plots.
enum class Measure { speed, distance, kinetic_energy, elastic_energy, strain, inverted, overlap };

struct MeasureName {
  Measure measure;
  const char* name;  // "distance"
  const char* unit;  // "m"
  const char* help;
  bool of_folding = false;  // NaN unless ViewSettings::folding
};
std::span<const MeasureName> measures();

struct Sample {
  float speed = 0;           // of the center of mass [m/s]
  float distance = 0;        // of the center of mass from its start [m]
  float kinetic_energy = 0;  // [J]
  float elastic_energy = 0;  // [J]
  float strain = 0;          // largest of any spring [1]
  float inverted = 0;        // share of the body [1]; NaN unless it is measured (folding.h)
  float overlap = 0;         // share of the masses; the same
  float of(Measure measure) const;
};

// The samples of one robot, from the time it was added.
struct Series {
  std::vector<double> times;    // [s], ascending
  std::vector<Sample> samples;  // as many
};

// One robot in the ranking.
struct RankingRow {
  RobotId robot = 0;
  double distance = 0;                            // of the center of mass from its start, distance_between() [m]
  double mean_speed = 0;                          // distance divided by the age [m/s]
  double age = 0;                                 // time since it was added, or since the last reset [s]
  double distance_at_equal_age = 0;               // the distance when it was as old as the youngest robot is now [m]
  double speed = 0;                               // now [m/s]
  double kinetic_energy = 0, elastic_energy = 0;  // now [J]
  double largest_strain = 0;                      // so far [1]
  bool exploded = false;
  double exploded_at = 0;  // [s]

  // Whether the figures mean anything: those of an exploded robot do not.
  bool counts() const { return !exploded; }
};

// Robots whose figures count come first, then those with more of a figure. `ascending`: with less of it; exploded
// robots stay last.
bool ranks_before(const RankingRow& a, const RankingRow& b, double figure_a, double figure_b, bool ascending = false);

// Takes a sample of all robots at a fixed interval of steps. When the buffers are full, drops every second sample and
// doubles the interval:
//
//   steps    0   1   2   3   4   5   6   7   8        capacity 8
//   before   *   *   *   *   *   *   *   *            full
//   after    *       *       *       *       *        every second one, and the next one in the same rhythm
//
// Thread-safe: the physics thread writes and the window reads.
class Measurements {
 public:
  // `capacity`: samples per robot, at least 4.
  explicit Measurements(std::size_t capacity = 1024);

  // Forgets everything: time starts again, at `time` and `step`. One telemetry per robot.
  void restart(const LiveRobots& robots, double time, std::int64_t step, const Configuration& configuration,
               std::span<const Telemetry> telemetry);
  // Takes over the series of these robots from others, and forgets all else. Then call set_robots().
  void branch(const Measurements& other, std::span<const RobotId> robots);
  // Call it after robots were added or removed. The series of the others continue.
  void set_robots(const LiveRobots& robots, double time, const Environment& environment,
                  std::span<const Telemetry> telemetry);
  // The step at which the next sample is due.
  std::int64_t next_step() const;
  // Takes a sample if one is due at this step, and updates the ranking.
  void observe(double time, std::int64_t step, std::span<const Telemetry> telemetry);

  // The robots went back to this moment: forgets the samples after it.
  void cut(double time, std::int64_t step);

  // Drops every second sample and doubles the interval, up to 1024 times the first interval.
  void thin_out();

  // The series of one robot; empty if it is unknown.
  Series series(RobotId robot) const;
  // How far a robot was from its start when it was that old; 0 if it is unknown [m].
  double distance_at_age(RobotId robot, double age) const;
  // One row per robot, in the order of the robots, from the last observe(). Distances are those of the environment of
  // the last restart() or set_robots(). Distances at equal age are interpolated between samples; exploded robots do not
  // count as the youngest.
  std::vector<RankingRow> ranking() const;

 private:
  struct Track {
    Vec3 start;             // center of mass [m]
    double start_time = 0;  // [s]
    double largest_strain = 0;
    std::size_t missing = 0;  // samples taken before the robot was added
    std::vector<Sample> samples;
    RankingRow row;
  };
  // The distance at that age, between samples [m].
  double distance_at(const Track& track, double age) const;
  void note(Track& track, const Telemetry& telemetry, double time) const;
  void thin();

  mutable std::mutex mutex_;
  Environment environment_;
  const std::size_t capacity_;  // even, so that the remaining samples are evenly spaced
  std::vector<RobotId> order_;
  std::map<RobotId, Track> tracks_;
  std::vector<double> times_;
  std::int64_t interval_ = 1, first_interval_ = 1;  // in steps
  std::int64_t next_ = 0;
};

// As CSV, with names and units in the first line: time series, one column per robot and quantity.
std::string series_csv(const SceneDocument& document, const Measurements& measurements,
                       const std::vector<RobotId>& robots);
// The same of the ranking: one line per robot, those that went farthest first.
std::string ranking_csv(const SceneDocument& document, const Measurements& measurements);

}  // namespace mercury
