// SPDX-License-Identifier: Apache-2.0
// What the window's scene writes: robot files, commands, tables, videos, repros of explosions, and current poses and
// motions for other programs.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <map>
#include <thread>
#include <utility>

#include "app/base/child_process.h"
#include "app/base/output_files.h"
#include "app/export/export.h"
#include "app/export/simulated_motion.h"
#include "app/live/live_scene_parts.h"
#include "app/live/scene_text.h"
#include "mercury/robot_file.h"
#include "mercury/simulation.h"

namespace mercury {
namespace {

namespace fs = std::filesystem;

// As frames show it: with its colors, its name and its materials as they are in the window.
struct Exported {
  LiveRobot live;
  Robot robot;
  std::vector<Material> materials;
  Exported(const LiveRobot& given)
      : live(given), robot(*given.robot),
        materials(mercury::materials_of(given).begin(), mercury::materials_of(given).end()) {
    robot.name = live.name;
  }
  ExportedRobot in(const Environment& environment) const {
    return {.robot = robot, .materials = materials, .environment = environment};
  }
};

std::vector<fs::path> existing_outputs(const ExportFormat& format, const fs::path& path) {
  std::vector<fs::path> outputs{path}, found;
  if (format.files_beside) std::ranges::copy(format.files_beside(path), std::back_inserter(outputs));
  if (format.folder_beside) outputs.push_back(format.folder_beside(path));
  std::ranges::copy_if(outputs, std::back_inserter(found),
                       [](const fs::path& output) { return fs::exists(fs::symlink_status(output)); });
  return found;
}

void make_folder_of(const fs::path& path) {
  if (path.has_parent_path()) fs::create_directories(path.parent_path());
}

struct Canceled {};

void require_going(const WorkControl& control) {
  if (control.canceled()) throw Canceled();
}

// Simulates the robots from time 0. Returns the number of frames.
std::int64_t record(const std::vector<Exported>& exported, const Configuration& configuration, const TrialStart& start,
                    const fs::path& path, double seconds, WorkControl& control) {
  std::vector<LiveRobot> robots;
  for (const Exported& one : exported) robots.push_back(one.live);
  Simulation simulation = simulation_of(robots, configuration, start);
  return record_motion(simulation, seconds, path, std::nullopt,
                       [&](std::int64_t frames) {
                         require_going(control);
                         control.progress(frames);
                       })
      .frames;
}

void write_motions(const ExportFormat& format, const std::vector<Exported>& exported,
                   const Configuration& configuration, const fs::path& recorded, const fs::path& path,
                   Messages& messages, const FrameWatch& watch) {
  const auto recording = std::make_shared<TrajectoryReader>(recorded);
  std::vector<RecordedMotion> motions;
  for (std::size_t robot = 0; robot < exported.size(); ++robot) {
    motions.emplace_back(recording, robot);
    if (!motions.back().problem().empty()) messages.add(Severity::warning, motions.back().problem());
  }
  if (format.motions)
    format.motions(motions, path, {.watch = watch});
  else
    format.motion(exported.front().in(configuration.environment), motions.front(), path, {.watch = watch});
}

// Runs a program to its end, or until the work is canceled. Returns why it failed, in one line; empty = it did not.
std::string run_to_end(const fs::path& program, const std::vector<std::string>& words, const WorkControl& control) {
  ChildProcess process(program.string(), words);
  while (process.running()) {
    if (control.canceled()) throw Canceled();
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  if (process.finish() == 0) return {};
  std::string line = process.messages();
  while (line.ends_with('\n')) line.pop_back();
  line.erase(0, line.rfind('\n') + 1);
  return line.starts_with("mercury: ") ? line.substr(9) : "mercury export failed: " + line;
}

}  // namespace

SaveResult LiveScene::save(RobotId robot, const fs::path& path, bool overwrite) {
  const DocumentRobot* found = parts_->document.find(robot);
  if (!found) return not_saved("the robot is no longer there");
  try {
    const SaveResult result =
        save_files({{path, serialize_robot(whole_robot(*found), robot_format_of(path))}}, overwrite);
    if (result.ok()) parts_->saved.note(found->body, path.string());
    return result;
  } catch (const std::exception& error) {
    return not_saved(error.what());
  }
}

SaveResult LiveScene::save_all(const std::vector<RobotId>& robots, const fs::path& folder, RobotFormat format,
                               bool overwrite) {
  std::vector<FileToSave> files;
  std::vector<const DocumentRobot*> saved_robots;
  FileNames names;
  try {
    for (const RobotId id : robots) {
      const DocumentRobot* robot = parts_->document.find(id);
      if (!robot) continue;
      const fs::path path = folder / (names.of(robot->body.name) + (format == RobotFormat::json ? ".json" : ".cbor"));
      files.push_back({path, serialize_robot(whole_robot(*robot), format)});
      saved_robots.push_back(robot);
    }
  } catch (const std::exception& error) {
    return not_saved(error.what());
  }
  if (files.empty()) return not_saved("there is no robot to save");
  const SaveResult result = save_files(files, overwrite);
  for (std::size_t i = 0; i < saved_robots.size() && result.ok(); ++i)
    parts_->saved.note(saved_robots[i]->body, files[i].path.string());
  return result;
}

SaveResult LiveScene::save_scene(const fs::path& path, bool overwrite) {
  Parts& parts = *parts_;
  std::vector<SceneRobot> robots;
  for (const DocumentRobot& robot : parts.document.robots)
    robots.push_back({&robot, parts.saved.holds(robot.body) ? *parts.saved.file_of(robot.body.id) : ""});
  if (robots.empty()) return not_saved("there is no robot to save in a scene");
  try {
    const SceneFiles wanted = scene_files(path, robots, parts.document.configuration, parts.view,
                                          held_in(parts.document), parts.document.start);
    const SaveResult result = save_files(wanted.files, overwrite);
    for (std::size_t i = 0; i < wanted.beside.size() && result.ok(); ++i) {
      parts.saved.note(robots[wanted.beside[i]].robot->body, wanted.files[i].path.string());
    }
    if (result.ok()) parts.scene_file = path;
    return result;
  } catch (const std::exception& error) {
    return not_saved(error.what());
  }
}

const fs::path& LiveScene::scene_file() const { return parts_->scene_file; }

std::optional<CameraPlan> LiveScene::take_camera() { return std::exchange(parts_->camera, std::nullopt); }

CommandText LiveScene::command(const std::string& subcommand) const {
  SceneDocument document = parts_->document;
  for (DocumentRobot& robot : document.robots) {
    if (const auto file = parts_->saved.file_of(robot.body.id)) robot.source.file = *file;
    // Materials that are equal to those of the file need no note.
    if (parts_->saved.has_body(robot.body)) robot.body.materials.reset();
  }
  return command_text(document, parts_->view, subcommand);
}

std::string LiveScene::csv(const std::vector<RobotId>& robots) const {
  std::string header = "time [s]";
  std::map<double, std::size_t> rows;  // time -> row
  std::vector<Series> all;
  for (const RobotId id : robots) {
    const DocumentRobot* robot = parts_->document.find(id);
    if (!robot) continue;
    for (const MeasureName& measure : measures())
      header.append(",").append(csv_field(fmt::format("{} {} [{}]", robot->body.name, measure.name, measure.unit)));
    all.push_back(series(id));
    for (const double time : all.back().times) rows.emplace(time, 0);
  }
  std::vector<std::string> lines;
  for (auto& [time, row] : rows) {
    row = lines.size();
    lines.push_back(csv_number(time));
  }
  for (const Series& series : all) {
    std::vector<bool> filled(lines.size());
    for (std::size_t i = 0; i < series.times.size(); ++i) {
      const std::size_t row = rows.at(series.times[i]);
      filled[row] = true;
      for (const MeasureName& measure : measures())
        if (const float value = series.samples[i].of(measure.measure); std::isnan(value))
          lines[row] += ',';
        else
          lines[row] += fmt::format(",{}", value);
    }
    for (std::size_t row = 0; row < lines.size(); ++row)
      if (!filled[row]) lines[row].append(measures().size(), ',');
  }
  std::string text = header + "\n";
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

std::string LiveScene::ranking_csv() const {
  std::string text =
      "name,distance [m],mean speed [m/s],age [s],distance at equal age [m],speed [m/s],kinetic energy [J],elastic "
      "energy "
      "[J],largest strain,exploded at [s]\n";
  std::vector<RankingRow> rows = ranking();
  std::ranges::stable_sort(rows,
                           [](const auto& a, const auto& b) { return ranks_before(a, b, a.distance, b.distance); });
  for (const RankingRow& row : rows) {
    const DocumentRobot* robot = parts_->document.find(row.robot);
    if (!robot) continue;
    text += csv_field(robot->body.name);
    for (const double figure : {row.distance, row.mean_speed, row.age, row.distance_at_equal_age, row.speed,
                                row.kinetic_energy, row.elastic_energy, row.largest_strain})
      text.append(1, ',').append(row.counts() ? csv_number(figure) : "");
    text.append(1, ',').append(row.exploded ? csv_number(row.exploded_at) : "").append(1, '\n');
  }
  return text;
}

SaveResult LiveScene::save_text(const fs::path& path, const std::string& text, bool overwrite) {
  return save_files({{path, text}}, overwrite);
}

std::unique_ptr<GroupVideo> LiveScene::export_video(const GroupVideoOptions& options) const {
  std::vector<LiveRobot> robots;
  for (const DocumentRobot& robot : parts_->document.robots)
    if (!parts_->hidden.contains(robot.body.id)) robots.push_back(robot.body);
  GroupVideoOptions wanted = options;
  wanted.start = parts_->document.start;
  return std::make_unique<GroupVideo>(std::move(robots), parts_->document.configuration, parts_->view, wanted);
}

SaveResult LiveScene::save_repro(RobotId robot, const fs::path& folder, bool overwrite) {
  const DocumentRobot* found = parts_->document.find(robot);
  if (!found) return not_saved("the robot is no longer there");
  try {
    const std::optional<Repro> repro = parts_->physics.repro(robot);
    if (!repro) return not_saved(found->body.name + " has not exploded since the last reset");
    return save_files({{folder / (file_name_of(found->body.name) + ".repro"), serialize_repro(*repro)}}, overwrite);
  } catch (const std::exception& error) {
    return not_saved(error.what());
  }
}

SaveResult LiveScene::export_pose(RobotId robot, const fs::path& path, bool overwrite) {
  const DocumentRobot* found = parts_->document.find(robot);
  const auto index = parts_->snapshot->robots->index_of(robot);
  if (!found || !index) return not_saved("the robot is no longer there");
  const Snapshot& snapshot = *parts_->snapshot;
  try {
    const ExportFormat& format = format_for(path, "");
    Exported exported(found->body);
    exported.materials = snapshot.details.driven.of(*index, exported.materials);
    require_pose(format, exported.robot, false);
    const Pose pose{.time = snapshot.time,
                    .positions = snapshot.positions_of(*index),
                    .velocities = snapshot.velocities_of(*index)};
    if (!is_finite(pose.positions)) return not_saved(found->body.name + " has exploded: its positions are no numbers");
    if (const auto files = existing_outputs(format, path); !overwrite && !files.empty())
      return {SaveResult::Outcome::exists, files, ""};
    make_folder_of(path);
    format.pose(exported.in(snapshot.configuration.environment), pose, path, {});
    return {SaveResult::Outcome::saved, {path}, ""};
  } catch (const std::exception& error) {
    return not_saved(error.what());
  }
}

SaveResult LiveScene::export_motion(const std::vector<RobotId>& robots, const fs::path& path, double seconds,
                                    bool overwrite) {
  const Configuration configuration = parts_->document.configuration;
  if (!(seconds > 0 && seconds / configuration.dt < 1e9)) return not_saved("give a number of seconds above 0");
  try {
    const ExportFormat& format = format_for(path, "");
    std::vector<Exported> exported;
    for (const RobotId robot : robots)
      if (const DocumentRobot* found = parts_->document.find(robot)) exported.emplace_back(found->body);
    if (exported.empty()) return not_saved("the robot is no longer there");
    for (const Exported& one : exported) require_motion(format, one.robot, false);
    if (exported.size() > 1 && !format.motions)
      return not_saved(fmt::format("a {} file holds one robot; select one, or give {}", format.name,
                                   format_names([](const ExportFormat& other) { return other.motions != nullptr; })));
    if (const auto files = existing_outputs(format, path); !overwrite && !files.empty())
      return {SaveResult::Outcome::exists, files, ""};
    make_folder_of(path);
    const auto frames = motion_frames(seconds);
    const auto all = static_cast<std::int64_t>(exported.size()) * frames;
    parts_->background.begin("exporting " + path.filename().string(), frames + all,
                             [&messages = parts_->messages, &format, exported = std::move(exported), configuration,
                              start = parts_->document.start, path, seconds](WorkControl& control) {
                               try {
                                 const TemporaryRecording recording(path);
                                 const std::int64_t recorded =
                                     record(exported, configuration, start, recording.path(), seconds, control);
                                 write_motions(format, exported, configuration, recording.path(), path, messages,
                                               [&](std::size_t done, std::size_t) {
                                                 require_going(control);
                                                 control.progress(recorded + static_cast<std::int64_t>(done));
                                               });
                                 messages.add(Severity::note, "exported " + path.string());
                               } catch (const Canceled&) {
                               }
                               return Background::Finish([] {});
                             });
    return {SaveResult::Outcome::saved, {path}, ""};
  } catch (const std::exception& error) {
    return not_saved(error.what());
  }
}

SaveResult LiveScene::export_run(const fs::path& run, const std::vector<std::string>& words, const fs::path& path,
                                 bool overwrite, const fs::path& program) {
  try {
    if (!overwrite && fs::exists(fs::symlink_status(path))) return {SaveResult::Outcome::exists, {path}, ""};
    std::vector<std::string> all{"export", run.string(), "--output=" + path.string(), "--force", "--quiet"};
    all.insert(all.end(), words.begin(), words.end());
    parts_->background.begin("exporting " + path.filename().string(), 0,
                             [&messages = parts_->messages, program, all, path](const WorkControl& control) {
                               try {
                                 const std::string failure = run_to_end(program, all, control);
                                 if (failure.empty())
                                   messages.add(Severity::note, "exported " + path.string());
                                 else
                                   messages.add(Severity::error, failure);
                               } catch (const Canceled&) {
                               }
                               return Background::Finish([] {});
                             });
    return {SaveResult::Outcome::saved, {path}, ""};
  } catch (const std::exception& error) {
    return not_saved(error.what());
  }
}

}  // namespace mercury
