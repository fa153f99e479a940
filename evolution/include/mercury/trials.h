// SPDX-License-Identifier: Apache-2.0
// How a robot is tried, the same in `mercury run`, `check`, `new --best-of` and `evolve`, in Python and in the window.
//
// One trial says little: a gait that is exactly symmetric, or chaotic, goes elsewhere if its masses begin a
// micrometer away. So a robot has several trials that begin with jitter, and what is published is their median, with
// its quartiles. A trial of a robot depends on the robot, the settings and the seed alone: bit for bit the same alone
// and in any batch, and all robots of a seed begin with the same deviates.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "mercury/configuration.h"
#include "mercury/evaluator.h"
#include "mercury/individual.h"
#include "mercury/parameters.h"
#include "mercury/robot.h"

namespace mercury {

// The trials of every robot. Initial values are what files of earlier versions mean that lack a key: one trial of the
// robot as it is. Searches use search_trials().
struct TrialSettings {
  double seconds = 10;           // of a trial, settling included [s]
  double settle = 0;             // at its start; nothing is measured before [s]
  int trials = 1;                // per individual
  double jitter = 0;             // standard deviation of each coordinate at the start, per shortest rest length [1]
  double delay = 100;            // all trials but the first start at random moments of the movement, up to here [s]
  double noise = 0;              // standard deviation by which the trials' stiffnesses and amplitudes differ [1]
  double damage = 0;             // share of the voxels that a trial's robot lacks [1]
  double strain_limit = 2;       // of a spring; limits() lists what robots must keep
  double strained_limit = 1;     // share of the springs of a real body that may be strained by more than half at a time
  double inverted_limit = 1;     // share of a real body that may be inside out at a time
  double overlap_limit = 1;      // share of the masses that may be within other parts of the body at a time
  double least_masses = 0;       // of a network robot
  bool median = false;           // of the trials counts, not their mean
  bool mean = false;             // the mean counts, not the median; all else is as with `median`
  double target_radius = 0;      // each trial starts this far from the target, in a random direction; 0 = not [m]
  double target_spread = 0;      // by which share of target_radius it may start nearer
  bool target_sphere = false;    // the direction may point up and down, too
  bool turned = false;           // each trial starts turned about the vertical by a random angle
  bool noise_per_trial = false;  // senses have other noise in each trial but the first
  bool folding = false;          // measure `inverted` and `overlap`, also where no limit asks for them
  bool upright = false;          // measure `upright`, also where no objective asks for it
  bool racing = false;           // stop robots that are clearly behind
  friend bool operator==(const TrialSettings&, const TrialSettings&) = default;

