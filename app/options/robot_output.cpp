// SPDX-License-Identifier: Apache-2.0
#include "app/options/robot_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <utility>

#include "app/base/file_name.h"
#include "app/base/interrupt.h"
#include "app/base/messages.h"
#include "app/base/progress.h"
#include "app/options/option_values.h"
#include "mercury/error.h"
#include "mercury/file_links.h"
#include "mercury/parallel.h"
#include "mercury/robot_file.h"

namespace mercury {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t at_once = 64;  // robots made together, then written

}  // namespace

std::vector<MadeRobot> make_robots(const MakeRobot& make, std::uint64_t seed, std::uint64_t first, std::size_t count) {
  std::vector<MadeRobot> made(count);
  parallel_for(0, count, [&](std::size_t i) {
    try {
      made[i].robot = make(seed, first + i);
    } catch (const InputError& error) {
      made[i].failure = error.what();
    }
  });
  return made;
}

void RobotOutput::add_to(const Command& command, const std::string& count_help) {
  add_files_to(command);
  add_number(command, "--count", count_, count_help, "N").on_first_screen();
  add_number(command, "--seed", seed_, "Seed (default 1)", "N").on_first_screen();
}

void RobotOutput::add_files_to(const Command& command) {
  add_text(command, "-o,--output", path_, "Robot file (.json, .cbor), a folder, or - for standard output",
           "FILE|FOLDER")
      .required();
  add_choice(command, "--format", format_, {"json", "cbor"}, "Of the files in a folder (default json)");
  output_.add_to(command);
}

bool RobotOutput::names_file() const {
  return is_standard_output(path_) || is_device_or_pipe(path_) ||
         (find_robot_format(path_) && !fs::is_directory(path_));
}

std::optional<std::string> RobotOutput::file_stem() const {
  const bool has_name = names_file() && !is_standard_output(path_) && !is_device_or_pipe(path_);
  return has_name ? std::optional(fs::path(path_).stem().string()) : std::nullopt;
}

std::string RobotOutput::description() const {
  if (is_standard_output(path_)) return "standard output";
  return names_file() ? path_ : fmt::format("the folder {} (.{})", path_, format_);
}

void RobotOutput::require_usable(std::uint64_t robots) const {
  const fs::path path(path_);
  if (count_ < 1 || robots < 1 || robots > most_new_robots)
    throw InputError("--count",
                     robots > count_ && count_ > 0
                         ? fmt::format("{} robots are too many; give at most {} in all", robots, most_new_robots)
                         : fmt::format("{} is not accepted; give 1 to {}", count_, most_new_robots));
  if (path.empty()) throw InputError("-o", "give a file (.json, .cbor) or a folder");
  if (names_file()) {
    if (robots > 1) throw InputError("-o", path_ + " is one file; give a folder for several robots");
  } else if (!path.extension().empty() && !path.filename().empty() && !fs::is_directory(path)) {
    throw InputError("-o", fmt::format("{}: \"{}\" is not a robot file; give .json, .cbor or a folder", path_,
                                       path.extension().string()));
  }
}

RobotFiles RobotOutput::open(std::uint64_t robots, const RobotNames& names, const std::vector<fs::path>& inputs) const {
  require_usable(robots);
  OutputFiles outputs = output_.files();
  for (const fs::path& input : inputs) outputs.add_input(input);
  RobotFiles files;
  files.path_ = path_;
  files.is_file_ = names_file();
  files.format_ = format_ == "json" ? RobotFormat::json : RobotFormat::cbor;
  if (files.is_file_) {
    outputs.add_stream("-o", path_);
  } else {
    outputs.add_folder("-o", path_);
    std::error_code error;
    for (fs::directory_iterator entry(path_, error), end; !error && entry != end; entry.increment(error)) {
      if (find_robot_format(entry->path()) != files.format_) continue;
      files.existing_.insert(entry->path());
      if (names(entry->path().stem().string())) outputs.add_stream("-o", entry->path().string());
    }
  }
  files.may_replace_ = outputs.check();
  if (!dry_run()) outputs.make_folders();
  return files;
}

fs::path RobotFiles::file_of(const Robot& robot) const {
  if (is_file_) return path_;
  return path_ / (file_name_of(robot.name) + (format_ == RobotFormat::json ? ".json" : ".cbor"));
}

void RobotFiles::write(const Robot& robot) {
  const fs::path file = file_of(robot);
  if (is_standard_output(file.string())) {
    fmt::print("{}", serialize_robot(robot, format_));
    return;
  }
  if (!is_file_) require_inside(path_, file);
  if (is_device_or_pipe(file)) return save_robot(file, robot, format_);
  if (!is_file_ && written_.insert(file).second) {
    const bool exists = existing_.contains(file);
    if (exists && !may_replace_)
      throw InputError(file.string(), "exists already; use --force to replace it, or give another name");
    note_output(file, exists);
  }
  const fs::path given = name_given(file, [&] { save_robot(file, robot); });
  renamed_ = renamed_ || given != file;
  fmt::print("{}\n", printable(given.string(), 10000));
}

RobotNames numbered_names(std::function<std::string(std::uint64_t index)> name_of, std::uint64_t count) {
  return [name_of = std::move(name_of), count](std::string_view name) {
    const std::size_t digits = name.find_last_not_of("0123456789") + 1;  // 0 if there is nothing else
    std::uint64_t index = 0;
    const auto error = std::from_chars(name.data() + digits, name.data() + name.size(), index).ec;
    return error == std::errc{} && index < count && file_name_of(name_of(index)) == name;
  };
}

int write_robots(const RobotOutput& output, RobotFiles files, const MakeRobot& make) {
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
        files.write(*robot);
      } else {
        all = false;
        warn(fmt::format("a robot was left out: {}", failure));
      }
    }
    progress.update(static_cast<std::int64_t>(first + count));
  }
  return all && !files.renamed() ? 0 : 1;
}

}  // namespace mercury
