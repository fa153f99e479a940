#include "app/robot_output.h"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "app/interrupt.h"
#include "app/option_values.h"
#include "app/progress.h"
#include "robots/file.h"
#include "sim/error.h"

namespace mercury {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t at_once = 64;  // robots made before they are written

bool names_file(const RobotOutput& output) {
  const std::string extension = fs::path(output.path).extension().string();
  return (extension == ".json" || extension == ".cbor") && !fs::is_directory(output.path);
}

void require_usable(const RobotOutput& output) {
  if (output.count < 1) throw InputError("--count", "0 is not accepted; give 1 or more");
  if (output.path.empty()) throw InputError("-o", "give a file (.json, .cbor) or a folder");
  if (names_file(output)) {
    if (output.count > 1) throw InputError("-o", output.path + " is one file; give a folder for several robots");
    return;
  }
  const fs::path path(output.path);
  if (!path.extension().empty() && !path.filename().empty() && !fs::is_directory(path))
    throw InputError("-o", fmt::format("{}: \"{}\" is not a robot file; give .json, .cbor or a folder", output.path,
                                       path.extension().string()));
  if (fs::exists(path) && !fs::is_directory(path)) throw InputError("-o", output.path + " is a file, not a folder");
}

fs::path file_of(const RobotOutput& output, const Robot& robot) {
  return names_file(output) ? fs::path(output.path) : fs::path(output.path) / (robot.name + "." + output.format);
}

void make_folder(const RobotOutput& output) {
  const fs::path folder = names_file(output) ? fs::path(output.path).parent_path() : fs::path(output.path);
  std::error_code error;
  if (!folder.empty()) fs::create_directories(folder, error);
  if (error) throw InputError("-o", "cannot make the folder " + folder.string() + ": " + error.message());
}

// A robot, or why there is none.
struct Made {
  std::optional<Robot> robot;
  std::string failure;
};

std::vector<Made> make_some(const RobotOutput& output, const MakeRobot& make, std::uint64_t first, std::size_t count) {
  std::vector<Made> made(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    try {
      made[i].robot = make(output.seed, first + i);
    } catch (const InputError& error) {
      made[i].failure = error.what();
    }
  });
  return made;
}

}  // namespace

void RobotOutput::add_to(CLI::App& command) {
  add_text(command, "-o,--output", path, "Robot file (.json, .cbor), or a folder", "FILE|FOLDER")->required();
  add_number(command, "--count", count, "How many robots (default 1)", "N");
  add_number(command, "--seed", seed, "Seed (default 1)", "N");
  add_choice(command, "--format", format, {"json", "cbor"}, "Of the files in a folder (default json)");
  command.add_flag("--force", force, "Replace files that exist");
  add_text(command, "--config", config, "Read options from a TOML file; those given here count more", "FILE.toml");
}

int write_robots(const RobotOutput& output, const MakeRobot& make) {
  require_usable(output);
  make_folder(output);
  Progress progress("making robots", "robots", static_cast<std::int64_t>(output.count));
  bool all = true;
  for (std::uint64_t first = 0; first < output.count; first += at_once) {
    const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(at_once, output.count - first));
    for (const auto& [robot, failure] : make_some(output, make, first, count)) {
      if (interrupted()) {
        fmt::print(stderr, "mercury: stopped; the files so far are whole\n");
        return 1;
      }
      if (!robot) {
        all = false;
        fmt::print(stderr, "mercury: a robot was left out: {}\n", failure);
        continue;
      }
      const fs::path file = file_of(output, *robot);
      if (!output.force && fs::exists(file))
        throw InputError(file.string(), "exists already; use --force to replace it, or another name");
      save_robot(file, *robot);
      fmt::print("{}\n", file.string());
    }
    progress.update(static_cast<std::int64_t>(first + count));
  }
  return all ? 0 : 1;
}

}  // namespace mercury
