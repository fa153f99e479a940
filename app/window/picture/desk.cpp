// SPDX-License-Identifier: Apache-2.0
#include "app/window/picture/desk.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace mercury::window {
namespace {

std::string list_of(const std::vector<std::filesystem::path>& files) {
  std::string text = files.empty() ? "" : files.front().string();
  if (files.size() > 1) text += fmt::format(" and {} more", files.size() - 1);
  return text;
}

void tell(Desk& desk, const std::string& what, const SaveResult& result) {
  if (result.outcome == SaveResult::Outcome::failed) {
    desk.toasts.say(Tone::error, result.message);
    return;
  }
  desk.toasts.say(Tone::success, fmt::format("{} saved: {}", what, list_of(result.files)));
  std::vector<std::string> files;
  for (const auto& file : result.files) files.push_back(file.string());
  desk.observations.tell("saved", {{"what", what}, {"files", files}});
}

}  // namespace

std::vector<RobotId> chosen_robots(const LiveScene& scene) {
  std::vector<RobotId> chosen = scene.selection();
  if (chosen.empty())
    for (const RobotEntry& entry : scene.entries()) chosen.push_back(entry.id);
  return chosen;
}

std::vector<render::Bounds> boxes_of(LiveScene& scene, const std::vector<RobotId>& robots) {
  const std::span<const render::Bounds> bounds = scene.picture().bounds();
  std::vector<render::Bounds> boxes;
  for (const RobotId robot : robots)
    if (const auto index = scene.moment().robots->index_of(robot);
        index && *index < bounds.size() && !bounds[*index].empty())
      boxes.push_back(bounds[*index]);
  return boxes;
}

void frame_robots(Desk& desk, const std::vector<RobotId>& robots, float aspect) {
  std::vector<render::Bounds> boxes = boxes_of(desk.scene, robots);
  if (boxes.empty()) boxes = boxes_of(desk.scene, chosen_robots(desk.scene));
  desk.camera.frame(boxes, aspect);
}

void as_seen(Desk& desk, const std::function<void()>& act) {
  const ViewSettings before = desk.scene.view();
  ViewSettings view = before;
  view.camera = desk.camera.plan();
  desk.scene.set_view(view);
  act();
  desk.scene.set_view(before);
}

void save_with_care(Desk& desk, const std::string& what, std::function<SaveResult(bool overwrite)> save) {
  const SaveResult result = save(false);
  if (result.outcome != SaveResult::Outcome::exists) {
    tell(desk, what, result);
    return;
  }
  desk.observations.tell("asks", {{"what", "overwrite"}});
  const std::string question =
      result.files.size() == 1
          ? fmt::format("{} is there already.", result.files.front().string())
          : fmt::format("{} files are there already: {}", result.files.size(), list_of(result.files));
  desk.dialogs.ask({.title = "Replace?",
                    .text = question,
                    .button = "Replace",
                    .act = [&desk, what, save] { tell(desk, what, save(true)); },
                    .refused = [&desk] { desk.dialogs.ask_files_again(); }});
}

}  // namespace mercury::window
