// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/commands.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <optional>

#include "app/export/export_format.h"
#include "app/live/robot_saving.h"
#include "app/live/scene_exports.h"
#include "app/live/scene_files.h"
#include "app/live/scene_robots.h"
#include "app/live/scene_selection.h"
#include "mercury/number_text.h"

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
                                return context.scene.files().save(id, path, overwrite);
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
                                                       return context.scene.files().save_all(robots, folder, format,
                                                                                             overwrite);
                                                     });
                            });
}

// Robots that neither a seed nor a file can bring back.
std::vector<RobotId> robots_to_lose(const LiveScene& scene) {
  std::vector<RobotId> lost;
  for (const RobotEntry& robot : scene.robots().entries()) {
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

std::string list_of(const std::vector<std::filesystem::path>& files) {
  std::string text = files.empty() ? "" : files.front().string();
  if (files.size() > 1) text += fmt::format(" and {} more", files.size() - 1);
  return text;
}

void report(PanelContext& context, const std::string& what, const SaveResult& result) {
  if (result.outcome == SaveResult::Outcome::failed) {
    context.toasts.show(Tone::error, result.message);
    context.dialogs.reopen_file_dialog(result.message);
    return;
  }
  context.preferences.save_folder = result.files.front().parent_path().string();
  context.toasts.show(Tone::success, fmt::format("{} saved: {}", what, list_of(result.files)));
  std::vector<std::string> files;
  for (const auto& file : result.files) files.push_back(file.string());
  context.log.write("saved", {{"what", what}, {"files", files}});
}

namespace fs = std::filesystem;

std::optional<RobotId> robot_to_export(PanelContext& context) {
  if (const auto current = context.scene.selection().current()) return current;
  const std::vector<RobotId> robots = selected_or_all(context.scene);
  if (robots.empty()) {
    context.toasts.show(Tone::info, "there is no robot to export");
    return std::nullopt;
  }
  return robots.front();
}

// Asks for a file of one of the formats for which `condition` holds. `whose`: "the pose of eel"; `name`: of the file.
void ask_file(PanelContext& context, const std::string& whose, const std::string& name,
              const std::function<bool(const ExportFormat&)>& condition,
              std::function<void(const fs::path&)> on_accept) {
  FileRequest request{.kind = FileRequest::Kind::save,
                      .title = "Export " + whose,
                      .button = "Export",
                      .extensions = {},
                      .folder = context.preferences.save_folder,
                      .name = "",
                      .formats = {}};
  for (const ExportFormat& format : export_formats()) {
    if (!condition(format)) continue;
    request.extensions.emplace_back(format.extension);
    request.formats.push_back(format.title.data());  // a literal
  }
  request.name = file_name_of(name) + request.extensions.front();
  context.dialogs.ask_files(std::move(request), [on_accept = std::move(on_accept)](const FileChoice& answer) {
    on_accept(answer.paths.front());
  });
}

// Begins work that writes a file, and asks before it replaces one.
void begin_export(PanelContext& context, const fs::path& path, const std::function<SaveResult(bool overwrite)>& begin,
                  bool overwrite = false) {
  const SaveResult result = begin(overwrite);
  if (result.outcome == SaveResult::Outcome::failed) {
    context.toasts.show(Tone::error, result.message);
    context.dialogs.reopen_file_dialog(result.message);
    return;
  }
  if (result.outcome != SaveResult::Outcome::exists) {
    context.preferences.save_folder = path.parent_path().string();
    return;
  }
  context.log.write("asks", {{"what", "overwrite"}});
  context.dialogs.ask({.title = "Replace?",
                       .text = result.files.front().string() + " exists already.",
                       .button = "Replace",
                       .on_accept = [&context, path, begin] { begin_export(context, path, begin, true); },
                       .on_cancel = [&context] { context.dialogs.reopen_file_dialog(); }});
}

std::optional<double> seconds_from(const std::string& text) {
  const std::optional<double> seconds = parse_number<double>(text);
  return seconds && *seconds > 0 ? seconds : std::nullopt;
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
  for (const RobotEntry& entry : context.scene.robots().entries())
    if (entry.id == robots.front()) save_one(context, entry);
}

void save_scene(PanelContext& context) {
  if (context.scene.robots().entries().empty()) {
    context.toasts.show(Tone::info, "there are no robots to save in a scene");
    return;
  }
  const fs::path last = context.scene.files().scene_file();
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
                                                   [&] { result = context.scene.files().save_scene(path, overwrite); });
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
                         context.scene.selection().clear();
                         for (const RobotId robot : lost) context.scene.selection().select(robot, false);
                         save_robots(context);
                       }});
}

