// SPDX-License-Identifier: Apache-2.0
// Quantities of a robot's trial, each described once, as data. Objectives are formulas of them, the axes of a map of
// elites are two of them, and tables have a column for each.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mercury/configuration.h"
#include "mercury/evaluator.h"
#include "mercury/individual.h"
#include "mercury/robot.h"

namespace mercury {

// One robot after one trial.
struct Trial {
  const Robot& robot;
  const Evaluation& evaluation;  // its robot was stepped: no failure
  const Configuration& configuration;
  bool net_efficiency = false;  // efficiency is distance per work, as in runs of earlier versions
};

struct Quantity {
  std::string_view name;  // "distance": in formulas, options and tables
  std::string_view unit;  // "m"; empty = none
  std::string_view help;  // one line, without a full stop
  bool of_body = false;   // known from the robot alone, so it may be a descriptor of an unborn robot as well
  double usual_lowest = 0, usual_highest = 1;  // ends of an axis, unless the user gives others
  double (*value)(const Trial& trial) = nullptr;
  bool of_travel = false;   // it grows with how far the robot gets, so it means nothing where no robot can move itself
  bool of_folding = false;  // NaN unless EvaluationRequest::folding
  bool of_upright = false;  // NaN unless EvaluationRequest::upright
  bool is_share = false;    // 0 or 1 in a trial; of several trials, the mean is reported
};

// All quantities. Their order is that of Assessment::values.
std::span<const Quantity> quantities();
std::vector<std::string> names_of_quantities();

// Index in quantities(); nothing if there is none of that name.
std::optional<std::size_t> find_quantity(std::string_view name);

// Whether a quantity means something after trials that ended so. What an exploded robot measured does not, except of
// its body.
inline bool counts(const Quantity& quantity, Fate fate) {
  return quantity.of_body || (fate != Fate::exploded && fate != Fate::failed);
}

// Of the values of a quantity in several trials: the median, or the mean of a share.
double together(const Quantity& quantity, std::vector<double> values);

// The values of all quantities after one trial. `of_same_robot` = those after another trial of the same robot, if there
// are any: what its body alone says is taken from there.
std::vector<double> quantities_of(const Trial& trial, std::span<const double> of_same_robot = {});

}  // namespace mercury
