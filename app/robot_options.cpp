#include "app/robot_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "app/option_values.h"
#include "app/trajectory_layout.h"
#include "robots/file.h"
#include "sim/error.h"

namespace mercury {
namespace {

constexpr std::size_t most_robots = 1'000'000;

}  // namespace

void RobotOptions::add_to(CLI::App& command) {
  command.add_option("ROBOTS", paths_, "Robot files (.json, .cbor) and folders of them")->type_name("PATH");
  command.add_option("--random", random_, "So many random robots, of --seed or one of their own, from the first or another; may be given several times")
      ->allow_extra_args(false)
      ->type_name("voxel:N[:SEED[:FIRST]]|nn:...")
      ->group("Robots");
  add_number(command, "--seed", seed_, "Seed of the random robots (default 1)", "N")->group("Robots");
  voxel_.add_to(command);
  nn_.add_to(command);
}

std::optional<std::filesystem::path> RobotOptions::recording() const {
  const auto found = std::find_if(paths_.begin(), paths_.end(), [](const auto& path) { return is_trajectory_name(path); });
  if (found == paths_.end()) return std::nullopt;
  if (paths_.size() > 1 || !random_.empty())
    throw InputError(*found, "a recording is played alone; give it without other robots");
  return *found;
}

std::vector<Robot> RobotOptions::load() const {
  if (empty()) throw InputError("no robots given; name files or folders, or use --random voxel:12 or nn:12");
  std::vector<Robot> robots;
  if (const auto file = recording())
    throw InputError(file->string(), "is a recording; mercury render plays it, here give robots");
  if (!paths_.empty()) robots = load_robots(std::vector<std::filesystem::path>(paths_.begin(), paths_.end()));
  for (const std::string& request : random_) {
    std::vector<Robot> more = random_robots(request);
    robots.insert(robots.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
  }
  return robots;
}

std::vector<Robot> RobotOptions::random_robots(const std::string& request) const {
  const std::vector<std::string_view> parts = split(request, ':');
  const std::string_view kind = parts.front();
  const auto number = [&](std::size_t place, std::uint64_t otherwise) {
    return place < parts.size() ? number_from<std::uint64_t>("--random", parts[place]) : otherwise;
  };
  const std::size_t count = number(1, 1);
  const std::uint64_t seed = number(2, seed_), first = number(3, 0);
  if (count < 1 || count > most_robots)
    throw InputError("--random", fmt::format("\"{}\" is not accepted; give 1 to {} robots", request, most_robots));
  if (kind != "voxel" && kind != "nn")
    throw InputError("--random", fmt::format("\"{}\" is not a kind of robot; give voxel:N or nn:N", kind));
  if (parts.size() > 4)
    throw InputError("--random", fmt::format("\"{}\" is not accepted; give KIND:N, KIND:N:SEED or KIND:N:SEED:FIRST", request));
  if (kind == "voxel") return random_voxel_robots(voxel_.chosen(), seed, count, first);
  return random_network_robots(count, seed, first);
}

std::vector<Robot> RobotOptions::random_network_robots(std::size_t count, std::uint64_t seed, std::uint64_t first) const {
  std::vector<FailedRobot> failed;
  std::vector<Robot> robots = random_nn_robots(nn_.chosen(), seed, count, first, &failed);
  if (robots.empty()) throw InputError("--random", "none could be grown: " + failed.front().reason);
  for (const FailedRobot& robot : failed)
    fmt::print(stderr, "mercury: nn-{}-{} was left out: {}\n", seed, robot.index, robot.reason);
  return robots;
}

}  // namespace mercury
