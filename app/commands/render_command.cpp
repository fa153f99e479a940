// SPDX-License-Identifier: Apache-2.0
// mercury render: makes videos and pictures without a window.
#include <fmt/format.h>

#include <memory>
#include <set>

#include "app/commands/commands.h"
#include "app/options/option_values.h"
#include "app/options/robot_options.h"
#include "app/options/simulation_options.h"
#include "app/options/video_options.h"
#include "app/options/view_options.h"
#include "app/recording/trajectory_playback.h"
#include "app/video/video_pipeline.h"

namespace mercury {
namespace {

struct RenderOptions {
  RobotOptions robots;
  SimulationOptions simulation;
  VideoOptions video;
  ViewOptions view;
  std::string config;
  bool quiet = false;
};

void say(const std::string& message) { fmt::print(stderr, "mercury: {}\n", message); }

// What the video shows: robots to simulate, or a recording to play back.
struct Subject {
  Configuration configuration;
  std::vector<Robot> robots;                    // empty for a recording
  std::shared_ptr<TrajectoryReader> recording;  // or nothing
  double seconds = 0;
  std::vector<std::string> notes;
};

Subject subject_of(const RenderOptions& options) {
  Subject subject;
  if (const auto file = options.robots.recording()) {
    if (options.video.each()) throw InputError("--each", "does not work with a recording; it is played as a whole");
    subject.recording = std::make_shared<TrajectoryReader>(*file);
    const TrajectoryReader& recording = *subject.recording;
    if (recording.frames() == 0) throw InputError(file->string(), "holds no frames");
    subject.configuration = recording.configuration();
    subject.seconds = options.simulation.seconds(recording.time(recording.frames() - 1) - recording.time(0));
  } else {
    options.simulation.configuration();  // errors in options come before those in files
    subject.robots = options.robots.load();
    subject.configuration = options.simulation.configuration(subject.robots, subject.notes);
    subject.seconds = options.simulation.seconds();
  }
  return subject;
}

// What the options ask for, checked before expensive work begins.
struct Task {
  Subject subject;
  VideoOptions::Plan plan;
  ViewSettings view;
};

Task task_of(const RenderOptions& options) {
  options.video.plan(options.simulation.seconds());
  Task task{.view = options.view.settings()};
  task.subject = subject_of(options);
  task.plan = options.video.plan(task.subject.seconds);
  task.view.interop = options.video.interop();
  task.view.speed = options.video.single_picture() ? 1 : options.video.speed();
  const auto [width, height] = task.plan.size;
  if (!options.video.single_picture() && task.plan.size != options.video.asked_size() && !options.quiet)
    say(fmt::format("{} needs even sides: drawn at {}x{}", options.video.output_of(""), width, height));
  for (const std::string& note : task.subject.notes) say(note);
  return task;
}

void report_result(const RenderOptions& options, const std::string& output, const Task& task,
                   const VideoResult& result) {
  if (options.quiet) return;
  const double rate = static_cast<double>(result.frames) / result.wall_seconds;
  if (options.video.single_picture())
    say(fmt::format("{}: made in {:.1f} s", output, result.wall_seconds));
  else
    say(fmt::format("{}: {} frames, {:.6g} s of video, made in {:.1f} s ({:.1f} frames/s)", output, result.frames,
                    static_cast<double>(result.frames) * task.plan.timing.pace, result.wall_seconds, rate));
}

// Makes one video. Returns false when the user interrupted it.
bool make(const RenderOptions& options, const Task& task, OffscreenRenderer& offscreen, Simulation simulation,
          FrameWriter& writer, const std::string& name, bool first) {
  VideoPipeline pipeline(offscreen, std::move(simulation), task.view);
  if (first && !options.quiet) {
    const std::size_t count = pipeline.simulation().size();
    say(fmt::format("{} {} {} ({}) on {}", task.subject.recording ? "playing" : "simulating", count,
                    count == 1 ? "robot" : "robots", name_of(task.subject.configuration.environment),
                    pipeline.simulation().device_name()));
    say(fmt::format("drawing with {}, {} quality{}", offscreen.context->describe(),
                    name_of(offscreen.renderer.quality()),
                    pipeline.positions_on_card() ? ", positions stay on the card" : ""));
    if (!pipeline.bridge_note().empty()) say(pipeline.bridge_note());
    say(fmt::format("encoding {}", writer.description()));
  }
  for (const std::string& note : pipeline.simulation().notes()) say(note);
  const VideoResult result = pipeline.run(writer, task.plan.pixels, task.plan.timing, options.quiet);
  if (result.frames == 0) throw VideoError("stopped before the first frame; nothing was kept");
  writer.finish();
  report_result(options, options.video.output_of(name), task, result);
  return !result.interrupted;
}

// File names of the robots, made unique so that no video replaces another.
std::vector<std::string> file_names(std::span<const Robot> robots) {
  std::vector<std::string> names;
  std::set<std::string> taken;
  for (const Robot& robot : robots) {
    std::string base = robot.name.empty() ? "robot" : robot.name;
    for (char& letter : base)
      if (letter == '/') letter = '_';
    std::string name = base;
    for (int number = 2; !taken.insert(name).second; ++number) name = fmt::format("{}-{}", base, number);
    names.push_back(name);
  }
  return names;
}

Simulation simulation_of(const Subject& subject, std::span<const Robot> robots) {
  return subject.recording ? playback(subject.recording) : Simulation(subject.configuration, robots);
}

int render_robots(const RenderOptions& options) {
  const Task task = task_of(options);
  const std::span<const Robot> robots = task.subject.robots;
  const bool each = options.video.each();
  const std::vector<std::string> names = each ? file_names(robots) : std::vector<std::string>{""};
  // Open the writer first: a missing encoder or an invalid file name is then reported before the slow start of OpenGL.
  std::unique_ptr<FrameWriter> writer = options.video.open(task.plan, names[0]);
  const Device& device = task.subject.configuration.device;
  OffscreenRenderer offscreen =
      make_offscreen_renderer(options.video.context_kind(), task.plan.size, options.video.quality(),
                              device.kind == DeviceKind::cpu ? -1 : device.index);
  bool done = true;
  for (std::size_t i = 0; i < names.size() && done; ++i) {
    if (!writer) writer = options.video.open(task.plan, names[i]);
    Simulation simulation = simulation_of(task.subject, each ? robots.subspan(i, 1) : robots);
    done = make(options, task, offscreen, std::move(simulation), *writer, names[i], i == 0);
    writer.reset();
  }
  if (!done) say("stopped early; the video ends there");
  return done ? 0 : 1;
}

}  // namespace

void add_render_command(CLI::App& program, const Choose& choose) {
  auto options = std::make_shared<RenderOptions>();
  CLI::App* command = program.add_subcommand("render", "Make a video or picture of robots, without a window");
  options->robots.add_to(*command);
  options->video.add_to(*command);
  options->view.add_to(*command);
  command->add_flag("--quiet", options->quiet, "Print only errors on standard error");
  options->simulation.add_to(*command);
  add_text(*command, "--config", options->config, "Read options from a TOML file; the command line overrides them",
           "FILE.toml");
  command->footer(
      "Examples:\n"
      "  mercury render --random voxel:12 --seed 1 -o group.mp4\n"
      "  mercury render my-robots --environment land --size 1080p --seconds 20 --speed 2 -o land.webm\n"
      "  mercury render my-robots --layout race --environment land -o race.mp4\n"
      "  mercury render eel.json --camera turntable --color strain --seconds 4 -o eel.gif\n"
      "  mercury render my-robots --contact-sheet 5x2 --seconds 9 -o poster.png\n"
      "  mercury render run.h5 -o run.mp4                    plays a recording of mercury run --record\n"
      "  mercury render my-robots --fps 60 -o frames/        a folder of PNG pictures");
  command->callback([options, choose] { choose([options] { return render_robots(*options); }); });
}

}  // namespace mercury
