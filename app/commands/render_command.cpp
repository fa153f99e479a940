// SPDX-License-Identifier: Apache-2.0
// mercury render: makes videos and pictures without a window.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <span>

#include "app/base/file_name.h"
#include "app/base/messages.h"
#include "app/commands/description.h"
#include "app/commands/render_subject.h"
#include "app/options/command.h"
#include "app/video/figure.h"
#include "app/video/picture_file.h"
#include "app/video/video_pipeline.h"
#include "mercury/robot_file.h"

namespace mercury {
namespace {

// One file or folder that is written.
struct Output {
  std::string name;  // of the robot that is filmed alone; empty = all
  std::vector<Clip> clips;
};

std::vector<Output> outputs_of(const RenderOptions& options, std::vector<Clip> clips) {
  std::vector<Output> outputs;
  if (!options.video.each()) {
    outputs.push_back({.name = "", .clips = std::move(clips)});
    return outputs;
  }
  FileNames names;
  for (Clip& clip : clips)
    for (std::size_t i = 0; i < clip.robots.size(); ++i) {
      Clip alone{.title = clip.title, .zoom = clip.zoom};
      if (!clip.captions.empty()) alone.captions.push_back(clip.captions[i]);
      const std::string name = names.of(clip.robots[i]->name);
      alone.robots.push_back(std::move(clip.robots[i]));
      outputs.push_back({.name = name, .clips = {std::move(alone)}});
    }
  return outputs;
}

// Simulates, draws and writes clips.
class Filming {
 public:
  Filming(const RenderOptions& options, const RenderTask& task, bool may_replace)
      : options_(options), task_(task), may_replace_(may_replace) {}

  // Opens the writer first: a missing encoder or an invalid file name is then reported before the slow start of OpenGL.
  // Returns false when the user interrupted it; the video then ends there.
  bool make(const Output& output) {
    if (task_.view.background && options_.video.still()) return make_figure(output);
    VideoOptions::Plan whole = task_.plan;
    whole.timing.frames *= static_cast<std::int64_t>(output.clips.size());
    const std::unique_ptr<FrameWriter> writer =
        options_.video.open(whole, output.name, may_replace_, task_.subject.comment(output.clips.front()));
    VideoResult result;
    for (const Clip& clip : output.clips) {
      const VideoResult of_clip = film(clip, *writer);
      result.frames += of_clip.frames;
      result.wall_seconds += of_clip.wall_seconds;
      result.interrupted = of_clip.interrupted;
      if (result.interrupted) break;
    }
    if (result.frames == 0) throw VideoError("stopped before the first frame; nothing was kept");
    writer->finish();
    report_result(options_.video.output_of(output.name), result);
    return !result.interrupted;
  }

 private:
  // Robots and their shadows alone.
  bool make_figure(const Output& output) {
    const Clip& clip = output.clips.front();
    ViewSettings view = task_.view;
    view.text_aside = options_.video.text_aside();
    PictureKeeper keeper;
    const VideoResult result = film(clip, keeper, view);
    if (result.interrupted) return false;
    const render::Image& image = keeper.picture();
    const std::array<render::Image, 2>& pictures = backdrops_;
    const PictureSize size{image.width, image.height};
    const int margin = std::max(2, size.height / 60);
    const std::string path = options_.video.output_of(output.name), comment = task_.subject.comment(clip);
    PixelBox box{0, 0, size.width, size.height};
    if (options_.video.tight()) box = content_of(pictures, margin);
    if (options_.video.text_aside()) {
      const render::Overlay& text = offscreen_->renderer.overlay();
      if (options_.video.tight()) box = joined(box, text, margin, size);
      const Figure figure{image, text, box, options_.video.dpi(), comment};
      const bool pdf = extension_of(path) == ".pdf";
      const std::string document = pdf ? figure_pdf(figure) : figure_svg(figure);
      write_picture_bytes(path, std::span(reinterpret_cast<const std::uint8_t*>(document.data()), document.size()));
    } else {
      write_picture(path, cropped(image, box), comment, options_.video.dpi());
    }
    report_result(path, result);
    return true;
  }

