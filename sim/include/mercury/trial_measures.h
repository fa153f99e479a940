// SPDX-License-Identifier: Apache-2.0
// What is measured of one robot during its trial, sample by sample. An Evaluator does it for its robots; a program that
// steps a simulation itself gets the same values from the same samples.
#pragma once

#include <algorithm>

#include "mercury/evaluator.h"

namespace mercury {

class TrialMeasures {
 public:
  // `start` = the telemetry at the start of the trial.
  explicit TrialMeasures(const Telemetry& start)
      : start_(start), last_(start), highest_(start.center_of_mass.z), largest_strain_(start.largest_strain),
        strained_share_(start.strained_share) {}

  // `now` = the telemetry `seconds` after the last sample. A robot that has exploded is frozen: it does no work, though
  // its muscles are still reported to push.
  void add(const Telemetry& now, double seconds) {
    path_ += static_cast<double>(length(now.center_of_mass - last_.center_of_mass));
    if (!now.exploded) work_ += seconds * 0.5 * (last_.muscle_power + now.muscle_power);
    highest_ = std::max(highest_, static_cast<double>(now.center_of_mass.z));
    largest_strain_ = std::max(largest_strain_, static_cast<double>(now.largest_strain));
    strained_share_ = std::max(strained_share_, static_cast<double>(now.strained_share));
    last_ = now;
  }

  // Writes all that derives from the samples; the rest of the result stays as it is.
  void write(Evaluation& result) const {
    result.start = start_;
    result.end = last_;
    result.path = path_;
    result.work = work_;
    result.highest = highest_;
    result.largest_strain = largest_strain_;
    result.strained_share = strained_share_;
  }

 private:
  Telemetry start_, last_;
  double path_ = 0, work_ = 0, highest_, largest_strain_, strained_share_;
};

}  // namespace mercury
