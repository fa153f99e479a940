// SPDX-License-Identifier: Apache-2.0
#include "app/options/result_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "app/base/interrupt.h"
#include "app/base/messages.h"
#include "app/base/progress.h"
#include "app/base/stepping.h"
#include "app/recording/configuration_json.h"
#include "mercury/error.h"
#include "mercury/number_text.h"
#include "mercury/real_body.h"
#include "mercury/robot_file.h"

namespace mercury {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string text_of(const Json& row, const char* member) {
  const auto found = row.find(member);
  return found != row.end() && found->is_string() ? found->get<std::string>() : "";
}

// A number of steps, masses or trials.
std::int64_t count_of(const Json& object, const char* member, const std::string& place) {
  const Json& value = object.at(member);
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() > std::uint64_t{1} << 62)
    throw InputError(fmt::format("{}/{}", place, member), "give a whole number of 0 or more");
  return value.get<std::int64_t>();
}

RobotOfResult robot_of(const Json& row, const std::string& place) {
  RobotOfResult robot{.place = place,
                      .name = text_of(row, "name"),
                      .file = text_of(row, "file"),
                      .random = text_of(row, "random"),
                      .masses = static_cast<std::size_t>(count_of(row, "masses", place)),
                      .springs = static_cast<std::size_t>(count_of(row, "springs", place)),
                      .physics = text_of(row, "physics")};
  const std::string hash = text_of(row, "hash");
  const auto number = parse_number<std::uint64_t>(hash, 16);
  if (!number)
    throw InputError(place + "/hash", fmt::format("\"{}\" is not accepted; give 16 hexadecimal digits", hash));
  robot.hash = *number;
  if (robot.file.empty() == robot.random.empty())
    throw InputError(place, "give either file or random, as mercury run --json does");
  return robot;
}

RunResult result_of(const Json& json) {
  RunResult result{.program = text_of(json, "program"),
                   .device = text_of(json, "device"),
                   .configuration = configuration_from(json.at("configuration")),
                   .steps = count_of(json, "steps", ""),
                   .seconds = json.at("seconds").get<double>(),
                   .trials = json.contains("trials") ? count_of(json, "trials", "") : 1,
                   .jitter = json.value("jitter", 0.0)};
  if (!(result.seconds >= 0 && result.seconds < 1e15)) throw InputError("/seconds", "give a time of 0 or more");
  const Json& rows = json.at("robots");
  if (!rows.is_array()) throw InputError("/robots", "give a list");
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (!rows[i].value("masses", Json()).is_null())
      result.robots.push_back(robot_of(rows[i], fmt::format("/robots/{}", i)));
  if (result.robots.empty()) throw InputError("/robots", "names no robot that was stepped");
  return result;
}

// Where the command runs, or beside the result.
fs::path file_of(const RunResult& result, const RobotOfResult& robot) {
  const fs::path given = robot.file;
  if (fs::exists(given)) return given;
  if (const fs::path beside = result.path.parent_path() / given; given.is_relative() && fs::exists(beside))
    return beside;
  throw InputError(
      robot.place + "/file",
      fmt::format("{} is not there; a result names its robots, so keep their files where they were", robot.file));
}

// Throws InputError for another robot than that of the result.
void require_same(const RobotOfResult& wanted, const Robot& robot) {
  if (const std::string_view physics = name_of(physics_of(robot)); !wanted.physics.empty() && physics != wanted.physics)
    throw InputError(wanted.place + "/physics",
                     fmt::format("the result has {} bodies, {} has {} ones; give --physics {}", wanted.physics,
                                 robot.name, physics, wanted.physics));
  if (robot.masses.size() != wanted.masses || robot.springs.size() != wanted.springs)
    throw InputError(
        wanted.place,
        fmt::format("{} has {} masses and {} springs, in the result {} and {}; {}", robot.name, robot.masses.size(),
                    robot.springs.size(), wanted.masses, wanted.springs,
                    wanted.random.empty() ? "its file has changed" : "give the options of its kind that made it"));
}

}  // namespace

