// SPDX-License-Identifier: Apache-2.0
#include "app/commands/run_report.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>

#include "app/base/messages.h"
#include "app/base/progress.h"
#include "app/base/version.h"
#include "app/recording/configuration_json.h"
#include "mercury/parallel.h"

namespace mercury {
namespace {

constexpr std::size_t longest_label = 80;

// What the table calls each robot: its name, with its file where another robot has the same name.
std::vector<std::string> labels_of(const std::vector<RobotResult>& robots) {
  std::map<std::string_view, int> uses;
  for (const RobotResult& robot : robots) ++uses[robot.identity.name];
  std::vector<std::string> labels;
  for (const RobotResult& robot : robots) {
    const auto& [index, name, file, random] = robot.identity;
    labels.push_back(
        printable(uses[name] > 1 && !file.empty() ? fmt::format("{} ({})", name, file) : name, longest_label));
  }
  return labels;
}

std::string figure(double value, int width, int digits) {
  return std::isfinite(value) ? fmt::format("{:>{}.{}f}", value, width, digits) : fmt::format("{:>{}}", "-", width);
}

std::string state_of(const RobotResult& robot) {
  if (!robot.was_stepped()) return "left out: " + robot.failure;
  if (!robot.exploded()) return robot.fate == Fate::sound ? "ok" : std::string(name_of(robot.fate));
  std::string text = fmt::format("exploded at {:.3g} s", robot.exploded_at);
  if (robot.culprit_spring != no_spring) text += fmt::format(", spring {}", robot.culprit_spring);
  return text;
}

std::string row_of(const RobotResult& robot, const std::string& label, std::size_t width, bool has_quartiles,
                   bool has_folding, bool has_upright, bool has_target) {
  const auto count = [&](std::size_t number) { return robot.was_stepped() ? fmt::to_string(number) : "-"; };
  const std::string quartiles =
      !has_quartiles ? ""
      : std::isfinite(robot.lower_quartile)
          ? fmt::format("{:>19}", fmt::format("{:.4f} to {:.4f}", robot.lower_quartile, robot.upper_quartile)) + "  "
          : fmt::format("{:>19}  ", "-");
  return fmt::format(
      "{:>5}  {:<{}}  {:>6}  {:>7}  {}  {}{}  {}{}  {}  {}  {}  {}  {}{}{}{:<16}  {}\n", robot.identity.index, label,
      width, count(robot.masses), count(robot.springs), figure(robot.distance, 12, 4), quartiles,
      figure(robot.mean_speed, 11, 4), figure(robot.cruise_speed, 12, 4), robot.steady == 0 ? "~" : " ",
      figure(robot.work, 9, 3), figure(robot.highest, 11, 3), figure(100 * robot.largest_strain, 10, 2),
      figure(100 * robot.strained_share, 8, 2),
      has_folding ? fmt::format("{}  {}  ", figure(100 * robot.inverted, 12, 2), figure(100 * robot.overlap, 11, 2))
                  : "",
      has_upright ? figure(robot.upright, 7, 3) + "  " : "",
      has_target ? figure(100 * robot.reached, 11, 1) + "  " : "",
      robot.was_stepped() ? fmt::format("{:016x}", robot.hash) : "-", state_of(robot));
}

// What `make` makes of each robot of the report, by its number: in order, on all cores.
template <class Make>
auto for_all_robots(const RunReport& report, const Make& make) {
  std::vector<decltype(make(std::size_t{}))> made(report.robots.size());
  parallel_for(0, made.size(), [&](std::size_t i) { made[i] = make(i); });
  return made;
}

}  // namespace

std::size_t RunReport::count(Fate fate) const {
  return static_cast<std::size_t>(std::ranges::count(robots, fate, &RobotResult::fate));
}

std::size_t RunReport::springs() const {
  std::size_t sum = 0;
  for (const RobotResult& robot : robots) sum += robot.springs;
  return sum;
}

double RunReport::springs_per_second() const {
  return wall_seconds > 0 ? static_cast<double>(springs()) * static_cast<double>(steps - resumed) / wall_seconds : 0;
}

std::string table_of(const RunReport& report) {
  const Configuration& configuration = report.configuration;
  const std::vector<std::string> labels = labels_of(report.robots);
  const bool has_quartiles = report.trials > 1;
  const bool has_folding =
      std::ranges::any_of(report.robots, [](const RobotResult& robot) { return std::isfinite(robot.inverted); });
  const bool has_upright =
      std::ranges::any_of(report.robots, [](const RobotResult& robot) { return std::isfinite(robot.upright); });
  const bool has_target =
      std::ranges::any_of(report.robots, [](const RobotResult& robot) { return std::isfinite(robot.reached); });
  std::size_t width = 5;
  for (const std::string& label : labels) width = std::max(width, label.size());
  const auto stepped_robot = std::ranges::find_if(report.robots, &RobotResult::was_stepped);
  const std::string physics = stepped_robot == report.robots.end()
                                  ? ""
                                  : fmt::format(", {} physics", name_of(stepped_robot->physics));  // all have the same
  std::string text = fmt::format("{}, {}{}, {} solver, dt {} s, {} steps = {:.6g} s", report.device,
                                 name_of(configuration.environment), physics, name_of(configuration.solver),
                                 configuration.dt, report.steps, report.seconds);
  if (report.settle > 0) text += fmt::format(", measured after {:.6g} s", report.settle);
  if (has_quartiles) text += fmt::format(", medians of {} trials", report.trials);
  if (report.jitter > 0) text += fmt::format(", jitter {:g} of the shortest rest length", report.jitter);
  text += fmt::format(
      "\n\n{:>5}  {:<{}}  {:>6}  {:>7}  {:>12}  {}{:>11}  {:>12}   {:>9}  {:>11}  {:>10}  {:>8}  {}{}{}{:<16}  {}\n",
      "index", "robot", width, "masses", "springs", "distance [m]",
      has_quartiles ? fmt::format("{:>19}  ", "quartiles [m]") : "", "speed [m/s]", "cruise [m/s]", "work [J]",
      "highest [m]", "strain [%]", "> 50 [%]", has_folding ? "inverted [%]  overlap [%]  " : "",
      has_upright ? "upright  " : "", has_target ? "reached [%]  " : "", "hash", "state");
  for (const std::string& row : for_all_robots(report, [&](std::size_t i) {
         return row_of(report.robots[i], labels[i], width, has_quartiles, has_folding, has_upright, has_target);
       }))
    text += row;
  const std::size_t stepped = report.robots.size() - report.count(Fate::failed);
  text +=
      fmt::format("\n{} robot{}, {} springs, {:.3g} s of wall time, {} springs/s\n", stepped, stepped == 1 ? "" : "s",
                  report.springs(), report.wall_seconds, with_magnitude(report.springs_per_second()));
  if (std::ranges::any_of(report.robots, [](const RobotResult& robot) { return robot.steady == 0; }))
    text += "~ = not steady: the speeds in the second and the last third of the time differ by more than 20 %\n";
  if (report.count(Fate::exploded) > 0) text += "- = means nothing, since the robot exploded\n";
  return text;
}

std::string csv_of(const RunReport& report) {
  std::string text = csv_heading();
  for (const std::string& line : for_all_robots(report, [&](std::size_t i) { return csv_line(report.robots[i]); }))
    text += line;
  return text;
}

std::string json_of(const RunReport& report) {
  nlohmann::ordered_json json{{"program", program_version},
                              {"configuration", json_of(report.configuration)},
                              {"device", report.device},
                              {"steps", report.steps},
                              {"seconds", report.seconds},
                              {"settle", report.settle},
                              {"trials", report.trials},
                              {"jitter", report.jitter},
                              {"interrupted", report.interrupted},
                              {"wall_seconds", report.wall_seconds},
                              {"springs_per_second", report.springs_per_second()},
                              {"notes", report.notes}};
  json["robots"] = for_all_robots(report, [&](std::size_t i) { return json_of(report.robots[i]); });
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace mercury
