// SPDX-License-Identifier: Apache-2.0
#include "app/options/robot_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "app/base/interrupt.h"
#include "app/base/progress.h"
#include "app/options/option_values.h"
#include "app/options/simulation_options.h"
#include "app/recording/repro.h"
#include "app/recording/trajectory_layout.h"
#include "mercury/error.h"
#include "mercury/lively.h"
#include "mercury/origin.h"
#include "mercury/real_body.h"

namespace mercury {
namespace {

constexpr std::size_t most_robots = 1'000'000;

}  // namespace

std::vector<RandomRobots> chosen_lively(const RandomRobots& request, const Configuration& configuration) {
  if (request.count > most_robots / tried_per_lively)
    throw InputError("--lively", fmt::format("{} robots are too many; give at most {}", request.count,
                                             most_robots / tried_per_lively));
  Progress progress("trying", "robots", static_cast<std::int64_t>(request.count * tried_per_lively));
  return lively_requests(request, configuration, [&](std::size_t done, std::size_t) {
    throw_if_interrupted();
    progress.update(static_cast<std::int64_t>(done));
    return true;
  });
}

void RobotOptions::add_to(const Command& command) {
  files_.add_to(command);
  command
      .add_list("--random", random_,
                fmt::format("N random robots of a kind ({}), of --seed or of SEED, from robot 0 or FIRST on; may be "
                            "given several times",
                            generator_kinds()))
      .offering(names_of_kinds())
      .one_value_each()
      .with_form("KIND:N[:SEED[:FIRST]]")
      .in_group("Robots")
      .on_first_screen();
  add_number(command, "--seed", seed_, "Seed of the random robots and of jitter (default 1)", "N")
      .in_group("Robots")
      .on_first_screen();
  command.add_flag("--lively", lively_, lively_help).in_group("Robots");
  generators_.add_to(command);
}

std::optional<std::filesystem::path> RobotOptions::alone(bool (*is_such)(const std::filesystem::path&),
                                                         const char* why) const {
  const std::vector<std::filesystem::path> paths = files();
  const auto found = std::ranges::find_if(paths, is_such);
  if (found == paths.end()) return std::nullopt;
  if (paths.size() > 1 || !random_.empty()) throw InputError(found->string(), why);
  return *found;
}

std::optional<std::filesystem::path> RobotOptions::recording() const {
  return alone(is_readable_trajectory_name, "a recording is played alone; give it without other robots");
}

std::optional<std::filesystem::path> RobotOptions::repro() const {
  return alone(is_repro_name, "a repro has a time of its own; give it without other robots");
}

std::vector<Robot> RobotOptions::robots_in(const std::filesystem::path& file) const {
  std::vector<Robot> robots = mercury::robots_of(files_.load({file}));
  for (Robot& robot : robots) give_body(robot, file.string());
  return robots;
}

Robot RobotOptions::random_robot(const std::string& request) const {
  return std::move(random_robots(random_from(request)).front());
}

std::optional<RunSettings> RobotOptions::settings_of_run() const {
  const std::vector<std::filesystem::path> paths = files();
  if (paths.size() != 1 || has_random() || !is_run_folder(paths.front())) return std::nullopt;
  return RunHistory(paths.front()).settings();
}

void RobotOptions::require_robots() const {
  if (empty())
    throw InputError("no robots given; name files, folders or samples (sample:eel), or use --random " +
                     generator_kinds(":12"));
}

std::vector<Robot> RobotOptions::random_robots(const RandomRobots& request) const {
  std::vector<FailedRobot> failed;
  std::vector<Robot> robots = make_random_robots(request, &failed, shown_work());
  if (robots.empty()) throw InputError("--random", "none could be grown: " + failed.front().reason);
  for (const FailedRobot& robot : failed)
    files_.leave_out(fmt::format("{}-{}-{} was left out: {}", request.kind, request.seed, robot.index, robot.reason));
  return robots;
}

LoadedRobots RobotOptions::load(const MemoryUse& use) const {
  require_robots();
  const std::vector<RandomRobots> requests = random();
  LoadedRobots all;
  const auto add = [&](Robot& robot) { all.robots.push_back(std::make_shared<const Robot>(std::move(robot))); };
  for (RobotFromFile& loaded : load_files()) {
    all.files.push_back(std::move(loaded.file));
    all.environments.push_back(environment_of(loaded.robot));
    add(loaded.robot);
  }
  require_memory_for(requests, use, usable_host_memory());
  for (const RandomRobots& request : requests) {
    all.environments.push_back(generator_named(request.kind).environment);
    for (Robot& robot : random_robots(request)) add(robot);
  }
  all.physics = physics_of(all.robots);
  all.run = settings_of_run();
  return all;
}

std::vector<std::string> RobotSequence::environment_per_robot() const {
  std::vector<std::string> all(environments.begin(), environments.begin() + static_cast<std::ptrdiff_t>(files.size()));
  for (std::size_t i = 0; i < random.size(); ++i)
    all.insert(all.end(), random[i].count, environments[files.size() + i]);
  return all;
}

RobotSequence RobotOptions::sequence() const {
  require_robots();
  RobotSequence sequence{.random = random()};
  std::vector<std::shared_ptr<const Robot>> files;
  for (RobotFromFile& loaded : load_files()) {
    sequence.files.push_back(std::move(loaded.file));
    sequence.environments.push_back(environment_of(loaded.robot));
    files.push_back(std::make_shared<const Robot>(std::move(loaded.robot)));
  }
  std::vector<std::size_t> first{files.size()};  // of each request, then the end
  for (const RandomRobots& request : sequence.random) {
    first.push_back(first.back() + request.count);
    sequence.environments.push_back(generator_named(request.kind).environment);
  }
  sequence.count = first.back();
  std::vector<const Robot*> pointers;
  for (const auto& file : files) pointers.push_back(file.get());
  sequence.physics = physics_with(pointers);
  sequence.run = settings_of_run();
  sequence.source = [files = std::move(files), requests = sequence.random,
                     first = std::move(first)](std::size_t index) -> std::shared_ptr<const Robot> {
    if (index < files.size()) return files[index];
    if (index >= first.back()) return nullptr;
    const auto i = static_cast<std::size_t>(std::ranges::upper_bound(first, index) - first.begin()) - 1;
    const RandomRobots& request = requests[i];
    return std::make_shared<const Robot>(
        generator_named(request.kind)
            .make(request.values, request.environment, request.seed, request.first + (index - first[i])));
  };
  return sequence;
}

Physics RobotOptions::physics() const {
  return real_material_in(generators_.values()) ? Physics::real : Physics::paper;
}

void RobotOptions::require_robot_files() const {
  if (const auto file = recording())
    throw InputError(file->string(), "is a recording; mercury view and render play it, here give robots");
  if (const auto file = repro())
    throw InputError(file->string(), "is a repro; mercury run and mercury view show it, here give robots");
}

std::vector<RobotFromFile> RobotOptions::load_files() const {
  require_robot_files();
  std::vector<RobotFromFile> loaded = files_.load();
  for (RobotFromFile& file : loaded) give_body(file.robot, file.file.string());
  return loaded;
}

void RobotOptions::give_body(Robot& robot, const std::string& file) const {
  const auto material = real_material_in(generators_.values());
  if (!material || mercury::physics_of(robot) == Physics::real) return;
  try {
    robot = with_real_body(robot, *material);
  } catch (const InputError& error) {
    throw InputError(file, error.what());
  }
}

Physics RobotOptions::physics_with(std::span<const Robot* const> files) const {
  if (files.empty()) return physics();
  const Physics of_files = physics_of(files);
  if (!random_.empty() && of_files != physics())
    throw InputError("--random",
                     "these robots have bodies of the paper, those of the files have real ones; --physics "
                     "real gives all a real one");
  return of_files;
}

std::vector<RandomRobots> RobotOptions::random() const {
  std::vector<RandomRobots> requests;
  for (const std::string& request : random_) {
    const RandomRobots all = random_from(request);
    if (lively_)
      std::ranges::move(chosen_lively(all, lively_configuration(all)), std::back_inserter(requests));
    else
      requests.push_back(all);
  }
  if (lively_ && random_.empty()) throw InputError("--lively", "goes with --random KIND:N");
  return requests;
}

RandomRobots RobotOptions::random_from(const std::string& request) const {
  const std::vector<std::string_view> parts = split(request, ':');
  const auto number = [&](std::size_t part, std::uint64_t otherwise) {
    return part < parts.size() ? number_from<std::uint64_t>("--random", parts[part]) : otherwise;
  };
  RandomRobots robots{.kind = std::string(parts.front()),
                      .count = number(1, 1),
                      .seed = number(2, seed_),
                      .first = number(3, 0),
                      .values = generators_.values()};
  if (robots.count < 1 || robots.count > most_robots)
    throw InputError("--random", fmt::format("\"{}\" is not accepted; give 1 to {} robots", request, most_robots));
  const Generator* generator = find_generator(robots.kind);
  if (!generator)
    throw InputError("--random",
                     fmt::format("\"{}\" is not a kind of robot; give {}", robots.kind, generator_kinds(":N")));
  if (parts.size() > 4)
    throw InputError("--random",
                     fmt::format("\"{}\" is not accepted; give KIND:N, KIND:N:SEED or KIND:N:SEED:FIRST", request));
  generator->validate(robots.values);
  return robots;
}

namespace {

// The mean of a few robots [bytes]; 0 if none of them can be made, which is reported when all are made.
double mean_bytes(RandomRobots request, const MemoryUse& use) {
  constexpr std::size_t fewest = 1, most = 16;
  request.count = std::clamp(request.count / most, fewest, most);
  std::vector<FailedRobot> failed;
  double sum = 0;
  const std::vector<Robot> robots = make_random_robots(request, &failed, shown_work());
  for (const Robot& robot : robots) sum += use.of(robot);
  return robots.empty() ? 0 : sum / static_cast<double>(robots.size());
}

// Two digits, downward: "31,000".
std::string rounded(double count) {
  const double unit = std::pow(10, std::max(0.0, std::floor(std::log10(std::max(count, 1.0))) - 1));
  return fmt::format("{:.0f}", std::floor(count / unit) * unit);
}

}  // namespace

void require_memory_for(std::span<const RandomRobots> requests, const MemoryUse& use, std::size_t usable) {
  constexpr std::size_t few = 16;
  double needed = 0;
  std::size_t robots = 0;
  for (const RandomRobots& request : requests) {
    robots += request.count;
    if (request.count > few) needed += static_cast<double>(request.count) * mean_bytes(request, use);
  }
  if (needed <= static_cast<double>(usable)) return;
  const double fit = static_cast<double>(robots) * static_cast<double>(usable) / needed;
  throw InputError("--random", memory_line(static_cast<std::size_t>(needed), usable,
                                           fmt::format("up to {} robots", rounded(std::max(fit, 1.0)))));
}

}  // namespace mercury
