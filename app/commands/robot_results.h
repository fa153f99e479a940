// SPDX-License-Identifier: Apache-2.0
// What became of each robot in a trial, as lines of CSV and objects of JSON: the results of `mercury run`, and the
// candidates of `mercury new --best-of`.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>

#include "mercury/assessor.h"
#include "mercury/evaluator.h"
#include "mercury/generator.h"
#include "mercury/robot.h"
#include "mercury/vec3.h"

namespace mercury {

// Which robot it is. Names may repeat; the index does not, nor do file and request.
struct RobotIdentity {
  std::size_t index = 0;  // in the command's order
  std::string name;
  std::string file;    // that it was read from; empty = a random robot
  std::string random;  // what makes this robot alone with --random: "voxel:1:7:42"; empty = from a file
};

// The `index`-th robot of a request, which is the robot `place` of the command.
RobotIdentity identity_of(const RandomRobots& request, std::uint64_t index, std::size_t place);

// Figures of several trials are medians, places coordinate by coordinate. A figure that means nothing is NaN: all of a
// robot that could not be stepped, and those of an exploded robot that depend on how far it got.
struct RobotResult {
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();
  static constexpr Vec3 nowhere{std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::quiet_NaN(),
                                std::numeric_limits<float>::quiet_NaN()};

  RobotIdentity identity;
  Fate fate = Fate::failed;
  std::string failure;                  // why it could not be made or stepped
  std::size_t masses = 0, springs = 0;  // 0 if it failed
  Physics physics = Physics::paper;     // that the robot was made for
  int trials = 1;
  double distance = none;                               // distance_between() start and end [m]
  double lower_quartile = none, upper_quartile = none;  // of the trials' distances, if there are several [m]
  Vec3 start = nowhere, end = nowhere;                  // center of mass after settling and at the end [m]
  double mean_speed = none;                             // length of its path per time of the trial [m/s]
  double cruise_speed = none, cruise_lengths = none;    // after the first third of the trial [m/s], [body lengths/s]
  double steady = none;                                 // 1 = the last two thirds agree, 0 = they do not
  double work = none, positive_work = none, absolute_work = none;  // of the muscles [J]
  double highest = none;                                           // largest z of the center of mass [m]
  double largest_strain = none;                                    // over all samples [1]
  double strained_share = none;              // largest Telemetry::strained_share of all samples [1]
  double inverted = none, overlap = none;    // largest of Telemetry of all samples, if measured [1]
  double upright = none;                     // mean of Telemetry::upright, if measured [1]
  double reached = none;                     // share of the trials that reached the target, of robots that may [1]
  double exploded_at = none;                 // [s], if it exploded
  std::uint32_t culprit_spring = no_spring;  // if it exploded
  std::uint64_t hash = 0;                    // of the final positions and velocities, of all trials

  bool exploded() const { return fate == Fate::exploded; }
  bool was_stepped() const { return fate != Fate::failed; }
};

// Of the trials of a robot, one or more.
RobotResult result_of(RobotIdentity identity, std::span<const Evaluation> trials, const EvaluationRequest& request,
                      const TrialSettings& settings);

// A column of the CSV and, under the same name, a member of each JSON object.
struct ResultColumn {
  std::string_view name, unit, help;
};
std::span<const ResultColumn> result_columns();

std::string csv_heading();                                 // the names of all columns, and the end of the line
std::string csv_line(const RobotResult& robot);            // values that mean nothing are empty
nlohmann::ordered_json json_of(const RobotResult& robot);  // values that mean nothing are null

}  // namespace mercury
