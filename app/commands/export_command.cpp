// SPDX-License-Identifier: Apache-2.0
// mercury export: robots and recorded motions as files of other programs.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "app/base/file_name.h"
#include "app/base/interrupt.h"
#include "app/base/messages.h"
#include "app/base/progress.h"
#include "app/commands/description.h"
#include "app/commands/run_film.h"
#include "app/export/export.h"
#include "app/export/simulated_motion.h"
#include "app/options/command.h"
#include "app/options/option_values.h"
#include "app/options/output_options.h"
#include "app/options/result_file.h"
#include "app/options/robot_options.h"
#include "app/options/simulation_options.h"

namespace mercury {
namespace {

namespace fs = std::filesystem;

constexpr double seconds_of_run = 5;  // simulated, of each robot of a run

struct ExportOptions {
  RobotOptions robots;
  SimulationOptions simulation;
  RunFilmOptions film;
  OutputOptions output;
  std::string path, format, robot;
  FrameRange range;
  std::optional<std::int64_t> every;
  std::optional<double> still, fps;
  bool springs = false;
  StageChoices stage;
  bool for_seconds = false;    // --seconds was given
  std::string for_simulation;  // the first option that says how to simulate; empty = none was given
  std::string command;         // as the user typed it

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
    const bool is_file = export_format_of(path) != nullptr && !fs::is_directory(path, ignored);
    if (!is_file && path.has_extension() && !path.filename().empty() && !fs::is_directory(path, ignored))
      throw InputError("-o", fmt::format("{}: \"{}\" is no format; give a file of {}, or a folder with --format",
                                         options.path, path.extension().string(), format_names()));
    format_ = is_file ? &format_for(path, options.format) : &format_in_folder(options.format);
    require_stage(*format_, options.stage);
    together_ = is_file && format_->motions;
    if (is_file && robots_.size() > 1 && !together_)
      throw InputError("-o", fmt::format("{} is one file, and there are {} robots; give a folder with --format, or "
                                         "choose one with --robot",
                                         options.path, robots_.size()));
    if (is_file) {
      files_.push_back(path);
      return;
    }
    folder_ = path;
    FileNames own_names;
    for (const std::size_t robot : robots_)
      files_.push_back(path / (own_names.of(names[robot]) + std::string(format_->extension)));
  }

  const ExportFormat& format() const { return *format_; }
  bool together() const { return together_; }  // all robots are in one file
  std::span<const std::size_t> robots() const { return robots_; }
  std::span<const fs::path> files() const { return files_; }  // one, or one per robot