bool is_result(const fs::path& path) {
  if (extension_of(path) != ".json" || !fs::is_regular_file(path)) return false;
  constexpr std::size_t first_members = 4096;
  std::ifstream file(path, std::ios::binary);
  std::string begin(first_members, '\0');
  file.read(begin.data(), static_cast<std::streamsize>(begin.size()));
  begin.resize(static_cast<std::size_t>(file.gcount()));
  return begin.find("\"configuration\"") != std::string::npos && begin.find("\"format\":") == std::string::npos;
}

RunResult read_result(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError(path.string(), std::strerror(errno));
  try {
    RunResult result = result_of(Json::parse(file));
    result.path = path;
    return result;
  } catch (const Json::exception&) {
    throw InputError(path.string(),
                     "is not a result of mercury run --json, with configuration, steps, seconds and robots");
  } catch (const InputError& error) {
    throw InputError(path.string(), error.what());
  }
}

std::vector<std::shared_ptr<const Robot>> robots_of(const RunResult& result, const RobotOptions& options) {
  std::map<fs::path, std::vector<Robot>> files;  // one may have several robots
  std::vector<std::shared_ptr<const Robot>> robots;
  for (const RobotOfResult& wanted : result.robots) try {
      Robot robot;
      if (wanted.file.empty()) {
        robot = options.random_robot(wanted.random);
      } else {
        const auto [entry, is_new] = files.try_emplace(file_of(result, wanted));
        if (is_new) entry->second = options.robots_in(entry->first);
        const auto found = std::ranges::find(entry->second, wanted.name, &Robot::name);
        if (found == entry->second.end())
          throw InputError(wanted.place, fmt::format("{} has no robot {}", wanted.file, wanted.name));
        robot = *found;
      }
      require_same(wanted, robot);
      robots.push_back(std::make_shared<const Robot>(std::move(robot)));
    } catch (const InputError& error) {
      throw InputError(result.path.string(), error.what());
    }
  return robots;
}

bool check_again(const RunResult& result, const std::vector<std::shared_ptr<const Robot>>& robots,
                 const Device& device) {
  const std::string name = result.path.string();
  if (result.trials > 1 || result.jitter > 0) {
    say(fmt::format("{}: {} trials with jitter {:g}; here robots begin without jitter, and are not compared", name,
                    result.trials, result.jitter));
    return true;
  }
  Configuration configuration = result.configuration;
  configuration.device = device;
  const bool on_cpu = result.device.starts_with("CPU");
  if (on_cpu && device.kind == DeviceKind::automatic) configuration.device.kind = DeviceKind::cpu;
  Simulation simulation(configuration, robots, shown_work());
  if (simulation.device_name().starts_with("CPU") != on_cpu) {
    say(fmt::format("{}: from {}, whose bits are not those of {}; not compared", name, result.device,
                    simulation.device_name()));
    return true;
  }
  Stepper stepper(simulation);
  Progress progress("comparing", "steps", result.steps);
  if (!stepper.advance_to(result.steps)) throw Interrupted();
  const std::vector<std::uint64_t> hashes = simulation.hashes();
  std::size_t same = 0, first = robots.size();
  for (std::size_t i = 0; i < robots.size(); ++i) {
    same += hashes[i] == result.robots[i].hash;
    if (hashes[i] != result.robots[i].hash) first = std::min(first, i);
  }
  if (same == robots.size()) {
    say(fmt::format("{}: simulated again, all final states are those of the result, bit for bit", name));
    return true;
  }
  warn(
      fmt::format("{}: {} of {} robots end elsewhere than in the result, the first is {}: it began in another way "
                  "(--start, --resume), or was made by another version ({}) or from another file",
                  name, robots.size() - same, robots.size(), robots[first]->name, result.program));
  return false;
}

}  // namespace mercury
