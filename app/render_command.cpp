// mercury render: a group video, without a window.
#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "app/commands.h"
#include "app/film.h"
#include "app/option_values.h"
#include "app/robot_options.h"
#include "app/simulation_options.h"
#include "app/video_options.h"

namespace mercury {
namespace {

struct RenderOptions {
  RobotOptions robots;
  SimulationOptions simulation;
  VideoOptions video;
  std::string config;
  bool quiet = false;
};

void say(const std::string& message) { fmt::print(stderr, "mercury: {}\n", message); }

// What the options come to, before anything costly is begun.
struct Plan {
  Configuration configuration;
  VideoKind kind;
  VideoSettings settings;
};

Plan plan(const RenderOptions& options) {
  const VideoOptions& video = options.video;
  const Configuration configuration = options.simulation.configuration();
  video.validate();
  const VideoKind kind = video_kind_of(video.output);
  const double rate = video.rate(kind);
  const double frames = options.simulation.seconds() / video.speed * rate;
  if (frames > 1e8) throw InputError("--seconds", fmt::format("{:.3g} frames are too many for a video", frames));
  VideoSettings settings{.size = encoded_size(kind, video.size),
                         .frames_per_second = rate,
                         .expected_frames = std::max<std::int64_t>(1, std::llround(frames)),
                         .crf = video.crf,
                         .ffmpeg = video.ffmpeg};
  if (settings.size != video.size)
    say(fmt::format("{} needs even sides: drawn at {}x{}", video.output, settings.size.width, settings.size.height));
  return {configuration, kind, settings};
}

std::vector<Eigen::Vector3f> place(const Simulation& simulation, const RenderOptions& options, float aspect,
                                   const render::Orbit& view) {
  std::vector<render::Bounds> bounds;
  for (std::size_t i = 0; i < simulation.size(); ++i) bounds.push_back(rest_bounds(simulation.robot(i)));
  const bool land = std::holds_alternative<Land>(simulation.configuration().environment);
  return grid_layout(bounds, {.grid = options.video.grid, .aspect = aspect, .view = view, .on_ground = land});
}

int render_group(const RenderOptions& options) {
  const auto [configuration, kind, settings] = plan(options);
  const std::vector<Robot> robots = options.robots.load();
  const std::unique_ptr<FrameWriter> writer = open_frame_writer(options.video.output, settings);
  const std::unique_ptr<render::Context> context = render::make_context({.kind = options.video.context_kind()});
  render::Renderer renderer(*context, {.width = settings.size.width,
                                       .height = settings.size.height,
                                       .quality = options.video.draw_quality()});
  Simulation simulation(configuration, robots);
  if (!options.quiet) {
    say(fmt::format("simulating {} robots on {}", simulation.size(), simulation.device_name()));
    say(fmt::format("drawing with {}, {} quality", context->describe(), name_of(renderer.quality())));
    say(fmt::format("encoding {}", writer->description()));
  }
  for (const std::string& note : simulation.notes()) say(note);

  const float aspect = static_cast<float>(settings.size.width) / static_cast<float>(settings.size.height);
  const bool land = std::holds_alternative<Land>(configuration.environment);
  const render::Orbit orbit{.azimuth = -1.3f, .elevation = land ? 0.6f : 0.35f};
  GroupScene scene(simulation, place(simulation, options, aspect, orbit));
  scene.scene().theme = options.video.theme == "light" ? render::Theme::light : render::Theme::dark;
  scene.set_bodies(renderer);
  GroupCamera camera(orbit, aspect);
  const std::unique_ptr<PositionBridge> bridge = make_host_bridge();
  const FilmResult result = film({simulation, *bridge, scene, camera, renderer, *writer, pixel_format_of(kind)},
                                 {.frames_per_second = settings.frames_per_second,
                                  .speed = options.video.speed,
                                  .frames = settings.expected_frames,
                                  .quiet = options.quiet});
  if (result.frames == 0) throw VideoError("stopped before the first frame; nothing was kept");
  writer->finish();
  if (!options.quiet)
    say(fmt::format("{}: {} frames, {:.6g} s of video, made in {:.1f} s ({:.1f} frames/s)", options.video.output,
                    result.frames, static_cast<double>(result.frames) / settings.frames_per_second, result.wall_seconds,
                    static_cast<double>(result.frames) / result.wall_seconds));
  if (result.interrupted) say("stopped early; the video ends there");
  return result.interrupted ? 1 : 0;
}

}  // namespace

void add_render_command(CLI::App& program, const Choose& choose) {
  auto options = std::make_shared<RenderOptions>();
  CLI::App* command = program.add_subcommand("render", "Film a group of robots, without a window");
  options->robots.add_to(*command);
  options->video.add_to(*command);
  command->add_flag("--quiet", options->quiet, "Nothing on standard error but errors");
  options->simulation.add_to(*command);
  add_text(*command, "--config", options->config, "Read options from a TOML file; those given here count more",
           "FILE.toml");
  command->footer(
      "Examples:\n"
      "  mercury render --random voxel:12 --seed 1 -o group.mp4\n"
      "  mercury render robots/ --environment land --size 1080p --seconds 20 --speed 2 -o land.webm\n"
      "  mercury render robots/eel.json --seconds 4 -o eel.gif\n"
      "  mercury render robots/ --fps 60 -o frames/          a folder of PNG pictures");
  command->callback([options, choose] { choose([options] { return render_group(*options); }); });
}

}  // namespace mercury
