// SPDX-License-Identifier: Apache-2.0
#include "app/options/robot_inputs.h"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>
#include <span>

#include "app/base/interrupt.h"
#include "app/base/messages.h"
#include "app/base/progress.h"
#include "app/options/result_file.h"
#include "mercury/error.h"
#include "mercury/import.h"
#include "mercury/robot_file.h"
#include "mercury/run_folder.h"
#include "mercury/run_robots.h"
#include "mercury/samples.h"

namespace mercury {
namespace {

namespace fs = std::filesystem;

std::vector<std::uint64_t> individuals(const RunHistory& run, const std::string& choice) {
  try {
    return individuals_named(run, choice);
  } catch (const ParameterError& error) {
    throw InputError("--robot", error.problem());
  }
}

// Everything up to the end of standard input. Throws Interrupted after Ctrl-C.
std::string read_standard_input() {
  constexpr int period = 100;  // between two looks at interrupted() [ms]
  constexpr std::size_t piece = std::size_t{1} << 18;
  std::string content;
  while (true) {
    throw_if_interrupted();
    pollfd ready{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
    if (::poll(&ready, 1, period) == 0) continue;
    const std::size_t size = content.size();
    content.resize(size + piece);
    const ssize_t got = ::read(STDIN_FILENO, content.data() + size, piece);
    content.resize(size + static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
    if (got == 0) return content;
    if (got < 0 && errno != EINTR && errno != EAGAIN)
      throw InputError(standard_input, std::string("standard input cannot be read: ") + std::strerror(errno));
  }
}

// The robot of a file, or those of a file of another simulator. Their worlds are not applied.
std::vector<Robot> robots_in(const fs::path& file) {
  const ImportFormat* format = import_format_of(file);
  if (!format) try {
      return {load_robot(file)};
    } catch (const InputError&) {
      if (is_result(file))
        throw InputError(
            file.string(),
            "is a result of mercury run; mercury render films it, export writes its motion, here give robots");
      throw;
    }
  Import import = import_file(file, *format);
  if (import.robots.empty()) throw InputError(file.string(), "holds no robot: " + import.report.notes.front());
  if (import.motion)
    throw InputError(file.string(),
                     "a motion to play; mercury import makes it a recording, for view, render and export");
  for (const std::string& note : import.report.decisive) say(fmt::format("{}: {}", printable(file.string()), note));
  say(fmt::format("{}: imported without its world ({}, dt {:.3g} s); mercury import writes it, and a report",
                  printable(file.string()), import.settings.environment, import.settings.dt));
  return std::move(import.robots);
}

}  // namespace

void RobotInputs::add_to(const Command& command, const std::string& description) {
  command.add_list("ROBOTS", paths_, description + "; - reads robots from standard input")
      .with_form("PATH")
      .offering(sample_names());
  add_options_to(command);
}

void RobotInputs::add_options_to(const Command& command) {
  command.add_flag("--recursive", recursive_, "Also read the folders inside folders").in_group("Robots");
  command
      .add_list("--robot", of_runs_,
                "Of a run folder: the individual of this number, the best one, the elites (all that live), or the "
                "champions in best/ (the default); may be given several times")
      .one_value_each()
      .offering({std::string(best_of_run), std::string(elites_of_run), std::string(champions_of_run)})
      .with_form("ID|best|elites|champions")
      .in_group("Robots");
  command.add_flag("--keep-going", keep_going_, "Report files that cannot be used, and go on (exit status 1)")
      .in_group("Robots");
}

std::vector<fs::path> RobotInputs::paths() const {
  std::vector<fs::path> paths;
  for (const std::string& path : paths_) paths.push_back(sample_or_path(path));
  return paths;
}

void RobotInputs::leave_out(const std::string& reason) const {
  ++left_out_;
  warn(reason);
}

void RobotInputs::keep_going_after(const std::string& error) const {
  if (!keep_going_) throw InputError(error);
  leave_out("left out: " + error);
}

std::vector<fs::path> RobotInputs::listed(const std::vector<fs::path>& paths) const {
  std::vector<fs::path> files;
  for (const fs::path& path : paths) try {
      const bool is_run = is_run_folder(path);
      const std::vector<fs::path> found = path == standard_input || (is_run && !of_runs_.empty()) ? std::vector{path}
                                          : is_run                                                ? champion_files(path)
                                                   : robot_files(std::span(&path, 1), recursive_);
      files.insert(files.end(), found.begin(), found.end());
    } catch (const InputError& error) {
      keep_going_after(error.what());
    }
  return files;
}

void RobotInputs::load_run(const fs::path& folder, std::vector<RobotFromFile>& robots,
                           const std::function<void(const Robot&)>& accept) const {
  const RunHistory run(folder);
  const auto add = [&](const fs::path& file, Robot robot) {
    if (accept) accept(robot);
    robots.push_back({file, std::move(robot)});
  };
  const auto add_individual = [&](std::uint64_t id) {
    throw_if_interrupted();
    try {
      add(folder, run.grow(id));
    } catch (const InputError& error) {
      keep_going_after(fmt::format("{}: robot {}: {}", folder.string(), id, error.what()));
    }
  };
  for (const std::string& choice : of_runs_)
    if (choice == champions_of_run)
      for (const fs::path& file : champion_files(folder)) add(file, load_robot(file));
    else
      for (const std::uint64_t id : individuals(run, choice)) add_individual(id);
}

void RobotInputs::load_standard_input(std::vector<RobotFromFile>& robots,
                                      const std::function<void(const Robot&)>& accept) const {
  const std::string content = read_standard_input();
  RobotDocuments documents(content);
  const std::size_t before = robots.size(), left_out = left_out_;
  for (bool more = true; more;) try {
      throw_if_interrupted();
      std::optional<Robot> robot = documents.next();
      more = robot.has_value();
      if (!more) break;
      if (robot->name.empty()) robot->name = fmt::format("robot-{}", robots.size() - before + 1);
      if (accept) accept(*robot);
      robots.push_back({standard_input, *std::move(robot)});
    } catch (const InputError& error) {
      keep_going_after(std::string("standard input: ") + error.what());
    }
  if (robots.size() == before && left_out_ == left_out) throw InputError("standard input", "holds no robot");
}

std::vector<RobotFromFile> RobotInputs::load(const std::vector<fs::path>& paths,
                                             const std::function<void(const Robot&)>& accept) const {
  if (!of_runs_.empty() && std::ranges::none_of(paths, is_run_folder))
    throw InputError("--robot", "chooses robots of a run of mercury evolve; give its folder");
  const std::vector<fs::path> files = listed(paths);
  std::vector<RobotFromFile> robots;
  robots.reserve(files.size());
  Progress progress("reading robots", "files", static_cast<std::int64_t>(files.size()));
  for (std::size_t i = 0; i < files.size(); ++i) {
    throw_if_interrupted();
    try {
      if (files[i] == standard_input) {
        load_standard_input(robots, accept);
      } else if (is_run_folder(files[i])) {
        load_run(files[i], robots, accept);
      } else {
        for (Robot& robot : robots_in(files[i])) {
          if (accept) accept(robot);
          robots.push_back({files[i], std::move(robot)});
        }
      }
    } catch (const InputError& error) {
      keep_going_after(error.what());
    }
    progress.update(static_cast<std::int64_t>(i + 1));
  }
  return robots;
}

std::vector<RobotFromFile> RobotInputs::load(const std::function<void(const Robot&)>& accept) const {
  std::vector<RobotFromFile> robots = load(paths(), accept);
  if (robots.empty() && !empty()) throw InputError("no robot is left: none of the files can be used");
  return robots;
}

std::vector<Robot> robots_of(std::vector<RobotFromFile> loaded) {
  std::vector<Robot> robots;
  robots.reserve(loaded.size());
  for (RobotFromFile& one : loaded) robots.push_back(std::move(one.robot));
  return robots;
}

}  // namespace mercury
