// SPDX-License-Identifier: Apache-2.0
// What the window's scene writes: robot files, commands, tables, videos and repros of explosions.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <map>
#include <utility>

#include "app/base/csv.h"
#include "app/live/live_scene_parts.h"
#include "app/live/scene_text.h"
#include "mercury/robot_file.h"

namespace mercury {
namespace {

namespace fs = std::filesystem;

SaveResult failed(const std::string& message) { return {SaveResult::Outcome::failed, {}, message}; }

}  // namespace

SaveResult LiveScene::save(RobotId robot, const fs::path& path, bool overwrite) {
  const DocumentRobot* found = parts_->document.find(robot);
  if (!found) return failed("the robot is no longer there");
  try {
    const SaveResult result =
        save_files({{path, serialize_robot(whole_robot(*found), robot_format_of(path))}}, overwrite);
    if (result.ok()) parts_->saved[robot] = {path.string(), found->body};
    return result;
  } catch (const std::exception& error) {
    return failed(error.what());
  }
}

SaveResult LiveScene::save_all(const std::vector<RobotId>& robots, const fs::path& folder, RobotFormat format,
                               bool overwrite) {
  std::vector<FileToSave> files;
  std::vector<const DocumentRobot*> saved_robots;
  std::set<std::string> taken;
  try {
    for (const RobotId id : robots) {
      const DocumentRobot* robot = parts_->document.find(id);
      if (!robot) continue;
      const std::string base = file_name_of(robot->body.name);
      std::string name = base;
      for (int count = 2; !taken.insert(name).second; ++count) name = fmt::format("{}-{}", base, count);
      const fs::path path = folder / (name + (format == RobotFormat::json ? ".json" : ".cbor"));
      files.push_back({path, serialize_robot(whole_robot(*robot), format)});
      saved_robots.push_back(robot);
    }
  } catch (const std::exception& error) {
    return failed(error.what());
  }
  if (files.empty()) return failed("there is no robot to save");
  const SaveResult result = save_files(files, overwrite);
  for (std::size_t i = 0; i < saved_robots.size() && result.ok(); ++i)
    parts_->saved[saved_robots[i]->body.id] = {files[i].path.string(), saved_robots[i]->body};
  return result;
}

SaveResult LiveScene::save_scene(const fs::path& path, bool overwrite) {
  Parts& parts = *parts_;
  std::vector<SceneRobot> robots;
  for (const DocumentRobot& robot : parts.document.robots)
    robots.push_back({&robot, parts.is_saved(robot) ? parts.file_of(robot.body.id) : ""});
  if (robots.empty()) return failed("there is no robot to save in a scene");
  try {
    const SceneFiles wanted =
        scene_files(path, robots, parts.document.configuration, parts.view, attached_in(parts.document));
    const SaveResult result = save_files(wanted.files, overwrite);
    for (std::size_t i = 0; i < wanted.beside.size() && result.ok(); ++i) {
      const LiveRobot& body = robots[wanted.beside[i]].robot->body;
      parts.saved[body.id] = {wanted.files[i].path.string(), body};
    }
    return result;
  } catch (const std::exception& error) {
    return failed(error.what());
  }
}

std::optional<CameraPlan> LiveScene::take_camera() { return std::exchange(parts_->camera, std::nullopt); }

CommandText LiveScene::command(const std::string& subcommand) const {
  SceneDocument document = parts_->document;
  for (DocumentRobot& robot : document.robots) {
    const auto saved = parts_->saved.find(robot.body.id);
    if (saved == parts_->saved.end()) continue;
    robot.source.file = saved->second.file;
    // Materials that are equal to those of the file need no note.
    if (saved->second.body.robot == robot.body.robot && saved->second.body.materials == robot.body.materials)
      robot.body.materials.reset();
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
        lines[row] += fmt::format(",{}", series.samples[i].of(measure.measure));
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
  return std::make_unique<GroupVideo>(std::move(robots), parts_->document.configuration, parts_->view, options);
}

SaveResult LiveScene::save_repro(RobotId robot, const fs::path& folder, bool overwrite) {
  const DocumentRobot* found = parts_->document.find(robot);
  if (!found) return failed("the robot is no longer there");
  try {
    const std::optional<Repro> repro = parts_->physics.repro(robot);
    if (!repro) return failed(found->body.name + " has not exploded since the last reset");
    return save_files({{folder / (file_name_of(found->body.name) + ".repro"), serialize_repro(*repro)}}, overwrite);
  } catch (const std::exception& error) {
    return failed(error.what());
  }
}

}  // namespace mercury
