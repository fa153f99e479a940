// SPDX-License-Identifier: Apache-2.0
#include "app/commands/robot_results.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <variant>

#include "app/base/output_files.h"
#include "app/recording/configuration_json.h"
#include "mercury/distance.h"
#include "mercury/fnv.h"
#include "mercury/number_text.h"
#include "mercury/quantity.h"
#include "mercury/real_body.h"
#include "mercury/spread.h"

namespace mercury {
namespace {

// Nothing, if the value means nothing.
using Cell = std::variant<std::monostate, bool, std::uint64_t, double, std::string>;

struct Column {
  ResultColumn column;
  Cell (*value)(const RobotResult& robot);
};

Cell text(const std::string& value) { return value.empty() ? Cell() : value; }
Cell number(double value) { return std::isfinite(value) ? value : Cell(); }
Cell number(float value) { return std::isfinite(value) ? shortest(value) : Cell(); }
Cell count(const RobotResult& robot, std::uint64_t value) { return robot.was_stepped() ? value : Cell(); }

template <double RobotResult::*figure>
Cell figure_of(const RobotResult& robot) {
  return number(robot.*figure);
}

template <Vec3 RobotResult::*place, float Vec3::*axis>
Cell place_of(const RobotResult& robot) {
  return number((robot.*place).*axis);
}

constexpr Column table[] = {
    {{"index", "", "in the order of the command line, from 0"},
     [](const RobotResult& robot) -> Cell { return std::uint64_t{robot.identity.index}; }},
    {{"name", "", "not necessarily unique"}, [](const RobotResult& robot) { return text(robot.identity.name); }},
    {{"file", "", "that the robot was read from"}, [](const RobotResult& robot) { return text(robot.identity.file); }},
    {{"random", "", "what makes a random robot alone: `--random` with this value and the same options of its kind"},
     [](const RobotResult& robot) { return text(robot.identity.random); }},
    {{"fate", "",
      "`sound`, `stopped` (early, by the user), `exploded`, `overstretched` (beyond `--strain-limit`), "
      "`too small`, `undefined` (the distance is not a finite number), `failed` (it could not be made)"},
     [](const RobotResult& robot) { return text(std::string(name_of(robot.fate))); }},
    {{"failure", "", "why it could not be made"}, [](const RobotResult& robot) { return text(robot.failure); }},
    {{"masses", "", "number of masses"}, [](const RobotResult& robot) { return count(robot, robot.masses); }},
    {{"springs", "", "number of springs"}, [](const RobotResult& robot) { return count(robot, robot.springs); }},
    {{"physics", "", "that the robot was made for: `paper` or `real` ([physics.md](physics.md#real-bodies))"},
     [](const RobotResult& robot) { return robot.was_stepped() ? text(std::string(name_of(robot.physics))) : Cell(); }},
    {{"distance", "m", "of the center of mass from start to end; on land along the ground"},
     figure_of<&RobotResult::distance>},
    {{"trials", "", "of the robot; figures of several are medians"},
     [](const RobotResult& robot) -> Cell { return count(robot, static_cast<std::uint64_t>(robot.trials)); }},
    {{"lower_quartile", "m", "of the distances of several trials"}, figure_of<&RobotResult::lower_quartile>},
    {{"upper_quartile", "m", ""}, figure_of<&RobotResult::upper_quartile>},
    {{"start_x", "m", "center of mass at the start, after `--settle`"}, place_of<&RobotResult::start, &Vec3::x>},
    {{"start_y", "m", ""}, place_of<&RobotResult::start, &Vec3::y>},
    {{"start_z", "m", ""}, place_of<&RobotResult::start, &Vec3::z>},
    {{"end_x", "m", "center of mass at the end"}, place_of<&RobotResult::end, &Vec3::x>},
    {{"end_y", "m", ""}, place_of<&RobotResult::end, &Vec3::y>},
    {{"end_z", "m", ""}, place_of<&RobotResult::end, &Vec3::z>},
    {{"mean_speed", "m/s", "length of the path of the center of mass, from sample to sample, per time"},
     figure_of<&RobotResult::mean_speed>},
    {{"cruise_speed", "m/s", "distance per time after the first third of the trial"},
     figure_of<&RobotResult::cruise_speed>},
    {{"cruise_lengths", "1/s", "the same in body lengths: per longest side of the box around the body at rest"},
     figure_of<&RobotResult::cruise_lengths>},
    {{"steady", "", "`true` if the speeds in the second and the last third agree within 20 %"},
     [](const RobotResult& robot) { return std::isnan(robot.steady) ? Cell() : Cell(robot.steady > 0.5); }},
    {{"work", "J", "that the muscles did, less what they took back"}, figure_of<&RobotResult::work>},
    {{"positive_work", "J", "that the muscles did while their power was positive"},
     figure_of<&RobotResult::positive_work>},
    {{"absolute_work", "J", "`positive_work` and what the muscles took back"}, figure_of<&RobotResult::absolute_work>},
    {{"highest", "m", "largest z of the center of mass"}, figure_of<&RobotResult::highest>},
    {{"largest_strain", "1", "largest strain of any spring"}, figure_of<&RobotResult::largest_strain>},
    {{"strained_share", "1", "share of the springs above 50 % strain, in the sample that has most of them"},
     figure_of<&RobotResult::strained_share>},
    {{"inverted", "1", "largest share of the body that was inside out; measured with `--folding`"},
     figure_of<&RobotResult::inverted>},
    {{"overlap", "1", "largest share of the masses that were within other parts of the body; the same"},
     figure_of<&RobotResult::overlap>},
    {{"upright", "1",
      "cosine between the body's up axis and the vertical, mean over the time; measured with `--upright`"},
     figure_of<&RobotResult::upright>},
    {{"reached", "1",
      "share of the trials in which the center of mass came within `--reach` of the target; of robots that sense it, "
      "and "
      "of all where the options name a target"},
     figure_of<&RobotResult::reached>},
    {{"exploded", "", "`true` or `false`"},
     [](const RobotResult& robot) { return robot.was_stepped() ? robot.exploded() : Cell(); }},
    {{"exploded_at", "s", "time of the explosion, settling included"}, figure_of<&RobotResult::exploded_at>},
    {{"first_bad_spring", "", "the culprit spring of the explosion, if one is known"},
     [](const RobotResult& robot) {
       return robot.culprit_spring == no_spring ? Cell() : std::uint64_t{robot.culprit_spring};
     }},
    {{"hash", "", "of the final positions and velocities ([physics.md](physics.md#reproducibility))"},
     [](const RobotResult& robot) { return robot.was_stepped() ? fmt::format("{:016x}", robot.hash) : Cell(); }},
};

std::string csv_text(const Cell& cell) {
  return std::visit(
      [](const auto& value) -> std::string {
        using Value = std::decay_t<decltype(value)>;
        if constexpr (std::is_same_v<Value, std::monostate>)
          return "";
        else if constexpr (std::is_same_v<Value, double>)
          return csv_number(value);
        else
          return csv_field(fmt::format("{}", value));
      },
      cell);
}

nlohmann::ordered_json json_value(const Cell& cell) {
  return std::visit(
      [](const auto& value) -> nlohmann::ordered_json {
        if constexpr (std::is_same_v<std::decay_t<decltype(value)>, std::monostate>)
          return nullptr;
        else
          return value;
      },
      cell);
}

}  // namespace

RobotIdentity identity_of(const RandomRobots& request, std::uint64_t index, std::size_t place) {
  return {.index = place,
          .name = fmt::format("{}-{}-{}", request.kind, request.seed, index),
          .random = fmt::format("{}:1:{}:{}", request.kind, request.seed, index)};
}

namespace {

double quantity(std::string_view name, const Evaluation& evaluation, const Configuration& configuration) {
  return quantities()[find_quantity(name).value()].value(
      {.robot = *evaluation.robot, .evaluation = evaluation, .configuration = configuration});
}

bool has_target(const Robot& robot, const Environment& environment, const TrialSettings& settings) {
  constexpr Environment usual{};
  return settings.target_radius > 0 || environment.target != usual.target || environment.reach != usual.reach ||
         seeks_target(robot);
}

RobotResult result_of_trial(const Evaluation& evaluation, const EvaluationRequest& request,
                            const TrialSettings& settings) {
  RobotResult result{.fate = fate_of(evaluation, request, settings), .failure = evaluation.failure};
  if (!result.was_stepped()) return result;
  const Configuration& configuration = request.configuration;
  const Telemetry &start = evaluation.start, &end = evaluation.end;
  result.identity.name = evaluation.robot->name;
  result.masses = evaluation.robot->masses.size();
  result.springs = evaluation.robot->springs.size();
  result.physics = physics_of(*evaluation.robot);
  result.hash = evaluation.hash;
  if (!start.exploded) result.start = start.center_of_mass;
  if (end.exploded) {
    result.exploded_at = end.exploded_at;
    result.culprit_spring = end.culprit_spring;
    return result;
  }
  const double seconds = static_cast<double>(evaluation.steps) * configuration.dt;
  result.end = end.center_of_mass;
  result.distance = distance_between(start.center_of_mass, end.center_of_mass, configuration.environment);
  if (result.fate == Fate::sound && !std::isfinite(result.distance)) result.fate = Fate::undefined;
  result.mean_speed = seconds > 0 ? evaluation.path / seconds : 0;
  result.cruise_speed = quantity("cruise_speed", evaluation, configuration);
  result.cruise_lengths = quantity("cruise_lengths", evaluation, configuration);
  result.steady = quantity("steady", evaluation, configuration);
  result.work = evaluation.work;
  result.positive_work = evaluation.positive_work;
  result.absolute_work = evaluation.absolute_work();
  result.highest = evaluation.highest;
  result.largest_strain = evaluation.largest_strain;
  result.strained_share = evaluation.strained_share;
  result.inverted = evaluation.inverted;
  result.overlap = evaluation.overlap;
  result.upright = evaluation.upright;
  if (has_target(*evaluation.robot, configuration.environment, settings))
    result.reached = quantity("reached", evaluation, configuration);
  return result;
}

void take_medians(RobotResult& result, std::span<const RobotResult> trials) {
  const auto median = [&](const auto& value) {
    std::vector<double> values;
    for (const RobotResult& trial : trials) values.push_back(static_cast<double>(value(trial)));
    return median_of(std::move(values));
  };
  for (double RobotResult::*figure :
       {&RobotResult::distance, &RobotResult::mean_speed, &RobotResult::cruise_speed, &RobotResult::cruise_lengths,
        &RobotResult::work, &RobotResult::positive_work, &RobotResult::absolute_work, &RobotResult::highest,
        &RobotResult::largest_strain, &RobotResult::strained_share, &RobotResult::inverted, &RobotResult::overlap,
        &RobotResult::upright})
    result.*figure = median([&](const RobotResult& trial) { return trial.*figure; });
  for (Vec3 RobotResult::*place : {&RobotResult::start, &RobotResult::end})
    for (float Vec3::*axis : {&Vec3::x, &Vec3::y, &Vec3::z})
      result.*place.*axis = static_cast<float>(median([&](const RobotResult& trial) { return trial.*place.*axis; }));
  std::vector<double> reached;
  for (const RobotResult& trial : trials) reached.push_back(trial.reached);
  result.reached = mean_and_error(reached).median;
  result.steady = median([](const RobotResult& trial) { return trial.steady; }) > 0.5 ? 1 : 0;
  std::vector<double> distances;
  for (const RobotResult& trial : trials) distances.push_back(trial.distance);
  const Spread spread = spread_of(std::move(distances));
  result.lower_quartile = spread.lower_quartile;
  result.upper_quartile = spread.upper_quartile;
}

}  // namespace

RobotResult result_of(RobotIdentity identity, std::span<const Evaluation> trials, const EvaluationRequest& request,
                      const TrialSettings& settings) {
  std::vector<RobotResult> results;
  for (const Evaluation& trial : trials) results.push_back(result_of_trial(trial, request, settings));
  const auto is_worse = [](const RobotResult& a, const RobotResult& b) {
    return a.fate != b.fate && worse(a.fate, b.fate) == b.fate;
  };
  // The worst one says what happened.
  RobotResult result = *std::ranges::max_element(results, is_worse);
  if (results.size() > 1) {
    Fnv1a hash;
    for (const RobotResult& trial : results) hash.add(trial.hash);
    result.hash = hash.value();
    result.trials = static_cast<int>(results.size());
    if (result.was_stepped() && !result.exploded()) take_medians(result, results);
  }
  identity.name = result.was_stepped() ? result.identity.name : identity.name;
  result.identity = std::move(identity);
  return result;
}

std::span<const ResultColumn> result_columns() {
  static const auto columns = [] {
    std::array<ResultColumn, std::size(table)> found;
    for (std::size_t i = 0; i < found.size(); ++i) found[i] = table[i].column;
    return found;
  }();
  return columns;
}

std::string csv_heading() {
  std::string line;
  for (const ResultColumn& column : result_columns()) line.append(line.empty() ? "" : ",").append(column.name);
  return line + "\n";
}

std::string csv_line(const RobotResult& robot) {
  std::string line;
  for (const Column& column : table) {
    if (&column != table) line += ',';
    line += csv_text(column.value(robot));
  }
  return line + "\n";
}

nlohmann::ordered_json json_of(const RobotResult& robot) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const auto& [column, value] : table) json[std::string(column.name)] = json_value(value(robot));
  return json;
}

}  // namespace mercury
