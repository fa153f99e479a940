// SPDX-License-Identifier: Apache-2.0
#include "app/window/picture/robot_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace mercury::window {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> robot_extensions{".json", ".cbor"};
const std::vector<const char*> robot_formats{"JSON", "CBOR"};

void save_one(Desk& desk, const RobotEntry& robot) {
  const fs::path file = robot.file.empty()
                            ? fs::path(desk.preferences.save_folder) / (file_name_of(robot.name) + ".json")
                            : fs::path(robot.file);
  desk.dialogs.ask_files({.kind = FileQuestion::Kind::save,
                          .title = "Save " + robot.name,
                          .button = "Save",
                          .extensions = robot_extensions,
                          .folder = file.parent_path(),
                          .name = file.filename().string(),
                          .formats = robot_formats},
                         [&desk, id = robot.id](const FileAnswer& answer) {
                           const fs::path path = answer.paths.front();
                           desk.preferences.save_folder = path.parent_path().string();
                           save_with_care(desk, "robot", [&desk, id, path](bool overwrite) {
                             return desk.scene.save(id, path, overwrite);
                           });
                         });
}

void save_many(Desk& desk, const std::vector<RobotId>& robots) {
  desk.dialogs.ask_files({.kind = FileQuestion::Kind::folder,
                          .title = fmt::format("Save {} robots, one file each", robots.size()),
                          .button = "Save here",
                          .extensions = robot_extensions,
                          .folder = desk.preferences.save_folder,
                          .name = "",
                          .formats = robot_formats},
                         [&desk, robots](const FileAnswer& answer) {
                           const fs::path folder = answer.paths.front();
                           const RobotFormat format = answer.format == 1 ? RobotFormat::cbor : RobotFormat::json;
                           desk.preferences.save_folder = folder.string();
                           save_with_care(desk, fmt::format("{} robots", robots.size()),
                                          [&desk, robots, folder, format](bool overwrite) {
                                            return desk.scene.save_all(robots, folder, format, overwrite);
                                          });
                         });
}

// Random robots come again from their seed, those of a file from it.
std::vector<RobotId> robots_to_lose(const LiveScene& scene) {
  std::vector<RobotId> lost;
  for (const RobotEntry& robot : scene.entries()) {
    const DocumentRobot* document = scene.document().find(robot.id);
    const bool random = document && document->source.generation;
    if (robot.unsaved && (robot.tuned || !random)) lost.push_back(robot.id);
  }
  return lost;
}

}  // namespace

void open_robots(Desk& desk) {
  desk.dialogs.ask_files({.kind = FileQuestion::Kind::open,
                          .title = "Open robots",
                          .button = "Open",
                          .extensions = {".json", ".cbor", ".repro", ".h5"},
                          .folder = desk.preferences.open_folder,
                          .name = "",
                          .formats = {}},
                         [&desk](const FileAnswer& answer) {
                           desk.preferences.open_folder = answer.paths.front().parent_path().string();
                           desk.scene.open(answer.paths);
                         });
}

void save_robots(Desk& desk) {
  const std::vector<RobotId> robots = chosen_robots(desk.scene);
  if (robots.empty()) {
    desk.toasts.say(Tone::news, "there are no robots to save");
    return;
  }
  if (robots.size() > 1) {
    save_many(desk, robots);
    return;
  }
  for (const RobotEntry& entry : desk.scene.entries())
    if (entry.id == robots.front()) save_one(desk, entry);
}

void save_csv(Desk& desk, const std::string& what, std::function<std::string()> make) {
  desk.dialogs.ask_files({.kind = FileQuestion::Kind::save,
                          .title = "Save " + what,
                          .button = "Save",
                          .extensions = {".csv"},
                          .folder = desk.preferences.save_folder,
                          .name = what + ".csv",
                          .formats = {}},
                         [&desk, what, make = std::move(make)](const FileAnswer& answer) {
                           const fs::path path = answer.paths.front();
                           desk.preferences.save_folder = path.parent_path().string();
                           save_with_care(desk, what, [&desk, path, text = make()](bool overwrite) {
                             return desk.scene.save_text(path, text, overwrite);
                           });
                         });
}

void quit_with_care(Desk& desk, std::function<void()> quit) {
  const std::vector<RobotId> lost = robots_to_lose(desk.scene);
  if (lost.empty()) {
    quit();
    return;
  }
  desk.observations.tell("asks", {{"what", "quit"}});
  const std::string question = lost.size() == 1
                                   ? "One robot was made or changed here and is not saved."
                                   : fmt::format("{} robots were made or changed here and are not saved.", lost.size());
  desk.dialogs.ask({.title = "Quit without saving?",
                    .text = question,
                    .button = "Quit",
                    .act = std::move(quit),
                    .other_button = "Save...",
                    .other_act = [&desk, lost] {
                      desk.scene.clear_selection();
                      for (const RobotId robot : lost) desk.scene.select(robot, false);
                      save_robots(desk);
                    }});
}

}  // namespace mercury::window