  VideoResult film(const Clip& clip, FrameWriter& writer) { return film(clip, writer, task_.view); }

  VideoResult film(const Clip& clip, FrameWriter& writer, ViewSettings view) {
    const bool first = !offscreen_;
    const Device& device = task_.subject.configuration.device;
    if (first)
      offscreen_ = std::make_unique<OffscreenRenderer>(
          make_offscreen_renderer(options_.video.context_kind(), task_.plan.size, options_.video.quality(),
                                  device.kind == DeviceKind::cpu ? -1 : device.index));
    if (view.caption.empty()) view.caption = clip.title;
    view.camera.zoom *= clip.zoom;
    VideoPipeline pipeline(*offscreen_, task_.subject.groups_of(clip, task_.view), view);
    if (first) report_start(pipeline, writer);
    for (const std::string& note : pipeline.simulation().notes()) say(note);
    const VideoResult result = pipeline.run(writer, task_.plan.pixels, task_.plan.timing, false);
    if (view.background && options_.video.still()) backdrops_ = pipeline.backdrops();
    return result;
  }

  void report_start(const VideoPipeline& pipeline, const FrameWriter& writer) const {
    const std::size_t count = pipeline.simulation().size();
    say(fmt::format("{} {} {} ({}) on {}", task_.subject.recording ? "playing" : "simulating", count,
                    count == 1 ? "robot" : "robots", name_of(task_.subject.configuration.environment),
                    pipeline.simulation().device_name()));
    if (task_.view.compare) {
      const Configuration& first = task_.subject.configuration;
      const auto [left, right] = differences(first, task_.view.compare->over(first));
      say(left.empty() ? "both sides have the same settings" : fmt::format("comparing {} | {}", left, right));
    }
    say(fmt::format("drawing with {}, {} quality{}", offscreen_->context->describe(),
                    name_of(offscreen_->renderer.quality()),
                    pipeline.positions_on_device() ? ", positions stay on the GPU" : ""));
    if (!pipeline.bridge_note().empty()) say(pipeline.bridge_note());
    say(fmt::format("encoding {}", writer.description()));
  }

  void report_result(const std::string& output, const VideoResult& result) const {
    const double rate = static_cast<double>(result.frames) / result.wall_seconds;
    if (options_.video.single_picture())
      say(fmt::format("{}: made in {:.1f} s", output, result.wall_seconds));
    else
      say(fmt::format("{}: {} frames, {:.6g} s of video, made in {:.1f} s ({:.1f} frames/s)", output, result.frames,
                      static_cast<double>(result.frames) * task_.plan.timing.pace, result.wall_seconds, rate));
  }

