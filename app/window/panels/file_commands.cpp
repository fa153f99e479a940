// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/file_commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/window/panels/evolution_commands.h"
#include "app/window/panels/robot_commands.h"
#include "app/window/panels/saving.h"
#include "app/window/panels/scene_commands.h"

namespace mercury::window {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> robot_extensions{".json", ".cbor"};
const std::vector<const char*> robot_formats{"JSON", "CBOR"};

void save_one(PanelContext& context, const RobotEntry& robot) {
  const fs::path file = robot.file.empty()
                            ? fs::path(context.preferences.save_folder) / (file_name_of(robot.name) + ".json")
                            : fs::path(robot.file);
  context.dialogs.ask_files({.kind = FileRequest::Kind::save,
                             .title = "Save " + robot.name,
                             .button = "Save",
                             .extensions = robot_extensions,
                             .folder = file.parent_path(),
                             .name = file.filename().string(),
                             .formats = robot_formats},
                            [&context, id = robot.id](const FileChoice& answer) {
                              const fs::path path = answer.paths.front();
                              save_with_confirmation(context, "robot", [&context, id, path](bool overwrite) {
                                return context.scene.save(id, path, overwrite);
                              });
                            });
}

void save_many(PanelContext& context, const std::vector<RobotId>& robots) {
  context.dialogs.ask_files({.kind = FileRequest::Kind::folder,
                             .title = fmt::format("Save {} robots, one file each", robots.size()),
                             .button = "Save here",
                             .extensions = robot_extensions,
                             .folder = context.preferences.save_folder,
                             .name = "",
                             .formats = robot_formats},
                            [&context, robots](const FileChoice& answer) {
                              const fs::path folder = answer.paths.front();
                              const RobotFormat format = answer.format == 1 ? RobotFormat::cbor : RobotFormat::json;
                              save_with_confirmation(context, fmt::format("{} robots", robots.size()),
                                                     [&context, robots, folder, format](bool overwrite) {
                                                       return context.scene.save_all(robots, folder, format, overwrite);
                                                     });
                            });
}

// Robots that neither a seed nor a file can bring back.
std::vector<RobotId> robots_to_lose(const LiveScene& scene) {
  std::vector<RobotId> lost;
  for (const RobotEntry& robot : scene.entries()) {
    const DocumentRobot* document = scene.document().find(robot.id);
    const bool random = document && document->source.generation;
    if (robot.unsaved && (robot.tuned || !random)) lost.push_back(robot.id);
  }
  return lost;
}

// Asks what becomes of the window's own evolution before it goes on to `quit`.
void end_evolution(PanelContext& context, std::function<void()> quit) {
  LiveRun& run = context.run;
  if (run.activity() != LiveRun::Activity::running) {
    quit();
    return;
  }
  context.log.write("asks", {{"what", "evolution"}});
  context.dialogs.ask({.title = "An evolution is running",
                       .text = run.evolving().string() + " can be resumed later if it stops now.",
                       .button = "Stop it",
                       .on_accept =
                           [&run, quit] {
                             run.stop();
                             quit();
                           },
                       .other_button = "Leave it running",
                       .on_other =
                           [&run, quit] {
                             run.leave_running();
                             quit();
                           }});
}

}  // namespace

void open_robots(PanelContext& context) {
  context.dialogs.ask_files({.kind = FileRequest::Kind::open,
                             .title = "Open robots or a scene",
                             .button = "Open",
                             .extensions = {".json", ".cbor", ".repro", ".h5", ".toml"},
                             .folder = context.preferences.open_folder,
                             .name = "",
                             .formats = {}},
                            [&context](const FileChoice& answer) {
                              const fs::path& first = answer.paths.front();
                              context.preferences.open_folder = first.parent_path().string();
                              if (first.extension() == ".toml") context.preferences.scene = first.string();
                              open_paths(context, answer.paths);
                            });
}

void save_robots(PanelContext& context) {
  const std::vector<RobotId> robots = selected_or_all(context.scene);
  if (robots.empty()) {
    context.toasts.show(Tone::info, "there are no robots to save");
    return;
  }
  if (robots.size() > 1) {
    save_many(context, robots);
    return;
  }
  for (const RobotEntry& entry : context.scene.entries())
    if (entry.id == robots.front()) save_one(context, entry);
}

void save_scene(PanelContext& context) {
  if (context.scene.entries().empty()) {
    context.toasts.show(Tone::info, "there are no robots to save in a scene");
    return;
  }
  const fs::path last = context.preferences.scene;
  context.dialogs.ask_files({.kind = FileRequest::Kind::save,
                             .title = "Save the scene",
                             .button = "Save",
                             .extensions = {".toml"},
                             .folder = last.empty() ? fs::path(context.preferences.save_folder) : last.parent_path(),
                             .name = last.empty() ? "scene.toml" : last.filename().string(),
                             .formats = {}},
                            [&context](const FileChoice& answer) {
                              const fs::path path = answer.paths.front();
                              save_with_confirmation(context, "scene", [&context, path](bool overwrite) {
                                SaveResult result;
                                with_window_camera(context,
                                                   [&] { result = context.scene.save_scene(path, overwrite); });
                                if (result.ok()) context.preferences.scene = path.string();
                                return result;
                              });
                            });
}

void quit_with_confirmation(PanelContext& context, std::function<void()> quit) {
  const auto then = [&context, quit = std::move(quit)] { end_evolution(context, quit); };
  const std::vector<RobotId> lost = robots_to_lose(context.scene);
  if (lost.empty()) {
    then();
    return;
  }
  context.log.write("asks", {{"what", "quit"}});
  const std::string question =
      lost.size() == 1 ? "One robot has unsaved changes." : fmt::format("{} robots have unsaved changes.", lost.size());
  context.dialogs.ask({.title = "Quit without saving?",
                       .text = question,
                       .button = "Quit",
                       .on_accept = then,
                       .other_button = "Save...",
                       .on_other = [&context, lost] {
                         context.scene.clear_selection();
                         for (const RobotId robot : lost) context.scene.select(robot, false);
                         save_robots(context);
                       }});
}

}  // namespace mercury::window