void save_with_confirmation(PanelContext& context, const std::string& what,
                            std::function<SaveResult(bool overwrite)> save) {
  const SaveResult result = save(false);
  if (result.outcome != SaveResult::Outcome::exists) {
    report(context, what, result);
    return;
  }
  context.log.write("asks", {{"what", "overwrite"}});
  const std::string question =
      result.files.size() == 1 ? fmt::format("{} exists already.", result.files.front().string())
                               : fmt::format("{} files exist already: {}", result.files.size(), list_of(result.files));
  context.dialogs.ask({.title = "Replace?",
                       .text = question,
                       .button = "Replace",
                       .on_accept = [&context, what, save] { report(context, what, save(true)); },
                       .on_cancel = [&context] { context.dialogs.reopen_file_dialog(); }});
}

void save_csv(PanelContext& context, const std::string& what, std::function<std::string()> make) {
  context.dialogs.ask_files({.kind = FileRequest::Kind::save,
                             .title = "Save " + what,
                             .button = "Save",
                             .extensions = {".csv"},
                             .folder = context.preferences.save_folder,
                             .name = what + ".csv",
                             .formats = {}},
                            [&context, what, make = std::move(make)](const FileChoice& answer) {
                              const std::filesystem::path path = answer.paths.front();
                              save_with_confirmation(context, what, [&context, path, text = make()](bool overwrite) {
                                return save_files({{path, text}}, overwrite);
                              });
                            });
}

void export_pose(PanelContext& context) {
  const std::optional<RobotId> robot = robot_to_export(context);
  if (!robot) return;
  const std::string name = name_of_robot(context.scene, *robot);
  ask_file(context, "the pose of " + name, name, holds_pose, [&context, id = *robot](const fs::path& path) {
    save_with_confirmation(context, "pose", [&context, id, path](bool overwrite) {
      return context.scene.exports().pose(id, path, overwrite);
    });
  });
}

void export_motion(PanelContext& context) {
  const std::vector<RobotId> robots = selected_or_all(context.scene);
  if (robots.empty()) {
    context.toasts.show(Tone::info, "there is no robot to export");
    return;
  }
  const bool alone = robots.size() == 1;
  const std::string name = alone ? name_of_robot(context.scene, robots.front()) : "robots";
  const std::string who = alone ? name : fmt::format("{} robots", robots.size());
  context.dialogs.ask_text(
      "Export the motion",
      fmt::format("How many seconds of {}, from time 0? They are simulated in the background.", who), "5", "Next",
      [&context, robots, alone, name, who](const std::string& text) {
        const std::optional<double> seconds = seconds_from(text);
        if (!seconds) return context.toasts.show(Tone::error, "\"" + text + "\" is no number of seconds above 0");
        const auto holds = [alone](const ExportFormat& format) {
          return holds_simulated_motion(format) && (alone || format.motions);
        };
        ask_file(context, "the motion of " + who, name, holds,
                 [&context, robots, length = *seconds](const fs::path& path) {
                   begin_export(context, path, [&context, robots, path, length](bool overwrite) {
                     return context.scene.exports().motion(robots, path, length, overwrite);
                   });
                 });
      });
}

void export_run(PanelContext& context) {
  if (!context.run.is_open()) return;
  struct PageOfRun {
    const char* title;
    std::vector<std::string> words;
  };
  static const std::vector<PageOfRun> pages{
      {"Its best robots", {}}, {"The ancestors of the best", {"--lineage=best"}}, {"Its map of elites", {"--map"}}};
  FileRequest request{.kind = FileRequest::Kind::save,
                      .title = "Export " + context.run.name() + " as a web page",
                      .button = "Export",
                      .extensions = {},
                      .folder = context.preferences.save_folder,
                      .name = file_name_of(context.run.name()) + ".html",
                      .formats = {}};
  for (const PageOfRun& page : pages) {
    request.extensions.emplace_back(".html");
    request.formats.push_back(page.title);
  }
  context.dialogs.ask_files(std::move(request), [&context, run = context.run.folder()](const FileChoice& answer) {
    const fs::path path = answer.paths.front();
    const std::vector<std::string> words = pages.at(static_cast<std::size_t>(answer.format)).words;
    begin_export(context, path, [&context, run, words, path](bool overwrite) {
      return context.scene.exports().run(run, words, path, overwrite);
    });
  });
}

}  // namespace mercury::window
