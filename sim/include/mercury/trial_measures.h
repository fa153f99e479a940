// SPDX-License-Identifier: Apache-2.0
// What is measured of one robot during its trial, sample by sample. An Evaluator does it for its robots; a program that
// steps a simulation itself gets the same values from the same samples.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "mercury/distance.h"
#include "mercury/environment.h"
#include "mercury/evaluator.h"

namespace mercury {

class TrialMeasures {
 public:
  // All that the samples so far have left.
  struct Sums {
    Telemetry start, last;
    double path = 0, work = 0, positive_work = 0, highest = 0, largest_strain = 0, strained_share = 0;
    double inverted = std::numeric_limits<double>::quiet_NaN(), overlap = inverted;  // NaN = not measured
    double nearest = inverted;                                                       // to the target; NaN = unknown
    double upright = 0, upright_seconds = 0;  // its integral over the time while it was measured [s], [s]
    double elapsed = 0;                       // from the start to the last sample [s]
    // The way of the center of mass: its places at every stride-th sample, from the start; samples are `period` [s]
    // apart. Without places the way is unknown.
    double period = 0;
    std::int64_t samples = 0, stride = 1;
    std::vector<Vec3> way;
  };
  // Places that a way keeps at most; then it forgets every second one. So its memory does not grow with the time, and
  // what is left does not depend on when the trial will end.
  static constexpr std::size_t longest_way = 512;

  // `start` = the telemetry at the start of the trial.
  explicit TrialMeasures(const Telemetry& start, const Environment& environment = {})
      : environment_(environment), sums_{.start = start,
                                         .last = start,
                                         .highest = start.center_of_mass.z,
                                         .largest_strain = start.largest_strain,
                                         .strained_share = start.strained_share,
                                         .inverted = start.inverted,
                                         .overlap = start.overlap,
                                         .nearest =
                                             distance_between(start.center_of_mass, environment.target, environment),
                                         .way = {start.center_of_mass}} {}

  // `now` = the telemetry `seconds` after the last sample; all samples but the last are equally far apart. A robot that
  // has exploded is frozen: it does no work, though its muscles are still reported to push.
  void add(const Telemetry& now, double seconds) {
    sums_.path += static_cast<double>(length(now.center_of_mass - sums_.last.center_of_mass));
    if (!now.exploded) {
      sums_.work += seconds * 0.5 * (sums_.last.muscle_power + now.muscle_power);
      sums_.positive_work += seconds * mean_positive(sums_.last.muscle_power, now.muscle_power);
    }
    sums_.highest = std::max(sums_.highest, static_cast<double>(now.center_of_mass.z));
    sums_.largest_strain = std::max(sums_.largest_strain, static_cast<double>(now.largest_strain));
    sums_.strained_share = std::max(sums_.strained_share, static_cast<double>(now.strained_share));
    // Where one of both is not measured, the other one.
    sums_.inverted = std::fmax(sums_.inverted, static_cast<double>(now.inverted));
    sums_.overlap = std::fmax(sums_.overlap, static_cast<double>(now.overlap));
    sums_.nearest = std::min(sums_.nearest, distance_between(now.center_of_mass, environment_.target, environment_));
    if (!std::isnan(sums_.last.upright + now.upright)) {
      sums_.upright += seconds * 0.5 * (static_cast<double>(sums_.last.upright) + static_cast<double>(now.upright));
      sums_.upright_seconds += seconds;
    }
    sums_.last = now;
    sums_.elapsed += seconds;
    note(now.center_of_mass, seconds);
  }

  // Writes all that derives from the samples; the rest of the result stays as it is.
  void write(Evaluation& result) const {
    result.start = sums_.start;
    result.end = sums_.last;
    result.path = sums_.path;
    result.work = sums_.work;
    result.positive_work = sums_.positive_work;
    result.highest = sums_.highest;
    result.largest_strain = sums_.largest_strain;
    result.strained_share = sums_.strained_share;
    result.inverted = sums_.inverted;
    result.overlap = sums_.overlap;
    result.nearest = sums_.nearest;
    result.upright =
        sums_.upright_seconds > 0 ? sums_.upright / sums_.upright_seconds : static_cast<double>(sums_.start.upright);
    result.third = sums_.elapsed / 3;
    result.at_third = place_at(sums_.elapsed / 3);
    result.at_two_thirds = place_at(2 * sums_.elapsed / 3);
  }

  // To go on elsewhere: TrialMeasures(measures.sums(), environment) has the same samples.
  const Sums& sums() const { return sums_; }
  explicit TrialMeasures(const Sums& sums, const Environment& environment = {})
      : environment_(environment), sums_(sums) {}

 private:
  // Of max(0, P), where P goes from `a` to `b` along a line.
  static double mean_positive(double a, double b) {
    const double high = std::max(a, b), low = std::min(a, b);
    if (high <= 0) return 0;
    return low >= 0 ? 0.5 * (a + b) : 0.5 * high * high / (high - low);
  }

  void note(Vec3 place, double seconds) {
    if (sums_.samples == 0) sums_.period = seconds;
    if (seconds != sums_.period || sums_.way.empty()) return;
    if (++sums_.samples % sums_.stride != 0) return;
    if (sums_.way.size() == longest_way) {
      for (std::size_t i = 0; 2 * i < longest_way; ++i) sums_.way[i] = sums_.way[2 * i];
      sums_.way.resize(longest_way / 2);
      sums_.stride *= 2;
      if (sums_.samples % sums_.stride != 0) return;
    }
    sums_.way.push_back(place);
  }

  // Of the center of mass, on a line between the places before and after that time; NaN if the way is unknown.
  Vec3 place_at(double time) const {
    constexpr float unknown = std::numeric_limits<float>::quiet_NaN();
    if (sums_.way.empty()) return {unknown, unknown, unknown};
    const double apart = sums_.period * static_cast<double>(sums_.stride);
    if (!(apart > 0)) return sums_.last.center_of_mass;
    const auto before = std::min(static_cast<std::size_t>(time / apart), sums_.way.size() - 1);
    const bool is_last = before + 1 == sums_.way.size();
    const Vec3 a = sums_.way[before], b = is_last ? sums_.last.center_of_mass : sums_.way[before + 1];
    const double from = apart * static_cast<double>(before), to = is_last ? sums_.elapsed : from + apart;
    if (!(to > from)) return a;
    return a + static_cast<float>(std::clamp((time - from) / (to - from), 0.0, 1.0)) * (b - a);
  }

  Environment environment_;
  Sums sums_;
};

}  // namespace mercury
