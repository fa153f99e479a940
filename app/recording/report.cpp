// SPDX-License-Identifier: Apache-2.0
#include "app/recording/report.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "app/base/progress.h"
#include "app/base/version.h"
#include "app/recording/configuration_json.h"

namespace mercury {
namespace {

std::string hash_text(std::uint64_t hash) { return fmt::format("{:016x}", hash); }

std::string csv_number(double value) { return std::isfinite(value) ? fmt::format("{}", value) : ""; }

nlohmann::ordered_json json_of(const RobotResult& robot) {
  nlohmann::ordered_json json{{"name", robot.name},
                              {"masses", robot.masses},
                              {"springs", robot.springs},
                              {"displacement", robot.displacement},
                              {"mean_speed", robot.mean_speed},
                              {"largest_strain", robot.largest_strain},
                              {"strained_share", robot.strained_share},
                              {"exploded", robot.exploded},
                              {"hash", hash_text(robot.hash)}};
  if (robot.exploded) {
    json["exploded_at"] = robot.exploded_at;
    json["first_bad_spring"] =
        robot.culprit_spring == no_spring ? nlohmann::ordered_json() : nlohmann::ordered_json(robot.culprit_spring);
  }
  return json;
}

std::string state_of(const RobotResult& robot) {
  if (!robot.exploded) return "ok";
  std::string text = fmt::format("exploded at {:.3g} s", robot.exploded_at);
  if (robot.culprit_spring != no_spring) text += fmt::format(", spring {}", robot.culprit_spring);
  return text;
}

}  // namespace

std::size_t RunReport::springs() const {
  std::size_t sum = 0;
  for (const RobotResult& robot : robots) sum += robot.springs;
  return sum;
}

double RunReport::springs_per_second() const {
  return wall_seconds > 0 ? static_cast<double>(springs()) * static_cast<double>(steps) / wall_seconds : 0;
}

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char letter : text) quoted += letter == '"' ? std::string("\"\"") : std::string(1, letter);
  return quoted + "\"";
}

std::string table_of(const RunReport& report) {
  const Configuration& configuration = report.configuration;
  std::size_t width = 5;
  for (const RobotResult& robot : report.robots) width = std::max(width, robot.name.size());
  std::string text = fmt::format("{}, {}, {} solver, dt {} s, {} steps = {:.6g} s\n\n", report.device,
                                 name_of(configuration.environment), name_of(configuration.solver), configuration.dt,
                                 report.steps, report.seconds);
  text += fmt::format("{:<{}}  {:>7}  {:>8}  {:>9}  {:>11}  {:>10}  {:>8}  {:<16}  {}\n", "robot", width, "masses",
                      "springs", "moved [m]", "speed [m/s]", "strain [%]", "> 50 [%]", "hash", "state");
  for (const RobotResult& robot : report.robots)
    text += fmt::format("{:<{}}  {:>7}  {:>8}  {:>9.4f}  {:>11.4f}  {:>10.2f}  {:>8.2f}  {}  {}\n", robot.name, width,
                        robot.masses, robot.springs, robot.displacement, robot.mean_speed, 100 * robot.largest_strain,
                        100 * robot.strained_share, hash_text(robot.hash), state_of(robot));
  text += fmt::format("\n{} robot{}, {} springs, {:.3g} s of wall time, {} springs/s\n", report.robots.size(),
                      report.robots.size() == 1 ? "" : "s", report.springs(), report.wall_seconds,
                      with_magnitude(report.springs_per_second()));
  return text;
}

std::string csv_of(const RunReport& report) {
  std::string text =
      "name,masses,springs,displacement,mean_speed,largest_strain,strained_share,exploded,exploded_at,"
      "first_bad_spring,hash\n";  // columns
  for (const RobotResult& robot : report.robots)
    text += fmt::format("{},{},{},{},{},{},{},{},{},{},{}\n", csv_field(robot.name), robot.masses, robot.springs,
                        csv_number(robot.displacement), csv_number(robot.mean_speed), csv_number(robot.largest_strain),
                        csv_number(robot.strained_share), robot.exploded,
                        robot.exploded ? csv_number(robot.exploded_at) : "",
                        robot.exploded && robot.culprit_spring != no_spring ? fmt::to_string(robot.culprit_spring) : "",
                        hash_text(robot.hash));
  return text;
}

std::string json_of(const RunReport& report) {
  nlohmann::ordered_json json{{"program", program_version},
                              {"configuration", json_of(report.configuration)},
                              {"device", report.device},
                              {"steps", report.steps},
                              {"seconds", report.seconds},
                              {"interrupted", report.interrupted},
                              {"wall_seconds", report.wall_seconds},
                              {"springs_per_second", report.springs_per_second()},
                              {"notes", report.notes},
                              {"robots", nlohmann::ordered_json::array()}};
  for (const RobotResult& robot : report.robots) json["robots"].push_back(json_of(robot));
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace mercury
