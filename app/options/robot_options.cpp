// SPDX-License-Identifier: Apache-2.0
#include "app/options/robot_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "app/options/option_values.h"
#include "app/recording/repro.h"
#include "app/recording/trajectory_layout.h"
#include "mercury/error.h"
#include "mercury/robot_file.h"

namespace mercury {
namespace {

constexpr std::size_t most_robots = 1'000'000;

std::vector<Robot> random_robots(const RobotOptions::RandomRobots& request) {
  if (request.kind == RobotOptions::RandomRobots::Kind::voxel)
    return random_voxel_robots(request.voxel, request.seed, request.count, request.first);
  std::vector<FailedRobot> failed;
  std::vector<Robot> robots = random_nn_robots(request.network, request.seed, request.count, request.first, &failed);
  if (robots.empty()) throw InputError("--random", "none could be grown: " + failed.front().reason);
  for (const FailedRobot& robot : failed)
    fmt::print(stderr, "mercury: nn-{}-{} was left out: {}\n", request.seed, robot.index, robot.reason);
  return robots;
}

}  // namespace

void RobotOptions::add_to(CLI::App& command) {
  command.add_option("ROBOTS", paths_, "Robot files (.json, .cbor) and folders of them")->type_name("PATH");
  command
      .add_option(
          "--random", random_,
          "So many random robots, of --seed or one of their own, from the first or another; may be given several times")
      ->allow_extra_args(false)
      ->type_name("voxel:N[:SEED[:FIRST]]|nn:...")
      ->group("Robots");
  add_number(command, "--seed", seed_, "Seed of the random robots (default 1)", "N")->group("Robots");
  voxel_.add_to(command);
  nn_.add_to(command);
}

// A file of a kind that is given without others.
std::optional<std::filesystem::path> RobotOptions::alone(bool (*is_such)(const std::filesystem::path&),
                                                         const char* why) const {
  const auto found = std::find_if(paths_.begin(), paths_.end(), [&](const auto& path) { return is_such(path); });
  if (found == paths_.end()) return std::nullopt;
  if (paths_.size() > 1 || !random_.empty()) throw InputError(*found, why);
  return *found;
}

std::optional<std::filesystem::path> RobotOptions::recording() const {
  return alone(is_trajectory_name, "a recording is played alone; give it without other robots");
}

std::optional<std::filesystem::path> RobotOptions::repro() const {
  return alone(is_repro_name, "a repro has a time of its own; give it without other robots");
}

std::vector<Robot> RobotOptions::load() const {
  if (empty()) throw InputError("no robots given; name files or folders, or use --random voxel:12 or nn:12");
  std::vector<Robot> robots = load_files();
  for (const RandomRobots& request : random()) {
    std::vector<Robot> more = random_robots(request);
    robots.insert(robots.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
  }
  return robots;
}

std::vector<Robot> RobotOptions::load_files() const {
  if (const auto file = recording())
    throw InputError(file->string(), "is a recording; mercury render plays it, here give robots");
  if (const auto file = repro())
    throw InputError(file->string(), "is a repro; mercury run and mercury view show it, here give robots");
  if (paths_.empty()) return {};
  return load_robots(files());
}

std::vector<RobotOptions::RandomRobots> RobotOptions::random() const {
  std::vector<RandomRobots> requests;
  for (const std::string& request : random_) requests.push_back(random_from(request));
  return requests;
}

RobotOptions::RandomRobots RobotOptions::random_from(const std::string& request) const {
  const std::vector<std::string_view> parts = split(request, ':');
  const std::string_view kind = parts.front();
  const auto number = [&](std::size_t place, std::uint64_t otherwise) {
    return place < parts.size() ? number_from<std::uint64_t>("--random", parts[place]) : otherwise;
  };
  RandomRobots robots{.count = number(1, 1), .seed = number(2, seed_), .first = number(3, 0)};
  if (robots.count < 1 || robots.count > most_robots)
    throw InputError("--random", fmt::format("\"{}\" is not accepted; give 1 to {} robots", request, most_robots));
  if (kind != "voxel" && kind != "nn")
    throw InputError("--random", fmt::format("\"{}\" is not a kind of robot; give voxel:N or nn:N", kind));
  if (parts.size() > 4)
    throw InputError("--random",
                     fmt::format("\"{}\" is not accepted; give KIND:N, KIND:N:SEED or KIND:N:SEED:FIRST", request));
  if (kind == "voxel")
    robots.voxel = voxel_.chosen();
  else
    robots.network = nn_.chosen();
  robots.kind = kind == "voxel" ? RandomRobots::Kind::voxel : RandomRobots::Kind::network;
  return robots;
}

}  // namespace mercury
