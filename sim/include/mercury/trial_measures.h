// SPDX-License-Identifier: Apache-2.0
// What is measured of one robot during its trial, sample by sample. An Evaluator does it for its robots; a program that
// steps a simulation itself gets the same values from the same samples.
#pragma once

#include <algorithm>

#include "mercury/evaluator.h"

namespace mercury {

class TrialMeasures {
 public:
  // All that the samples so far have left.
  struct Sums {
    Telemetry start, last;
    double path = 0, work = 0, highest = 0, largest_strain = 0, strained_share = 0;
  };

  // `start` = the telemetry at the start of the trial.
  explicit TrialMeasures(const Telemetry& start)
      : sums_{.start = start,
              .last = start,
              .highest = start.center_of_mass.z,
              .largest_strain = start.largest_strain,
              .strained_share = start.strained_share} {}

  // `now` = the telemetry `seconds` after the last sample. A robot that has exploded is frozen: it does no work, though
  // its muscles are still reported to push.
  void add(const Telemetry& now, double seconds) {
    sums_.path += static_cast<double>(length(now.center_of_mass - sums_.last.center_of_mass));
    if (!now.exploded) sums_.work += seconds * 0.5 * (sums_.last.muscle_power + now.muscle_power);
    sums_.highest = std::max(sums_.highest, static_cast<double>(now.center_of_mass.z));
    sums_.largest_strain = std::max(sums_.largest_strain, static_cast<double>(now.largest_strain));
    sums_.strained_share = std::max(sums_.strained_share, static_cast<double>(now.strained_share));
    sums_.last = now;
  }

  // Writes all that derives from the samples; the rest of the result stays as it is.
  void write(Evaluation& result) const {
    result.start = sums_.start;
    result.end = sums_.last;
    result.path = sums_.path;
    result.work = sums_.work;
    result.highest = sums_.highest;
    result.largest_strain = sums_.largest_strain;
    result.strained_share = sums_.strained_share;
  }

  // To go on elsewhere: TrialMeasures(measures.sums()) has the same samples.
  const Sums& sums() const { return sums_; }
  explicit TrialMeasures(const Sums& sums) : sums_(sums) {}

 private:
  Sums sums_;
};

}  // namespace mercury