  // Makes missing folders, unless it is a dry run.
  void check(const ExportOptions& options) const {
    OutputFiles outputs = options.output.files();
    for (const fs::path& input : options.robots.files()) outputs.add_input(input);
    for (const fs::path& file : files_) add_outputs(*format_, file, outputs, "-o", folder_);
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
  fs::path folder_;  // empty = one file
  const ExportFormat* format_ = nullptr;
  bool together_ = false;
};

int describe(const Targets& targets, const std::string& what, Intentions intentions = {}) {
  intentions.insert(intentions.begin(), {"export", what});
  intentions.emplace_back("as", std::string(targets.format().title));
  for (const fs::path& file : targets.files()) intentions.emplace_back("write", outputs_text(targets.format(), file));
  return print_dry_run("export", intentions);
}

void print_name(const fs::path& file) { fmt::print("{}\n", printable(file.string(), 10000)); }

std::string robots_text(std::size_t count, const std::string& how = "") {
  return count_text(static_cast<std::int64_t>(count), "robot" + how, "robots" + how);
}

int export_poses(const ExportOptions& options, const LoadedRobots& loaded, const Targets& targets,
                 const std::optional<ImportedSettings>& world = {}) {
  if (!options.for_simulation.empty() && !world)
    throw InputError(options.for_simulation,
                     fmt::format("goes with a motion, and {} is written at rest; give --seconds, too, and {}",
                                 targets.format().name, format_names(holds_simulated_motion)));
  for (const std::size_t robot : targets.robots())
    require_pose(targets.format(), *loaded.robots[robot], options.springs);
  targets.check(options);
  if (options.output.dry_run()) return describe(targets, robots_text(targets.robots().size(), " at rest"));
  Progress progress("exporting", "robots", static_cast<std::int64_t>(targets.robots().size()));
  int status = 0;
  for (std::size_t i = 0; i < targets.files().size(); ++i) {
    throw_if_interrupted();
    const Robot& robot = *loaded.robots[targets.robots()[i]];
    const fs::path& file = targets.files()[i];
    const fs::path given = name_given(file, [&] {
      targets.format().pose(exported_robot(robot), rest_pose(robot), file,
                            {.springs = options.springs, .stage = options.stage, .world = world});
    });
    print_name(given);
    if (given != file) status = 1;
    progress.update(static_cast<std::int64_t>(i + 1));
  }
  return status;
}

// Returns the exit status.
int write_motions(const ExportOptions& options, const Targets& targets, std::vector<RecordedMotion>& motions,
                  ExportNotes notes, const std::optional<ImportedSettings>& world = {}) {
  std::int64_t total = 0, before = 0;
  for (const RecordedMotion& motion : motions) {
    total += static_cast<std::int64_t>(motion.frames());
    if (!motion.problem().empty()) say(motion.problem());
  }
  Progress progress("exporting", "frames", total);
  int status = 0;
  for (std::size_t i = 0; i < targets.files().size(); ++i) {
    const fs::path& file = targets.files()[i];
    const std::int64_t count = targets.together() ? total : static_cast<std::int64_t>(motions[i].frames());
    const ExportChoices choices{.springs = options.springs,
                                .stage = options.stage,
                                .world = world,
                                .notes = notes,
                                .watch = [&](std::size_t done, std::size_t of) {
                                  throw_if_interrupted();
                                  const double frames = static_cast<double>(before) + static_cast<double>(count) *
                                                                                          static_cast<double>(done) /
                                                                                          static_cast<double>(of);
                                  progress.update({static_cast<std::int64_t>(frames), frames});
                                }};
    const fs::path given = name_given(file, [&] {
      if (targets.together())
        targets.format().motions(motions, file, choices);
      else if (options.still)
        targets.format().pose(motions[i].robot(), motions[i].pose_with_velocities(0), file, choices);
      else
        targets.format().motion(motions[i].robot(), motions[i], file, choices);
    });
    print_name(given);
    if (given != file) status = 1;
    before += count;
    throw_if_interrupted();
  }
  return status;
}

// Simulates the robots and exports their motion.
int export_simulated(const ExportOptions& options, const Configuration& configuration,
                     const std::vector<std::shared_ptr<const Robot>>& robots, const Targets& targets, double seconds,
                     const ExportNotes& notes) {
  const ExportFormat& format = targets.format();
  if (!holds_simulated_motion(format))
    throw InputError("--seconds", fmt::format("{} holds {}; give {}", format.name,
                                              holds_motion(format) ? "the motion of a recording" : "one pose",
                                              format_names(holds_simulated_motion)));
  if (options.for_seconds && !(seconds > 0)) throw InputError("--seconds", "0 is not accepted for a motion; give more");
  const double rate = options.fps.value_or(motion_rate);
  if (options.fps) require_frame_rate("--fps", rate, configuration.dt);
  std::vector<std::shared_ptr<const Robot>> chosen;
  ExportNotes chosen_notes = notes;
  chosen_notes.captions.clear();
  for (const std::size_t robot : targets.robots()) {
    require_motion(format, *robots[robot], options.springs);
    chosen.push_back(robots[robot]);
    if (!notes.captions.empty()) chosen_notes.captions.push_back(notes.captions[robot]);
  }
  targets.check(options);
  if (options.output.dry_run())
    return describe(targets, robots_text(chosen.size()),
                    {{"simulate", time_text(configuration, std::llround(seconds / configuration.dt))},
                     {"in", environment_text(configuration)}});
  const TemporaryRecording recording(targets.files().front());
  {
    Simulation simulation(configuration, chosen, shown_work());
    for (const std::string& note : simulation.notes()) warn(note);
    Progress progress("simulating", "frames", motion_frames(seconds, rate));
    chosen_notes.final_states = record_motion(
                                    simulation, seconds, recording.path(), options.robots.seed(),
                                    [&](std::int64_t frames) {
                                      throw_if_interrupted();
                                      progress.update(frames);
                                    },
                                    rate)
                                    .final_states;
  }
  const auto reader = std::make_shared<TrajectoryReader>(recording.path());
  std::vector<RecordedMotion> motions;
  for (std::size_t i = 0; i < chosen.size(); ++i) motions.emplace_back(reader, i);
  return write_motions(options, targets, motions, std::move(chosen_notes));
}

// A configuration as a world of VXA.
ImportedSettings world_with_warnings(const Configuration& configuration, std::optional<double> seconds) {
  VxaWorld world = vxa_world(configuration.environment, configuration.damping, seconds);
  for (const std::string& lost : world.lost) warn("not kept as it is: " + lost);
  return std::move(world.settings);
}

// What the options say of the world, for a format that holds one; none = nothing, so that the robot's own counts.
std::optional<ImportedSettings> world_of(const ExportOptions& options, const LoadedRobots& loaded) {
  if (options.for_simulation.empty() && !options.for_seconds) return std::nullopt;
  std::vector<std::string> notes;
  const Configuration configuration = options.simulation.configuration_of(loaded, notes);
  for (const std::string& note : notes) warn(note);
  return world_with_warnings(configuration,
                             options.for_seconds ? std::optional(options.simulation.seconds()) : std::nullopt);
}

int export_robots(const ExportOptions& options) {
  if (const std::string option = options.for_recordings(); !option.empty())
    throw InputError(option, "chooses frames of a recording (.h5), and there is none");
  const LoadedRobots loaded = options.robots.load({});
  const Targets targets(options, names_of_robots(loaded.robots));
  if (targets.format().holds_world) {
    return export_poses(options, loaded, targets, world_of(options, loaded));
  }
  const bool moves = options.for_seconds || (!holds_pose(targets.format()) && holds_simulated_motion(targets.format()));
  // Formats that hold several robots take them from a recording, at rest one of a single frame.
  const bool together = targets.together() && targets.robots().size() > 1;
  if (!moves && (!together || !options.for_simulation.empty())) return export_poses(options, loaded, targets);
  std::vector<std::string> notes;
  const Configuration configuration = options.simulation.configuration_of(loaded, notes);
  for (const std::string& note : notes) warn(note);
  return export_simulated(options, configuration, loaded.robots, targets, moves ? options.simulation.seconds() : 0,
                          {.title = {}, .command = options.command, .captions = {}});
}

// The motions of the chosen robots; for a pose the one frame that --still names.
std::vector<RecordedMotion> motions_of(const ExportOptions& options, const Targets& targets,
                                       const std::shared_ptr<TrajectoryReader>& recording) {
  std::vector<RecordedMotion> motions;
  for (const std::size_t robot : targets.robots()) {
    FrameRange range = options.range;
    range.every = options.every.value_or(1);
    RecordedMotion motion = options.still ? RecordedMotion::still(recording, robot, *options.still)
                                          : RecordedMotion(recording, robot, range);
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
  if (!options.for_simulation.empty())
    throw InputError(options.for_simulation, "a recording has its own configuration; give robots to simulate");
  const auto recording = std::make_shared<TrajectoryReader>(file, shown_work());
  const Targets targets(options, names_of_robots(*recording));
  std::vector<RecordedMotion> motions = motions_of(options, targets, recording);
  targets.check(options);
  std::int64_t total = 0;
  for (const RecordedMotion& motion : motions) total += static_cast<std::int64_t>(motion.frames());
  if (options.output.dry_run())
    return describe(targets, fmt::format("{} of {}, {}", robots_text(motions.size()), file.string(),
                                         count_text(total, "frame", "frames")));
  std::optional<ImportedSettings> world;
  if (targets.format().holds_world)
    world = world_with_warnings(recording->configuration(), recording->time(recording->frames() - 1));
  return write_motions(options, targets, motions, {.title = {}, .command = options.command, .captions = {}}, world);
}

// The lines of a caption.
std::vector<std::string> lines_of(const std::string& caption) {
  std::vector<std::string> lines;
  for (const std::string_view line : split(caption, '\n')) lines.emplace_back(line);
  return lines;
}

// The ancestors of the robots that play, and of the others that have a score at most some thousands.
std::vector<ExportedIndividual> family_of(const RunHistory& run, std::span<const std::uint64_t> ids) {
  constexpr std::size_t most_others = 3000;
  std::map<std::uint64_t, std::optional<std::size_t>> kept;  // by id; the robot that plays
  for (const std::uint64_t id : ids)
    for (const std::uint64_t ancestor : run.line_of(id)) kept.try_emplace(ancestor);
  for (std::size_t i = 0; i < ids.size(); ++i) kept[ids[i]] = i;
  const std::size_t every = run.individuals().size() / most_others + 1;
  for (std::size_t id = 0; id < run.individuals().size(); id += every)
    if (std::isfinite(run.individuals()[id].score())) kept.try_emplace(id);
  std::vector<ExportedIndividual> family;
  for (const auto& [id, robot] : kept) {
    const Individual& individual = run.individuals()[static_cast<std::size_t>(id)];
    family.push_back({.id = id,
                      .parents = individual.parents,
                      .generation = individual.generation,
                      .score = individual.score(),
                      .robot = robot});
  }
  return family;
}

// Its champions, a line of ancestors, or its map.
int export_run(const ExportOptions& options, const fs::path& folder) {
  if (const std::string option = options.for_recordings(); !option.empty())
    throw InputError(option, "chooses frames of a recording (.h5), and " + folder.string() + " is a run");
  const RunHistory run(folder);
  const RunFilm film = options.film.film(run, {.at_once = true});
  for (const std::string& note : film.notes) say(note);
  const Clip& clip = film.clips.front();
  const Targets targets(options, names_of_robots(clip.robots));
  const double seconds = options.simulation.seconds(seconds_of_run);
  ExportNotes notes{.title = lines_of(clip.title).front(),
                    .subtitle = lines_of(clip.title).back(),
                    .command = options.command,
                    .captions = {},
                    .board = film.board,
                    .family = family_of(run, film.ids)};
  for (const std::uint64_t id : film.ids) {
    const Individual& individual = run.individuals()[static_cast<std::size_t>(id)];
    notes.captions.push_back(
        {fmt::format("generation {}", individual.generation), score_text(run.settings(), individual)});
  }
  return export_simulated(options, options.simulation.configuration_over(run.settings().evolution.configuration),
                          clip.robots, targets, seconds, notes);
}

// What a result of mercury run names, simulated again.
int export_result(const ExportOptions& options, const fs::path& file) {
  if (const std::string option = options.for_recordings(); !option.empty())
    throw InputError(option, "chooses frames of a recording (.h5), and " + file.string() + " is a result");
  const RunResult result = read_result(file);
  const std::vector<std::shared_ptr<const Robot>> robots = robots_of(result, options.robots);
  const Targets targets(options, names_of_robots(robots));
  const Configuration configuration = options.simulation.configuration_over(result.configuration);
  const int status =
      export_simulated(options, configuration, robots, targets, options.simulation.seconds(result.seconds),
                       {.title = {}, .command = options.command, .captions = {}});
  if (status != 0 || options.output.dry_run()) return status;
  return check_again(result, robots, configuration.device) ? 0 : 1;
}

int export_all(const ExportOptions& options) {
  if (options.path.empty()) throw InputError("-o", "give a file or a folder");
  if (!options.format.empty()) export_format(options.format);
  options.film.validate();
  const std::string chosen = options.film.given();
  const ExportFormat* format = options.format.empty() ? export_format_of(options.path) : &export_format(options.format);
  // Poses of a run are those of its champions' files.
  const bool are_chosen = !options.robots.chosen_of_runs().empty();
  if (are_chosen && !chosen.empty()) throw InputError("--robot", "not together with " + chosen);
  if (!are_chosen && (!chosen.empty() || options.for_seconds || (format && format->motions)))
    if (const auto run = options.robots.alone(is_run_folder, "a run is exported alone; give it without other robots"))
      return export_run(options, *run);
  if (!chosen.empty()) throw InputError(chosen, "chooses robots of a run of mercury evolve; give its folder");
  if (const auto recording = options.robots.recording()) return export_recording(options, *recording);
  if (options.for_seconds || (format && holds_simulated_motion(*format)))
    if (const auto result = options.robots.alone(is_result, "a result is exported alone; give it without other robots"))
      return export_result(options, *result);
  return export_robots(options);
}

// The command line again, such as "mercury export eel.json -o eel.html".
std::string as_typed(const Command& command) {
  std::string text = command.full_name();
  for (const bool positional : {true, false})
    for (const Option& option : command.options()) {
      if (!option.is_given() || option.is_positional() != positional) continue;
      if (!positional) text += option.long_names().empty() ? " " + option.short_names().front() : " --" + option.name();
      if (!option.takes_value()) continue;
      for (const std::string& value : option.values()) text += " " + shell_quoted(value);
    }
  return text;
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
      "Robot files, folders, samples (sample:eel), a recording (.h5), a result (run --json)");
  add_text(command, "-o,--output", options->path,
           "A file, whose extension says the format, or a folder for one file per robot", "FILE|FOLDER")
      .required();
  add_choice(command, "--format", options->format, format_words(), "The format (default: that of the file's extension)")
      .on_first_screen();
  command.find_option("--robot")
      ->with_help("One robot, by name or number from 0, or ID in a run")
      .with_form("NAME|N")
      .on_first_screen();
  add_number(command, "--from", options->range.from, "Where to begin in a recording (default: its start)", "S")
      .on_first_screen();
  add_number(command, "--to", options->range.to, "Where to end in a recording (default: its end)", "S")
      .on_first_screen();
  add_number(command, "--every", options->every, "Every N-th frame of a recording (default 1)", "N");
  add_number(command, "--still", options->still, "The pose at this moment of a recording rather than a motion", "S")
      .on_first_screen();
  command.add_flag("--springs", options->springs,
                   fmt::format("Also the springs as lines, in {}", format_names([](const ExportFormat& format) {
                                 return format.springs == ExportFormat::Springs::if_asked;
                               })));
  command.add_flag("--floor", options->stage.floor,
                   fmt::format("Also a floor below the robots, in {}", format_names(holds_scene)));
  command.add_flag("--with-camera", options->stage.camera, "Also a camera that sees all of the motion, in the same");
  options->film.add_to(command);
  options->output.add_to(command);
  const std::size_t count = command.options().size();
  add_number(command, "--fps", options->fps, "Frames per second of a simulated motion (default 30)", "N");
  options->simulation.add_to(command);
  std::vector<Option> of_simulation = command.options();
  of_simulation.erase(of_simulation.begin(), of_simulation.begin() + static_cast<std::ptrdiff_t>(count));
  command.find_option("--seconds")
      ->with_help(fmt::format("Simulate the robots, and write their motion (default 10 in {})",
                              format_names([](const ExportFormat& format) {
                                return holds_simulated_motion(format) && !holds_pose(format);
                              })));
  command.set_footer(fmt::format(
      "Formats:\n{}\n"
      "A motion comes from a recording of mercury run --record, or robots are simulated for it; without --seconds a\n"
      "robot is written at rest where the format holds poses. All files have meters and z up; a .glb file turns the\n"
      "robot, since glTF has y up. The names of the files are printed.\n\n"
      "Examples:\n"
      "  mercury export sample:eel -o eel.html                  plays in a browser\n"
      "  mercury export RUN --lineage best -o ancestry.html     the champion's ancestors, side by side\n"
      "  mercury export RUN --map -o map.html                   the map of elites; a click plays a robot\n"
      "  mercury export sample:eel -o eel.glb\n"
      "  mercury export my-robots --format stl -o printed/\n"
      "  mercury export run.h5 --robot 0 -o swim.pvd          for ParaView\n"
      "  mercury export RUN --robot 57 -o 57.stl              an individual; also best, elites and champions\n"
      "  mercury export run.h5 --still 2 --format vtu -o moments/",
      format_list()));
  command.when_chosen([options, choose, command, of_simulation] {
    choose([options, command, of_simulation] {
      options->command = as_typed(command);
      if (std::ranges::none_of(options->robots.files(), is_run_folder))
        for (std::string& robot : options->robots.take_chosen_of_runs()) options->robot = std::move(robot);
      options->for_seconds = command.is_given("--seconds");
      for (const Option& option : of_simulation)
        if (option.is_given() && options->for_simulation.empty() && option.name() != "seconds")
          options->for_simulation = "--" + option.name();
      return options->robots.status(export_all(*options));
    });
  });
}

}  // namespace mercury
