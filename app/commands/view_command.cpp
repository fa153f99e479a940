// SPDX-License-Identifier: Apache-2.0
// mercury view: the interactive window.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>

#include "app/base/progress.h"
#include "app/options/attachment_options.h"
#include "app/options/command.h"
#include "app/options/option_values.h"
#include "app/options/output_options.h"
#include "app/options/robot_options.h"
#include "app/options/simulation_options.h"
#include "app/options/trial_start.h"
#include "app/options/view_options.h"
#include "app/recording/repro.h"
#include "app/recording/trajectory_reader.h"
#include "app/video/frame_writer.h"
#include "app/window/toolkit/embedded.h"
#include "app/window/viewer.h"
#include "mercury/error.h"
#include "mercury/host_memory.h"
#include "mercury/origin.h"
#include "mercury/run_folder.h"

namespace mercury {
namespace {

struct ViewCommandOptions {
  RobotOptions robots;
  SimulationOptions simulation;
  ViewOptions view;
  AttachmentOptions attachments;
  TrialSettings start = one_trial();
  OutputOptions output;
  std::string size, quality = "auto", report;
  double speed = 1;
  bool fresh = false, paused = false, no_interop = false, unpaced = false;
};

// "0.1", or "max": as fast as possible.
double speed_from(const std::string& option, const std::string& text) {
  const double speed = text == "max" ? std::numeric_limits<double>::infinity() : number_from<double>(option, text);
  if (!(speed > 0)) throw InputError(option, text + " is not accepted; give a number above 0, or max");
  return speed;
}

window::ViewerOptions viewer_options(const ViewCommandOptions& options) {
  window::ViewerOptions result;
  if (!options.size.empty()) {
    const std::vector<int> size = sizes_from("--size", options.size, 2, "WIDTHxHEIGHT");
    require_drawable({size[0], size[1]});
    result.size = {size[0], size[1]};
  }
  result.quality = render::quality_named(options.quality);
  result.report = options.report;
  result.remember = !options.fresh;
  result.playing = !options.paused;
  result.speed = options.speed;
  result.interop = !options.no_interop;
  result.paced = !options.unpaced;
  validate(options.start);
  result.start = {options.start, options.robots.seed_or_default()};
  result.view = options.view.settings(usual_layout(result.start));
  if (result.view.background) throw InputError("--background", "is of a still; mercury render draws figures");
  result.held = options.attachments.held();
  return result;
}

// The run folder, if one was given.
std::optional<std::filesystem::path> run_in(const RobotOptions& robots) {
  const std::vector<std::filesystem::path> files = robots.files();
  const auto run = std::ranges::find_if(files, is_run_folder);
  if (run == files.end()) return std::nullopt;
  if (!robots.chosen_of_runs().empty())
    throw InputError("--robot", "the window opens a whole run; click a robot there");
  if (files.size() > 1 || robots.seed())
    throw InputError(run->string(), "a run is opened alone; give it without other robots");
  return *run;
}

// Reads the run to report errors before the window opens, and for its configuration. The window reads it again.
void open_with_run(window::ViewerOptions& viewer, const std::filesystem::path& run,
                   const SimulationOptions& simulation) {
  const Device device = viewer.configuration.device;
  viewer.configuration = RunHistory(run).settings().evolution.configuration;
  viewer.configuration.device = device;
  if (!simulation.chosen_environment().empty()) viewer.configuration = simulation.configuration();
  viewer.run = run;
}

// The report is a log, which may go to a device or a pipe. What the window itself saves, it asks about.
void check_report(const ViewCommandOptions& options) {
  if (options.report.empty()) return;
  OutputFiles outputs = options.output.files();
  for (const std::filesystem::path& file : options.robots.files()) outputs.add_input(file);
  outputs.add_input(options.view.camera_file());
  outputs.add_stream("--report", options.report);
  outputs.check();
  outputs.make_folders();
}

int view(const ViewCommandOptions& options) {
  check_report(options);
  window::ViewerOptions viewer = viewer_options(options);
  viewer.configuration = options.simulation.configuration(options.robots.physics());
  if (options.robots.empty()) {
    viewer.robots = window::sample_robots(name_of(viewer.configuration.environment));
    // There are no samples for the simple ocean; use those of the ocean.
    if (viewer.robots.empty()) viewer.robots = window::sample_robots("ocean");
    viewer.welcome = true;
    return window::run_viewer(std::move(viewer));
  }
  if (const auto run = run_in(options.robots)) {
    open_with_run(viewer, *run, options.simulation);
    return window::run_viewer(std::move(viewer));
  }
  if (const auto file = options.robots.repro()) {
    require_start_of_recording(options.start);
    load_repro(*file);  // throws for an invalid file, before the window opens
    viewer.files = {*file};
    return window::run_viewer(std::move(viewer));
  }
  if (const auto file = options.robots.recording()) {
    require_start_of_recording(options.start);
    const TrajectoryReader recording(*file, shown_work());  // throws for an invalid file, before the window opens
    const Device device = viewer.configuration.device;
    viewer.configuration = recording.configuration();
    viewer.configuration.device = device;
    viewer.files = {*file};
    return window::run_viewer(std::move(viewer));
  }
  // Read the files here to report errors before the window opens, and to choose the environment of the robots. The
  // window reads them again.
  viewer.generations = options.robots.random();
  require_memory_for(viewer.generations, drawn_memory, usable_host_memory());
  std::vector<std::string> environments;
  std::optional<Physics> physics;
  for (RobotFromFile& loaded : options.robots.load_files()) {
    physics = std::max(physics.value_or(Physics::paper), physics_of(std::span(&loaded.robot, 1)));
    environments.push_back(environment_of(loaded.robot));
    if (loaded.file == standard_input)
      viewer.robots.push_back(std::move(loaded.robot));
    else
      viewer.files.push_back(std::move(loaded.file));
  }
  if (physics) viewer.configuration = options.simulation.configuration(environments, viewer.notes, *physics);
  return window::run_viewer(std::move(viewer));
}

}  // namespace

void add_view_command(const Command& program, const Choose& choose) {
  auto options = std::make_shared<ViewCommandOptions>();
  const Command command = program.add_command("view", "Show robots in an interactive window");
  options->robots.add_to(command);
  command.find_option("ROBOTS")->with_help(
      "Robot files (.json, .cbor), folders, samples (sample:eel), or a recording (.h5), an explosion (.repro) or the "
      "folder of a run");
  add_text(command, "--size", options->size, "Size of the window (default: last size, or 1280x720)", "WIDTHxHEIGHT")
      .in_group("Window");
  add_choice(command, "--quality", options->quality, {"auto", "low", "medium", "high"}, "Quality of the drawing")
      .in_group("Window");
  add_value(command, "--speed", options->speed, "Simulated seconds per second, or max: as fast as possible (default 1)",
            "X|max", speed_from)
      .offering({"max"})
      .in_group("Window")
      .on_first_screen();
  command.add_flag("--paused", options->paused, "Start paused").in_group("Window").on_first_screen();
  command
      .add_flag("--no-interop", options->no_interop,
                "Copy positions through the host even where CUDA and OpenGL can share them on the GPU")
      .in_group("Window");
  command
      .add_flag("--unpaced", options->unpaced,
                "Draw as many frames as possible, more than the display shows: for measurements")
      .in_group("Window");
  command.add_flag("--fresh", options->fresh, "Neither load nor save settings").in_group("Window");
  add_text(command, "--report", options->report,
           "Write the events of the window to a file, one JSON object per line (docs/window.md)", "FILE")
      .in_group("Window");
  options->attachments.add_to(command);
  options->output.add_force_to(command);
  options->view.add_to(command);
  options->simulation.add_to(command);
  add_start_options(command, options->start);
  command.set_footer(
      "Without ROBOTS the window shows the sample robots. Press F1 for a list of all keys.\n"
      "A RUN of mercury evolve opens with its scores, champions and families; it may still be running.\n"
      "Examples:\n"
      "  mercury view\n"
      "  mercury view my-robots --environment land\n"
      "  mercury view --random voxel:12 --seed 3 --color strain\n"
      "  mercury view swim                 (a run)\n"
      "  mercury view swim.h5              (a recording: play, drag, go on from any frame)");
  command.when_chosen([options, choose] { choose([options] { return options->robots.status(view(*options)); }); });
}

}  // namespace mercury
