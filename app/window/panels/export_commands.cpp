// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/export_commands.h"

#include <fmt/format.h>

#include <charconv>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/export/export_format.h"
#include "app/window/panels/robot_commands.h"
#include "app/window/panels/saving.h"

namespace mercury::window {
namespace {

namespace fs = std::filesystem;

std::optional<RobotId> robot_to_export(PanelContext& context) {
  if (const auto current = context.scene.current()) return current;
  const std::vector<RobotId> robots = selected_or_all(context.scene);
  if (robots.empty()) {
    context.toasts.show(Tone::info, "there is no robot to export");
    return std::nullopt;
  }
  return robots.front();
}

// Asks for a file of one of the formats for which `condition` holds.
void ask_file(PanelContext& context, RobotId robot, const char* what, bool (*condition)(const ExportFormat&),
              std::function<void(const fs::path&)> on_accept) {
  FileRequest request{.kind = FileRequest::Kind::save,
                      .title = fmt::format("Export the {} of {}", what, name_of_robot(context.scene, robot)),
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
  request.name = file_name_of(name_of_robot(context.scene, robot)) + request.extensions.front();
  context.dialogs.ask_files(std::move(request), [on_accept = std::move(on_accept)](const FileChoice& answer) {
    on_accept(answer.paths.front());
  });
}

void begin_motion(PanelContext& context, RobotId robot, const fs::path& path, double seconds, bool overwrite) {
  const SaveResult result = context.scene.export_motion(robot, path, seconds, overwrite);
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
  context.dialogs.ask(
      {.title = "Replace?",
       .text = result.files.front().string() + " exists already.",
       .button = "Replace",
       .on_accept = [&context, robot, path, seconds] { begin_motion(context, robot, path, seconds, true); },
       .on_cancel = [&context] { context.dialogs.reopen_file_dialog(); }});
}

std::optional<double> seconds_from(const std::string& text) {
  double seconds = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seconds);
  if (error != std::errc{} || end != text.data() + text.size() || !(seconds > 0)) return std::nullopt;
  return seconds;
}

}  // namespace

void export_pose(PanelContext& context) {
  const std::optional<RobotId> robot = robot_to_export(context);
  if (!robot) return;
  ask_file(context, *robot, "pose", holds_pose, [&context, id = *robot](const fs::path& path) {
    save_with_confirmation(context, "pose", [&context, id, path](bool overwrite) {
      return context.scene.export_pose(id, path, overwrite);
    });
  });
}

void export_motion(PanelContext& context) {
  const std::optional<RobotId> robot = robot_to_export(context);
  if (!robot) return;
  context.dialogs.ask_text("Export the motion",
                           fmt::format("How many seconds of {}, from time 0? They are simulated in the background.",
                                       name_of_robot(context.scene, *robot)),
                           "5", "Next", [&context, id = *robot](const std::string& text) {
                             const std::optional<double> seconds = seconds_from(text);
                             if (!seconds)
                               return context.toasts.show(Tone::error,
                                                          "\"" + text + "\" is no number of seconds above 0");
                             ask_file(context, id, "motion", holds_simulated_motion,
                                      [&context, id, length = *seconds](const fs::path& path) {
                                        begin_motion(context, id, path, length, false);
                                      });
                           });
}

}  // namespace mercury::window
