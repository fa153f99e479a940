// SPDX-License-Identifier: Apache-2.0
#include "app/commands/robot_results.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <utility>
#include <variant>

#include "app/base/csv.h"
#include "app/recording/configuration_json.h"
#include "mercury/distance.h"

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
      "`failed` (it could not be made)"},
     [](const RobotResult& robot) { return text(std::string(name_of(robot.fate))); }},
    {{"failure", "", "why it could not be made"}, [](const RobotResult& robot) { return text(robot.failure); }},
    {{"masses", "", "number of masses"}, [](const RobotResult& robot) { return count(robot, robot.masses); }},
    {{"springs", "", "number of springs"}, [](const RobotResult& robot) { return count(robot, robot.springs); }},
    {{"distance", "m", "of the center of mass from start to end; on land along the ground"},
     figure_of<&RobotResult::distance>},
    {{"start_x", "m", "center of mass at the start, after `--settle`"}, place_of<&RobotResult::start, &Vec3::x>},
    {{"start_y", "m", ""}, place_of<&RobotResult::start, &Vec3::y>},
    {{"start_z", "m", ""}, place_of<&RobotResult::start, &Vec3::z>},
    {{"end_x", "m", "center of mass at the end"}, place_of<&RobotResult::end, &Vec3::x>},
    {{"end_y", "m", ""}, place_of<&RobotResult::end, &Vec3::y>},
    {{"end_z", "m", ""}, place_of<&RobotResult::end, &Vec3::z>},
    {{"mean_speed", "m/s", "length of the path of the center of mass, from sample to sample, per time"},
     figure_of<&RobotResult::mean_speed>},
    {{"work", "J", "that the muscles did"}, figure_of<&RobotResult::work>},
    {{"highest", "m", "largest z of the center of mass"}, figure_of<&RobotResult::highest>},
    {{"largest_strain", "1", "largest strain of any spring"}, figure_of<&RobotResult::largest_strain>},
    {{"strained_share", "1", "share of the springs above 50 % strain, in the sample that has most of them"},
     figure_of<&RobotResult::strained_share>},
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

RobotResult result_of(RobotIdentity identity, const Evaluation& evaluation, const EvaluationRequest& request,
                      double strain_limit) {
  RobotResult result{.identity = std::move(identity),
                     .fate = fate_of(evaluation, request, strain_limit),
                     .failure = evaluation.failure};
  if (!result.was_stepped()) return result;
  const Configuration& configuration = request.configuration;
  const Telemetry &start = evaluation.start, &end = evaluation.end;
  result.identity.name = evaluation.robot->name;
  result.masses = evaluation.robot->masses.size();
  result.springs = evaluation.robot->springs.size();
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
  result.mean_speed = seconds > 0 ? evaluation.path / seconds : 0;
  result.work = evaluation.work;
  result.highest = evaluation.highest;
  result.largest_strain = evaluation.largest_strain;
  result.strained_share = evaluation.strained_share;
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
