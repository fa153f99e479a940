// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/panel_context.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace mercury::window {
namespace {

std::string list_of(const std::vector<std::filesystem::path>& files) {
  std::string text = files.empty() ? "" : files.front().string();
  if (files.size() > 1) text += fmt::format(" and {} more", files.size() - 1);
  return text;
}

void report(PanelContext& context, const std::string& what, const SaveResult& result) {
  if (result.outcome == SaveResult::Outcome::failed) {
    context.toasts.show(Tone::error, result.message);
    return;
  }
  context.toasts.show(Tone::success, fmt::format("{} saved: {}", what, list_of(result.files)));
  std::vector<std::string> files;
  for (const auto& file : result.files) files.push_back(file.string());
  context.log.write("saved", {{"what", what}, {"files", files}});
}

}  // namespace

std::vector<RobotId> selected_or_all(const LiveScene& scene) {
  std::vector<RobotId> chosen = scene.selection();
  if (chosen.empty())
    for (const RobotEntry& entry : scene.entries()) chosen.push_back(entry.id);
  return chosen;
}

std::vector<render::Bounds> boxes_of(LiveScene& scene, const std::vector<RobotId>& robots) {
  const std::span<const render::Bounds> bounds = scene.picture().bounds();
  std::vector<render::Bounds> boxes;
  for (const RobotId robot : robots)
    if (const auto index = scene.snapshot().robots->index_of(robot);
        index && *index < bounds.size() && !bounds[*index].empty())
      boxes.push_back(bounds[*index]);
  return boxes;
}

void frame_robots(PanelContext& context, const std::vector<RobotId>& robots, float aspect) {
  std::vector<render::Bounds> boxes = boxes_of(context.scene, robots);
  if (boxes.empty()) boxes = boxes_of(context.scene, selected_or_all(context.scene));
  context.camera.frame(boxes, aspect);
}

void with_window_camera(PanelContext& context, const std::function<void()>& act) {
  const ViewSettings before = context.scene.view();
  ViewSettings view = before;
  view.camera = context.camera.plan();
  context.scene.set_view(view);
  act();
  context.scene.set_view(before);
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
      result.files.size() == 1
          ? fmt::format("{} is there already.", result.files.front().string())
          : fmt::format("{} files are there already: {}", result.files.size(), list_of(result.files));
  context.dialogs.ask({.title = "Replace?",
                       .text = question,
                       .button = "Replace",
                       .on_accept = [&context, what, save] { report(context, what, save(true)); },
                       .on_cancel = [&context] { context.dialogs.reopen_file_dialog(); }});
}

}  // namespace mercury::window
