// SPDX-License-Identifier: Apache-2.0
// mercury export: robots and recorded motions as files of other programs.
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "app/base/file_name.h"
#include "app/base/interrupt.h"
#include "app/base/messages.h"
#include "app/base/progress.h"
#include "app/commands/commands.h"
#include "app/commands/dry_run.h"
#include "app/export/export.h"
#include "app/options/option_values.h"
#include "app/options/output_options.h"
#include "app/options/robot_options.h"

namespace mercury {
namespace {

namespace fs = std::filesystem;

struct ExportOptions {
  RobotOptions robots;
  OutputOptions output;
  std::string path, format, robot;
  FrameRange range;
  std::optional<std::int64_t> every;
  std::optional<double> still;
  bool springs = false;

  // The first option that needs a recording; empty = none was given.
  std::string for_recordings() const {
    return range.from ? "--from" : range.to ? "--to" : every ? "--every" : still ? "--still" : "";
  }
};

std::vector<std::string> names_of_robots(const std::vector<std::shared_ptr<const Robot>>& robots) {
  std::vector<std::string> names;
  for (const auto& robot : robots) names.push_back(robot->name);
  return names;
}

// Where the chosen robots go: one file, or files of their names in a folder.
class Targets {
 public:
  Targets(const ExportOptions& options, const std::vector<std::string>& names)
      : robots_(chosen_robots(options.robot, names)) {
    const fs::path path(options.path);
    std::error_code ignored;
    is_file_ = export_format_of(path) != nullptr && !fs::is_directory(path, ignored);
    if (!is_file_ && path.has_extension() && !path.filename().empty() && !fs::is_directory(path, ignored))
      throw InputError("-o", fmt::format("{}: \"{}\" is no format; give a file of {}, or a folder with --format",
                                         options.path, path.extension().string(), format_names()));
    format_ = is_file_ ? &format_for(path, options.format) : &format_in_folder(options.format);
    if (is_file_ && robots_.size() > 1)
      throw InputError("-o", fmt::format("{} is one file, and there are {} robots; give a folder with --format, or "
                                         "choose one with --robot",
                                         options.path, robots_.size()));
    FileNames own_names;
    for (const std::size_t robot : robots_) {
      if (is_file_) {
        files_.push_back(path);
        continue;
      }
      files_.push_back(path / (own_names.of(names[robot]) + std::string(format_->extension)));
    }
  }

  const ExportFormat& format() const { return *format_; }
  std::size_t size() const { return files_.size(); }
  std::size_t robot(std::size_t i) const { return robots_[i]; }
  const fs::path& file(std::size_t i) const { return files_[i]; }

  // Makes missing folders, unless it is a dry run.
  void check(const ExportOptions& options) const {
    OutputFiles outputs = options.output.files();
    for (const fs::path& input : options.robots.files()) outputs.add_input(input);
    for (const fs::path& file : files_)
      add_outputs(*format_, file, outputs, "-o", is_file_ ? fs::path() : fs::path(options.path));
    outputs.check();
    if (!options.output.dry_run()) outputs.make_folders();
  }

 private:
  static const ExportFormat& format_in_folder(const std::string& format) {
    if (format.empty()) throw InputError("--format", fmt::format("a folder does not say it; give {}", format_names()));
    return export_format(format);
  }