  static constexpr std::tuple parameters{
      Parameter("seconds", &TrialSettings::seconds, "s", Accepts::at_least_zero, {1, 60},
                "Length of a trial, settling included"),
      Parameter("settle", &TrialSettings::settle, "s", Accepts::at_least_zero, {0, 10},
                "Measure from this time on, after robots have fallen"),
      Parameter("trials", &TrialSettings::trials, "", Accepts::between(1, 1000), {1, 20},
                "Trials per robot, each with a jitter of its own"),
      Parameter("jitter", &TrialSettings::jitter, "", Accepts::between(0, 0.5), {0, 0.01f},
                "Standard deviation by which the masses are displaced at the start, per shortest rest length")
          .with_form("0..0.5")
          .with_default_note("default 0.001; mercury run with one trial: 0"),
      Parameter("delay", &TrialSettings::delay, "s", Accepts::at_least_zero, {0, 100},
                "Start all trials but the first at random moments of the movement, up to this one"),
      Parameter("noise", &TrialSettings::noise, "", Accepts::at_least_zero, {0, 0.5f},
                "Standard deviation of stiffness and amplitude between trials")
          .with_form("0..1"),
      Parameter("damage", &TrialSettings::damage, "", Accepts::share_below_one(), {0, 0.5f},
                "Share of the voxels that are missing in a trial")
          .with_form("0..1"),
      Parameter("strain_limit", &TrialSettings::strain_limit, "",
                Accepts{.lowest = 0, .above_lowest = true, .or_infinite = true}, {0.1f, 4},
                "Robots with a spring strained more are overstretched: they rank after all sound ones")
          .with_default_note("default 2; inf = no limit"),
      Parameter("strained_limit", &TrialSettings::strained_limit, "", Accepts::between(0, 1), {0, 1},
                "Robots with real bodies are overstretched if more of their springs are strained by more than half")
          .with_form("0..1"),
      Parameter("inverted_limit", &TrialSettings::inverted_limit, "", Accepts::between(0, 1), {0, 1},
                "Robots with real bodies are overstretched if more of their body is inside out")
          .with_form("0..1"),
      Parameter("overlap_limit", &TrialSettings::overlap_limit, "", Accepts::between(0, 1), {0, 1},
                "Robots are overstretched if more of their masses are within other parts of the body")
          .with_form("0..1"),
      Parameter("least_masses", &TrialSettings::least_masses, "", Accepts::at_least_zero, {0, 100},
                "Network robots of fewer masses are too small: they rank after all sound ones")
          .with_form("N"),
      Parameter("median", &TrialSettings::median, "Take the median of the trials, not their mean"),
      Parameter("mean", &TrialSettings::mean, "Let the mean of the trials count, not their median"),
      Parameter("target_radius", &TrialSettings::target_radius, "m", Accepts::at_least_zero, {0, 5},
                "Start each trial this far from the target, in a random direction; 0 = where the robot's file has it"),
      Parameter("target_spread", &TrialSettings::target_spread, "", Accepts::between(0, 1), {0, 1},
                "Start nearer by up to this share of the radius, at random")
          .with_form("0..1"),
      Parameter("target_sphere", &TrialSettings::target_sphere,
                "Start anywhere around the target, also above and below"),
      Parameter("turned", &TrialSettings::turned, "Start each trial turned about the vertical, by a random angle"),
      Parameter("noise_per_trial", &TrialSettings::noise_per_trial, "Give senses other noise in each trial"),
      Parameter("folding", &TrialSettings::folding,
                "Measure how the body is folded, inverted and overlap, as these two limits do"),
      Parameter("upright", &TrialSettings::upright, "Measure how upright the body is, as an objective of it does"),
      Parameter("racing", &TrialSettings::racing, "Stop robots early that are clearly behind")};
};

// Throws ParameterError for settings out of range. A trial of 0 s is accepted.
void validate(const TrialSettings& settings);

// The usual jitter of several trials.
inline constexpr double usual_jitter = 1e-3;
// The robot as it is, with the usual limits: that the 99th percentile of the strain of a real body is 0.5, that no part
// of it is inside out, and that a body is more than a few springs.
constexpr TrialSettings one_trial() {
  return {.delay = 0,
          .strained_limit = 0.01,
          .inverted_limit = 0,
          .least_masses = 24,
          .median = true,
          .noise_per_trial = true};
}
// What searches use: three trials with jitter, whose median counts.
constexpr TrialSettings search_trials() {
  TrialSettings settings = one_trial();
  settings.trials = 3;
  settings.jitter = usual_jitter;
  return settings;
}

// Between two samples of a trial. Paths, work and strains depend on it [s].
inline constexpr double trial_sample_period = 0.05;

// EvaluationRequest::folding of all robots.
MeasuredFolding measure_all_folding(const Robot& robot);

// What an Evaluator does for the trials of robots. Robots come from trial_source(), or each is one trial of the
// settings: the first.
EvaluationRequest trial_request(const TrialSettings& settings, const Configuration& configuration,
                                std::uint64_t seed = 1);

// The trials of robots: all of robot 0, then all of robot 1, ... Each robot is taken from its source once. Throws what
// the source throws for each trial of that robot.
RobotSource trial_source(RobotSource robots, const TrialSettings& settings, std::uint64_t seed);

// The displacement with which a trial begins: a normal deviate per coordinate, times `jitter` and the robot's shortest
// rest length. Fixed points stay. `index` of a trial is as trial_source() counts them.
void add_jitter(const Robot& robot, const TrialSettings& settings, std::uint64_t seed, std::size_t trial,
                std::span<Vec3> positions);

// Where the masses are at the start of a trial, from where they are at rest: turned, put around the target, and with
// jitter, as the settings say. With ground, the robot is set down afterward.
void begin_trial(const Robot& robot, const TrialSettings& settings, const Environment& environment, std::uint64_t seed,
                 std::size_t trial, std::span<Vec3> positions);
// Whether begin_trial() changes anything.
bool begins_elsewhere(const TrialSettings& settings);

// What a robot must keep to be sound: no more of a quantity than a parameter of the trials says, or no less.
struct Limit {
  std::string_view quantity;  // quantity.h
  double TrialSettings::*value = nullptr;
  bool is_least = false;
  Fate fate = Fate::overstretched;                // of a robot that breaks it
  bool (*applies)(const Robot& robot) = nullptr;  // null = to all robots
};
std::span<const Limit> limits();

// How that trial ended: `evaluation` is its result.
Fate fate_of(const Evaluation& evaluation, const EvaluationRequest& request, const TrialSettings& settings);
// By how much the limits were broken in that trial: 0 for a robot that keeps them; else the sum of what each was
// exceeded by, as a share of the limit; infinite for a robot that exploded or failed.
double violation_of(const Evaluation& evaluation, const EvaluationRequest& request, const TrialSettings& settings);

}  // namespace mercury
