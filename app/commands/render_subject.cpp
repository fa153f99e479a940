// SPDX-License-Identifier: Apache-2.0
#include "app/commands/render_subject.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "app/base/progress.h"
#include "app/recording/trajectory_layout.h"
#include "app/video/frame_writer.h"
#include "app/video/side_by_side.h"
#include "mercury/error.h"

namespace mercury {
namespace {

Subject recording_of(const RenderOptions& options, const std::filesystem::path& file) {
  if (options.video.each()) throw InputError("--each", "does not work with a recording; it is played as a whole");
  Subject subject{.clips = std::vector<Clip>(1), .recording = std::make_shared<TrajectoryReader>(file, shown_work())};
  const TrajectoryReader& recording = *subject.recording;
  if (recording.frames() == 0) throw InputError(file.string(), "holds no frames");
  subject.configuration = recording.configuration();
  subject.seconds = options.simulation.seconds(recording.time(recording.frames() - 1) - recording.time(0));
  return subject;
}

// Two recordings side by side, as long as the longer one.
std::optional<Subject> two_recordings_of(const RenderOptions& options) {
  const std::vector<std::filesystem::path> files = options.robots.files();
  if (files.size() != 2 || !std::ranges::all_of(files, is_readable_trajectory_name)) return std::nullopt;
  Subject subject = recording_of(options, files[0]), second = recording_of(options, files[1]);
  subject.second_recording = std::move(second.recording);
  subject.seconds = std::max(subject.seconds, second.seconds);
  return subject;
}

Subject robots_of(const RenderOptions& options) {
  options.simulation.check(options.robots.physics());  // errors in options come before those in files
  Subject subject;
  Clip& clip = subject.clips.emplace_back();
  LoadedRobots loaded = options.robots.load(drawn_memory);
  clip.robots = std::move(loaded.robots);
  subject.configuration = options.simulation.configuration(loaded.environments, subject.notes, loaded.physics);
  subject.seconds = options.simulation.seconds();
  return subject;
}

// How a run is shown, where the options do not say otherwise.
void set_view_of_run(const RenderOptions& options, const RunFilm& film, ViewSettings& view) {
  view.board = film.board;
  if (film.board) {
    if (view.compare) throw InputError("--compare", "not together with --map");
    if (view.color->has_values()) throw InputError("--color", "not together with --map, where colors show scores");
    if (view.camera.mode != CameraMode::group)
      throw InputError("--camera", "not together with --map; --azimuth and --elevation turn the robots");
    if (view.grid || view.layout != Layout::grid)
      throw InputError(view.grid ? "--grid" : "--layout", "not together with --map, which has a layout of its own");
    if (!options.view.chooses_what_is_shown()) view.shown.clock = !options.video.single_picture();
    return;
  }
  if (options.film.row() && !view.grid && view.layout != Layout::race)
    view.grid = Grid{.columns = static_cast<int>(film.clips.front().robots.size()), .rows = 1};
  if (options.view.chooses_what_is_shown()) return;
  view.shown.captions = view.shown.path = view.shown.scale_bar = true;
}

// A contact sheet of a lineage has one moment per ancestor, the end of its clip.
void plan_sheet_of_clips(const Subject& subject, VideoOptions::Plan& plan) {
  plan.timing.frames = 1;
  plan.timing.start = subject.seconds;
}

Subject run_of(RenderOptions& options, const std::filesystem::path& folder, ViewSettings& view) {
  constexpr double seconds_of_an_ancestor = 5;
  if (options.film.map() && options.video.each()) throw InputError("--each", "not together with --map");
  const RunHistory run(folder);
  const bool still = options.video.single_picture() && !options.video.contact_sheet();
  const bool in_order = options.film.lineage() && !still;
  const auto sheet = options.video.contact_sheet();
  RunFilm film = options.film.film(
      run,
      {.at_once = !in_order,
       .most_clips = sheet ? static_cast<std::size_t>(sheet->columns) * static_cast<std::size_t>(sheet->rows) : 0});
  set_view_of_run(options, film, view);
  return {.configuration = options.simulation.configuration_over(run.settings().evolution.configuration),
          .clips = std::move(film.clips),
          .seconds = in_order ? options.simulation.seconds(seconds_of_an_ancestor) : options.simulation.seconds(),
          .notes = std::move(film.notes)};
}

Subject subject_of(RenderOptions& options, ViewSettings& view) {
  options.film.validate();
  if (const auto run = options.robots.alone(is_run_folder, "a run is filmed alone; give it without other robots"))
    return run_of(options, *run, view);
  if (const std::string option = options.film.given(); !option.empty()) {
    const auto files = options.robots.files();
    throw InputError(option, "films a run of mercury evolve" +
                                 (files.empty() ? "; give its folder" : ", and " + files[0].string() + " is none"));
  }
  if (std::optional<Subject> sides = two_recordings_of(options)) return *std::move(sides);
  if (const auto file = options.robots.recording()) return recording_of(options, *file);
  return robots_of(options);
}

// Throws InputError for a moment that a recording does not have, or that a simulation would never reach.
void require_moment(const VideoOptions& video, const Subject& subject) {
  if (!video.still()) return;
  const double moment = *video.still();
  if (!subject.recording) {
    if (moment / subject.configuration.dt > 1e15)
      throw InputError("--still", fmt::format("{} s are too many steps of {} s", moment, subject.configuration.dt));
    return;
  }
  const TrajectoryReader& recording = *subject.recording;
  const double length = recording.time(recording.frames() - 1) - recording.time(0);
  // The run may have gone on for less than a frame after the last one.
  const double frame = static_cast<double>(recording.every()) * recording.configuration().dt;
  if (moment >= length + frame)
    throw InputError("--still", fmt::format("{} is not accepted; the recording has {:.6g} s", moment, length));
}

}  // namespace

Simulation Subject::simulation_of(const Clip& clip) const {
  return recording ? playback(recording) : Simulation(configuration, clip.robots, shown_work());
}

std::string Subject::comment(const Clip& clip) const {
  return comment_of(recording ? recording->robots().at(0).robot : *clip.robots.at(0), configuration);
}

std::optional<Simulation> Subject::second_of(const Clip& clip, const ViewSettings& view) const {
  if (second_recording) return playback(second_recording);
  if (!view.compare) return std::nullopt;
  return Simulation(view.compare->over(configuration), clip.robots, shown_work());
}

std::array<std::string, 2> Subject::titles() const {
  if (!second_recording) return {};
  return {recording->path().stem().string(), second_recording->path().stem().string()};
}

void check_options(RenderOptions& options) {
  if (options.film.map() || options.view.settings().background) options.video.set_usual_still(0);
  options.video.plan(options.simulation.seconds());
  options.view.settings();
}

RenderTask render_task(RenderOptions& options) {
  RenderTask task{.view = options.view.settings()};
  task.subject = subject_of(options, task.view);
  if (task.subject.recording && task.view.compare)
    throw InputError("--compare", "not together with a recording, which has one side; give its robots' files");
  task.plan = options.video.plan(task.subject.seconds);
  if (task.view.compare || task.subject.second_recording) halves_of(task.plan.size);
  require_moment(options.video, task.subject);
  if (task.view.background &&
      (!options.video.still() || task.view.compare || task.view.board || task.subject.second_recording))
    throw InputError("--background", "is of a still of robots; give --still S, without --compare and --map");
  if (options.video.tight() && !task.view.background)
    throw InputError("--tight", "cuts a figure off; give --background, too");
  if (options.video.text_aside() && !task.view.background)
    throw InputError("-o", "an .svg is a figure; give --background, too");
  if (task.subject.clips.size() > 1 && options.video.contact_sheet()) plan_sheet_of_clips(task.subject, task.plan);
  task.view.interop = options.video.interop();
  task.view.speed = options.video.single_picture() ? 1 : options.video.speed();
  return task;
}

}  // namespace mercury
