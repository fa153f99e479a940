// SPDX-License-Identifier: Apache-2.0
#include "app/options/robot_output.h"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>

#include "app/base/interrupt.h"
#include "app/base/messages.h"
#include "app/base/progress.h"
#include "app/options/option_values.h"
#include "mercury/error.h"
#include "mercury/robot_file.h"

namespace mercury {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t at_once = 64;  // robots made together, then written

}  // namespace

std::vector<MadeRobot> make_robots(const MakeRobot& make, std::uint64_t seed, std::uint64_t first, std::size_t count) {
  std::vector<MadeRobot> made(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    try {
      made[i].robot = make(seed, first + i);
    } catch (const InputError& error) {
      made[i].failure = error.what();
    }
  });
  return made;
}

void RobotOutput::add_to(CLI::App& command, const std::string& count_help) {
  add_files_to(command);
  add_number(command, "--count", count_, count_help, "N");
  add_number(command, "--seed", seed_, "Seed (default 1)", "N");
}

void RobotOutput::add_files_to(CLI::App& command) {
  add_text(command, "-o,--output", path_, "Robot file (.json, .cbor), or a folder", "FILE|FOLDER")->required();
  add_choice(command, "--format", format_, {"json", "cbor"}, "Of the files in a folder (default json)");
  command.add_flag("--force", force_, "Replace files that exist");
}

bool RobotOutput::names_file() const {
  const std::string extension = fs::path(path_).extension().string();
  return (extension == ".json" || extension == ".cbor") && !fs::is_directory(path_);
}

std::optional<std::string> RobotOutput::file_stem() const {
  return names_file() ? std::optional(fs::path(path_).stem().string()) : std::nullopt;
}

void RobotOutput::prepare(std::uint64_t robots) const {
  const fs::path path(path_);
  if (count_ < 1) throw InputError("--count", "0 is not accepted; give 1 or more");
  if (path.empty()) throw InputError("-o", "give a file (.json, .cbor) or a folder");
  if (names_file()) {
    if (robots > 1) throw InputError("-o", path_ + " is one file; give a folder for several robots");
  } else if (!path.extension().empty() && !path.filename().empty() && !fs::is_directory(path)) {
    throw InputError("-o", fmt::format("{}: \"{}\" is not a robot file; give .json, .cbor or a folder", path_,
                                       path.extension().string()));
  } else if (fs::exists(path) && !fs::is_directory(path)) {
    throw InputError("-o", path_ + " is a file, not a folder");
  }
  const fs::path folder = names_file() ? path.parent_path() : path;
  std::error_code error;
  if (!folder.empty()) fs::create_directories(folder, error);
  if (error) throw InputError("-o", "cannot make the folder " + folder.string() + ": " + error.message());
}

void RobotOutput::write(const Robot& robot) const {
  const fs::path file = names_file() ? fs::path(path_) : fs::path(path_) / (robot.name + "." + format_);
  if (!force_ && fs::exists(file))
    throw InputError(file.string(), "exists already; use --force to replace it, or another name");
  save_robot(file, robot);
  fmt::print("{}\n", file.string());
}

int write_robots(const RobotOutput& output, const MakeRobot& make) {
  output.prepare();
  Progress progress("making robots", "robots", static_cast<std::int64_t>(output.count()));
  bool all = true;
  for (std::uint64_t first = 0; first < output.count(); first += at_once) {
    const auto count = static_cast<std::size_t>(std::min(at_once, output.count() - first));
    for (const auto& [robot, failure] : make_robots(make, output.seed(), first, count)) {
      if (interrupted()) {
        say("stopped; the files so far are whole");
        return 1;
      }
      if (robot) {
        output.write(*robot);
      } else {
        all = false;
        warn(fmt::format("a robot was left out: {}", failure));
      }
    }
    progress.update(static_cast<std::int64_t>(first + count));
  }
  return all ? 0 : 1;
}

}  // namespace mercury
