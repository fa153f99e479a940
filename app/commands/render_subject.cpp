// SPDX-License-Identifier: Apache-2.0
#include "app/commands/render_subject.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "app/base/progress.h"
#include "app/export/recorded_motion.h"
#include "app/recording/trajectory_layout.h"
#include "app/scene/hero_style.h"
#include "app/video/frame_writer.h"
#include "app/video/side_by_side.h"
#include "mercury/error.h"

namespace mercury {
namespace {

constexpr double hero_moment = 3;  // of the style "hero", without --still [s]

Subject recording_of(const RenderOptions& options, const std::filesystem::path& file) {
  if (options.video.each()) throw InputError("--each", "does not work with a recording; it is played as a whole");
  Subject subject{.clips = std::vector<Clip>(1), .recording = std::make_shared<TrajectoryReader>(file, shown_work())};
  const TrajectoryReader& recording = *subject.recording;
  if (recording.frames() == 0) throw InputError(file.string(), "holds no frames");
  subject.configuration = recording.configuration();
  subject.seconds = options.simulation.seconds(recording.time(recording.frames() - 1) - recording.time(0));
  return subject;
}

Subject result_of(const RenderOptions& options, const std::filesystem::path& file) {
  const auto result = std::make_shared<RunResult>(read_result(file));
  Subject subject{.configuration = options.simulation.configuration_over(result->configuration),
                  .clips = std::vector<Clip>(1),
                  .result = result,
                  .seconds = options.simulation.seconds(result->seconds)};
  subject.of_result = robots_of(*result, options.robots);
  subject.clips.front().robots = subject.of_result;
  return subject;
}

Subject robots_of(const RenderOptions& options) {
  options.simulation.check(options.robots.physics());  // errors in options come before those in files
  Subject subject;
  Clip& clip = subject.clips.emplace_back();
  LoadedRobots loaded = options.robots.load(drawn_memory);
  clip.robots = std::move(loaded.robots);
  subject.configuration = options.simulation.configuration_of(loaded, subject.notes);
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

// The best robots of a run beside something else.
Subject best_of(const RenderOptions& options, const std::filesystem::path& folder) {
  const RunHistory run(folder);
  RunFilm film = options.film.film(run, {.at_once = true});
  film.clips.front().title.clear();
  return {.configuration = options.simulation.configuration_over(run.settings().evolution.configuration),
          .clips = std::move(film.clips),
          .seconds = options.simulation.seconds()};
}

// Recordings, results and runs side by side, as long as the longest recording or result.
std::optional<Subject> side_by_side(const RenderOptions& options, ViewSettings& view) {
  constexpr std::size_t most = 4;
  const auto is_run = [](const std::filesystem::path& path) { return is_run_folder(path); };
  const auto can_stand = [&](const std::filesystem::path& path) {
    return is_readable_trajectory_name(path) || is_run(path) || is_result(path);
  };
  const std::vector<std::filesystem::path> files = options.robots.files();
  if (files.size() < 2 || options.robots.has_random() || !std::ranges::all_of(files, can_stand)) return std::nullopt;
  if (files.size() > most)
    throw InputError(files[most].string(),
                     fmt::format("at most {} recordings, results and runs stand side by side", most));
  if (const std::string option = options.film.given(); !option.empty() && option != "--best")
    throw InputError(option, "is of one run; beside others only its best are shown (--best N)");
  std::vector<Subject> sides;
  double recorded = 0;
  for (const std::filesystem::path& file : files) {
    Subject& side = sides.emplace_back(is_run(file)      ? best_of(options, file)
                                       : is_result(file) ? result_of(options, file)
                                                         : recording_of(options, file));
    if (!is_run(file)) recorded = std::max(recorded, side.seconds);
    side.title =
        is_run(file) ? (file / ".").lexically_normal().parent_path().filename().string() : file.stem().string();
  }
  if (!options.view.chooses_what_is_shown()) view.shown.captions = std::ranges::any_of(files, is_run);
  Subject subject = std::move(sides.front());
  subject.seconds = recorded > 0 ? recorded : subject.seconds;
  subject.others.assign(std::make_move_iterator(sides.begin() + 1), std::make_move_iterator(sides.end()));
  return subject;
}

Subject subject_of(RenderOptions& options, ViewSettings& view) {
  options.film.validate();
  const bool are_chosen = !options.robots.chosen_of_runs().empty();
  if (!are_chosen) {
    if (std::optional<Subject> sides = side_by_side(options, view)) return *std::move(sides);
    if (const auto run = options.robots.alone(is_run_folder, "a run is filmed alone; give it without other robots"))
      return run_of(options, *run, view);
  }
  const auto result = options.robots.alone(
      is_result, "a result stands beside recordings, results and runs; give it without other robots");
  if (const std::string option = options.film.given(); !option.empty()) {
    if (are_chosen) throw InputError("--robot", "not together with " + option);
    const auto files = options.robots.files();
    throw InputError(option, "films a run of mercury evolve" +
                                 (files.empty() ? "; give its folder" : ", and " + files[0].string() + " is none"));
  }
  if (const auto file = options.robots.recording()) return recording_of(options, *file);
  return result ? result_of(options, *result) : robots_of(options);
}

// Throws InputError for a moment that a recording does not have, or that a simulation would never reach.
void require_moment(const VideoOptions& video, const Subject& subject) {
  if (!video.still()) return;
  const double moment = *video.still();
  if (subject.recording) return require_moment(*subject.recording, "still", moment);
  if (moment / subject.configuration.dt > 1e15)
    throw InputError("--still", fmt::format("{} s are too many steps of {} s", moment, subject.configuration.dt));
}

// A recording begins where it does.
void require_start(const TrialSettings& start, const Subject& subject) {
  if (subject.recording) require_start_of_recording(start);
}

// The first robot, with the others or copies of itself behind it.
void show_as_hero(const RenderOptions& options, RenderTask& task) {
  if (task.view.board || task.view.compare || !task.subject.others.empty())
    throw InputError("--style", "hero shows one group of robots; leave out --map, --compare and further recordings");
  set_hero_style(task.view, task.subject.configuration.environment);
  if (!options.view.chooses_what_is_shown()) task.view.shown.clock = false;
  if (task.subject.recording) return;
  for (Clip& clip : task.subject.clips) {
    clip.captions.clear();
    add_siblings(clip.robots, task.subject.configuration.environment);
  }
}

}  // namespace

Simulation Subject::simulation(const Configuration& in, const Clip& clip) const {
  Simulation simulation(in, clip.robots, shown_work());
  if (start.is_elsewhere()) begin_at(simulation, start);
  return simulation;
}

std::vector<FilmedGroup> Subject::groups_of(const Clip& clip, const ViewSettings& view) const {
  const auto group = [](const Subject& subject, const Clip& of, const std::string& above) -> FilmedGroup {
    if (!subject.recording) return {subject.simulation(subject.configuration, of), of.captions, above};
    const auto share = std::make_shared<float>();
    return {playback(subject.recording, share), of.captions, above, share};
  };
  std::vector<FilmedGroup> groups;
  groups.push_back(group(*this, clip, others.empty() ? "" : title));
  for (const Subject& other : others) groups.push_back(group(other, other.clips.front(), other.title));
  if (view.compare) groups.push_back({simulation(view.compare->over(configuration), clip), clip.captions});
  return groups;
}

bool Subject::check_results() const {
  bool same = !result || check_again(*result, of_result, configuration.device);
  for (const Subject& other : others) same = other.check_results() && same;
  return same;
}

std::string Subject::comment(const Clip& clip) const {
  return comment_of(recording ? recording->robots().at(0).robot : *clip.robots.at(0), configuration);
}

void check_options(RenderOptions& options) {
  if (options.film.map() || options.view.settings().background) options.video.set_usual_still(0);
  if (options.video.hero() || options.video.aperture() > 0) options.video.set_usual_still(hero_moment);
  options.video.plan(options.simulation.seconds());
  options.view.settings();
  validate(options.start);
}

RenderTask render_task(RenderOptions& options) {
  RenderTask task{.view = options.view.settings()};
  task.subject = subject_of(options, task.view);
  for (const Subject& other : task.subject.others) require_start(options.start, other);
  require_start(options.start, task.subject);
  task.subject.start = {options.start, options.robots.seed_or_default()};
  for (Subject& other : task.subject.others) other.start = task.subject.start;
  if ((task.subject.recording || !task.subject.others.empty()) && task.view.compare)
    throw InputError("--compare", "not together with a recording, which has one side; give its robots' files");
  task.plan = options.video.plan(task.subject.seconds);
  const std::size_t sides = (task.view.compare ? 2 : 1) + task.subject.others.size();
  if (sides > 1) columns_of(task.plan.size, static_cast<int>(sides));
  require_moment(options.video, task.subject);
  if (task.view.background && task.view.board) throw InputError("--background", "not together with --map");
  if (task.view.background) options.video.plan_figure(*task.view.background, task.plan);
  if (options.video.tight() && !(task.view.background && options.video.still()))
    throw InputError("--tight", "cuts a figure off; give --background and --still, too");
  if (options.video.text_aside() && (!task.view.background || sides > 1))
    throw InputError("-o", "an .svg or .pdf is a figure; give --background, and one group of robots");
  if (task.subject.clips.size() > 1 && options.video.contact_sheet()) plan_sheet_of_clips(task.subject, task.plan);
  task.view.interop = options.video.interop();
  if (options.video.aperture() > 0) task.view.aperture = options.video.aperture();
  if (options.video.hero()) show_as_hero(options, task);
  task.view.speed = options.video.single_picture() ? 1 : options.video.speed();
  return task;
}

}  // namespace mercury