  std::vector<std::size_t> robots_;
  std::vector<fs::path> files_;
  const ExportFormat* format_ = nullptr;
  bool is_file_ = false;
};

int describe(const Targets& targets, const std::string& what) {
  Intentions intentions{{"export", what}, {"as", std::string(targets.format().title)}};
  for (std::size_t i = 0; i < targets.size(); ++i)
    intentions.emplace_back("write", outputs_text(targets.format(), targets.file(i)));
  return print_dry_run("export", intentions);
}

void print_name(const fs::path& file) { fmt::print("{}\n", printable(file.string(), 10000)); }

int export_robots(const ExportOptions& options) {
  if (const std::string option = options.for_recordings(); !option.empty())
    throw InputError(option, "chooses frames of a recording (.h5), and there is none");
  const LoadedRobots loaded = options.robots.load({});
  const Targets targets(options, names_of_robots(loaded.robots));
  for (std::size_t i = 0; i < targets.size(); ++i)
    require_pose(targets.format(), *loaded.robots[targets.robot(i)], options.springs);
  targets.check(options);
  if (options.output.dry_run())
    return describe(targets, count_text(static_cast<std::int64_t>(targets.size()), "robot at rest", "robots at rest"));
  Progress progress("exporting", "robots", static_cast<std::int64_t>(targets.size()));
  for (std::size_t i = 0; i < targets.size(); ++i) {
    throw_if_interrupted();
    const Robot& robot = *loaded.robots[targets.robot(i)];
    targets.format().pose(exported_robot(robot), rest_pose(robot), targets.file(i), {.springs = options.springs});
    print_name(targets.file(i));
    progress.update(static_cast<std::int64_t>(i + 1));
  }
  return 0;
}

// The frames of each target; for a pose the one frame that --still names.
std::vector<RecordedMotion> motions_of(const ExportOptions& options, const Targets& targets,
                                       const std::shared_ptr<TrajectoryReader>& recording) {
  std::vector<RecordedMotion> motions;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    FrameRange range = options.range;
    range.every = options.every.value_or(1);
    RecordedMotion motion = options.still ? RecordedMotion::still(recording, targets.robot(i), *options.still)
                                          : RecordedMotion(recording, targets.robot(i), range);
    if (options.still)
      require_pose(targets.format(), motion.robot().robot, options.springs);
    else if (!holds_motion(targets.format()))
      throw InputError("--format",
                       fmt::format("{} holds one pose of a recording; choose its moment (--still), or give {}",
                                   targets.format().name, format_names(holds_motion)));
    else
      require_motion(targets.format(), motion.robot().robot, options.springs);
    motions.push_back(std::move(motion));
  }
  return motions;
}

int export_recording(const ExportOptions& options, const fs::path& file) {
  if (options.still && (options.range.from || options.range.to || options.every))
    throw InputError("--still", "not together with --from, --to and --every, which choose a motion");
  const auto recording = std::make_shared<TrajectoryReader>(file, shown_work());
  const Targets targets(options, names_of_robots(*recording));
  std::vector<RecordedMotion> motions = motions_of(options, targets, recording);
  targets.check(options);
  std::int64_t total = 0;
  for (const RecordedMotion& motion : motions) total += static_cast<std::int64_t>(motion.frames());
  if (options.output.dry_run())
    return describe(
        targets, fmt::format("{} of {}, {}", count_text(static_cast<std::int64_t>(motions.size()), "robot", "robots"),
                             file.string(), count_text(total, "frame", "frames")));
  Progress progress("exporting", "frames", total);
  std::int64_t before = 0;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    if (!motions[i].problem().empty()) say(motions[i].problem());
    const auto frames = static_cast<double>(motions[i].frames());
    const ExportChoices choices{
        .springs = options.springs, .watch = [&](std::size_t done, std::size_t of) {
          throw_if_interrupted();
          progress.update_with_fraction(static_cast<double>(before) +
                                        frames * static_cast<double>(done) / static_cast<double>(of));
        }};
    if (options.still)
      targets.format().pose(motions[i].robot(), motions[i].pose_with_velocities(0), targets.file(i), choices);
    else
      targets.format().motion(motions[i].robot(), motions[i], targets.file(i), choices);
    print_name(targets.file(i));
    before += static_cast<std::int64_t>(motions[i].frames());
    throw_if_interrupted();
  }
  return 0;
}

int export_all(const ExportOptions& options) {
  if (options.path.empty()) throw InputError("-o", "give a file or a folder");
  if (!options.format.empty()) export_format(options.format);
  if (const auto recording = options.robots.recording()) return export_recording(options, *recording);
  return export_robots(options);
}

// "obj    skin with ..." a line each.
std::string format_list() {
  std::string text;
  for (const ExportFormat& format : export_formats())
    text += fmt::format("  {:6}{:15}{}\n", format.name,
                        !holds_motion(format) ? "a pose"
                        : !holds_pose(format) ? "a motion"
                                              : "pose or motion",
                        format.help);
  return text;
}

std::vector<std::string> format_words() {
  std::vector<std::string> words;
  for (const ExportFormat& format : export_formats()) words.emplace_back(format.name);
  return words;
}

}  // namespace

void add_export_command(const Command& program, const Choose& choose) {
  auto options = std::make_shared<ExportOptions>();
  const Command command = program.add_command("export", "Write robots and motions as files of other programs");
  options->robots.add_to(command);
  command.find_option("ROBOTS")->with_help(
      "Robot files (.json, .cbor), folders, samples (sample:eel), or a recording (.h5) for motions");
  add_text(command, "-o,--output", options->path,
           "A file, whose extension says the format, or a folder for one file per robot", "FILE|FOLDER")
      .required();
  add_choice(command, "--format", options->format, format_words(), "The format (default: that of the file's extension)")
      .on_first_screen();
  add_text(command, "--robot", options->robot, "One robot of several: its name, or its number from 0", "NAME|N")
      .on_first_screen();
  add_number(command, "--from", options->range.from, "First moment of a recording (default: its first frame)", "S")
      .on_first_screen();
  add_number(command, "--to", options->range.to, "Last moment of a recording (default: its last frame)", "S")
      .on_first_screen();
  add_number(command, "--every", options->every, "Every N-th frame of a recording (default 1)", "N");
  add_number(command, "--still", options->still, "The pose at this moment of a recording rather than a motion", "S")
      .on_first_screen();
  command.add_flag("--springs", options->springs,
                   fmt::format("Also the springs as lines, in {}", format_names([](const ExportFormat& format) {
                                 return format.springs == ExportFormat::Springs::if_asked;
                               })));
  options->output.add_to(command);
  command.set_footer(fmt::format(
      "Formats:\n{}\n"
      "A robot file gives the robot at rest. A motion comes from a recording of mercury run --record. All files have\n"
      "meters and z up; a .glb file turns the robot, since glTF has y up. The names of the files are printed.\n\n"
      "Examples:\n"
      "  mercury export sample:eel -o eel.glb\n"
      "  mercury export my-robots --format stl -o printed/\n"
      "  mercury export run.h5 --robot 0 -o swim.pvd          for ParaView\n"
      "  mercury export run.h5 --still 2 --format vtu -o moments/",
      format_list()));
  command.when_chosen(
      [options, choose] { choose([options] { return options->robots.status(export_all(*options)); }); });
}

}  // namespace mercury