  const RenderOptions& options_;
  const RenderTask& task_;
  const bool may_replace_;
  std::unique_ptr<OffscreenRenderer> offscreen_;
  std::array<render::Image, 2> backdrops_;  // of the last figure
};

// Returns whether existing files may be replaced.
bool check_outputs(const RenderOptions& options, const std::vector<std::string>& names) {
  OutputFiles outputs = options.output.files();
  for (const std::filesystem::path& file : options.robots.files()) outputs.add_input(file);
  outputs.add_input(options.view.camera_file());
  for (const std::string& name : names) options.video.add_output_to(outputs, name);
  return outputs.check();
}

int describe_work(const RenderOptions& options, const RenderTask& task, const std::vector<Output>& outputs) {
  const Subject& subject = task.subject;
  const auto& [width, height] = task.plan.size;
  std::size_t clips = 0;
  for (const Output& output : outputs) clips += output.clips.size();
  Intentions intentions;
  std::vector<std::shared_ptr<const Robot>> robots;
  for (const Output& output : outputs)
    for (const Clip& clip : output.clips) robots.insert(robots.end(), clip.robots.begin(), clip.robots.end());
  if (subject.recording) {
    const auto count = static_cast<std::int64_t>(subject.recording->robots().size());
    intentions.emplace_back("play", subject.recording->path().string() + ": " + count_text(count, "robot", "robots"));
  } else {
    const FramePlace last = place_of_frame(task.plan.timing.frames - 1, task.plan.timing, subject.configuration.dt);
    intentions.emplace_back("robots", size_text(robots));
    intentions.emplace_back("simulate",
                            time_text(subject.configuration, last.step + (last.is_between_steps() ? 1 : 0)));
    intentions.emplace_back("in", environment_text(subject.configuration));
    if (task.view.compare) intentions.emplace_back("beside", task.view.compare->text());
    intentions.emplace_back("on", device_text(subject.configuration.device));
  }
  const std::int64_t frames = task.plan.timing.frames * static_cast<std::int64_t>(clips);
  intentions.emplace_back("draw", fmt::format("{} of {}x{}", count_text(frames, "frame", "frames"), width, height));
  for (const Output& output : outputs) intentions.emplace_back("write", options.video.output_of(output.name));
  return print_dry_run("render", intentions);
}

int render_robots(RenderOptions& options) {
  check_options(options);
  // The names of several videos are known later.
  bool may_replace = !options.video.each() && check_outputs(options, {""});
  RenderTask task = render_task(options);
  const std::vector<Output> outputs = outputs_of(options, std::move(task.subject.clips));
  if (options.video.each()) {
    std::vector<std::string> names;
    for (const Output& output : outputs) names.push_back(output.name);
    may_replace = check_outputs(options, names);
  }
  if (options.output.dry_run()) return describe_work(options, task, outputs);
  const auto [width, height] = task.plan.size;
  if (!options.video.single_picture() && task.plan.size != options.video.asked_size())
    say(fmt::format("{} needs even sides: drawn at {}x{}", options.video.output_of(""), width, height));
  for (const std::string& note : task.subject.notes) say(note);
  int status = task.subject.check_results() ? 0 : 1;
  Filming filming(options, task, may_replace);
  for (const Output& output : outputs) {
    bool whole = true;
    const std::string name = options.video.output_of(output.name);
    if (name_given(name, [&] { whole = filming.make(output); }) != name) status = 1;
    if (!whole) {
      say("stopped early; the video ends there");
      return 1;
    }
  }
  return status;
}

}  // namespace

void add_render_command(const Command& program, const Choose& choose) {
  auto options = std::make_shared<RenderOptions>();
  const Command command = program.add_command("render", "Make a video or picture of robots, without a window");
  options->robots.add_to(command);
  command.find_option("ROBOTS")->with_help(
      "Robot files, folders, samples (sample:eel), a run; or up to four recordings, results (.json) and runs");
  options->video.add_to(command);
  options->view.add_to(command);
  options->film.add_to(command);
  options->output.add_to(command);
  options->simulation.add_to(command);
  add_start_options(command, options->start);
  command.set_footer(
      "Examples:\n"
      "  mercury render --random voxel:12 --seed 1 -o group.mp4\n"
      "  mercury render my-robots --environment land --size 1080p --seconds 20 --speed 2 -o land.webm\n"
      "  mercury render my-robots --layout race --environment land -o race.mp4\n"
      "  mercury render eel.json --camera turntable --color strain --seconds 4 -o eel.gif\n"
      "  mercury render eel.json --compare solver=xpbd -o sides.mp4\n"
      "  mercury render my-robots --contact-sheet 5x2 --seconds 9 -o poster.png\n"
      "  mercury render run.h5 -o run.mp4                    plays a recording of mercury run --record\n"
      "  mercury render RUN --lineage best -o ancestry.mp4   films a run of mercury evolve\n"
      "  mercury render RUN --map -o map.png\n"
      "  mercury render before.h5 after.json -o both.mp4     recordings, results (run --json) or runs, side by side\n"
      "  mercury render eel.json --still 2 --background transparent --tight --scale-bar --dpi 300 -o figure.png\n"
      "  mercury render my-robots --fps 60 -o frames/        a folder of PNG pictures");
  command.when_chosen(
      [options, choose] { choose([options] { return options->robots.status(render_robots(*options)); }); });
}

}  // namespace mercury
