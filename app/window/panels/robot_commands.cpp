// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/commands.h"

#include <fmt/format.h>
#include <imgui.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <unordered_set>
#include <variant>

#include "app/live/command_text.h"
#include "app/live/measurements.h"
#include "app/live/scene_files.h"
#include "app/live/scene_robots.h"
#include "app/live/scene_selection.h"
#include "mercury/number_text.h"

namespace mercury::window {
namespace {

// The bounding boxes of these robots in the view. Robots that are hidden have none.
std::vector<render::Bounds> boxes_of(LiveScene& scene, const std::vector<RobotId>& robots) {
  const std::span<const render::Bounds> bounds = scene.drawn().bounds();
  std::vector<render::Bounds> boxes;
  for (const RobotId robot : robots)
    if (const auto index = scene.snapshot().robots->index_of(robot);
        index && *index < bounds.size() && !bounds[*index].empty())
      boxes.push_back(bounds[*index]);
  return boxes;
}

}  // namespace

std::vector<RobotId> selected_or_all(const LiveScene& scene) {
  std::vector<RobotId> robots = scene.selection().robots();
  if (robots.empty())
    for (const RobotEntry& entry : scene.robots().entries()) robots.push_back(entry.id);
  return robots;
}

std::string name_of_robot(const LiveScene& scene, RobotId robot) {
  // The list of the snapshot has an index, which counts with a thousand robots; the document knows the newest ones.
  const LiveRobots& robots = *scene.snapshot().robots;
  if (const auto index = robots.index_of(robot)) return robots.robots[*index].name;
  const DocumentRobot* found = scene.document().find(robot);
  return found ? found->body.name : "?";
}

ImTextureID thumbnail_of_robot(PanelContext& context, RobotId id) {
  const DocumentRobot* robot = context.scene.document().find(id);
  if (!robot) return {};
  return context.thumbnails.find(fmt::format("{}@{}", id, fmt::ptr(robot->body.robot.get())),
                                 [body = robot->body.robot] { return body; });
}

void frame_robots(PanelContext& context, const std::vector<RobotId>& robots) {
  std::vector<render::Bounds> boxes = boxes_of(context.scene, robots);
  if (boxes.empty()) boxes = boxes_of(context.scene, selected_or_all(context.scene));
  context.camera.frame(boxes, context.aspect);
}

void generate_robots(PanelContext& context) {
  RobotCreation& creation = context.creation;
  context.scene.robots().generate(creation.generation, creation.replace, creation.lively);
  ++creation.generation.seed;
}

void mutate_selected(PanelContext& context) {
  if (context.scene.selection().robots().empty()) {
    context.toasts.show(Tone::info, "select the robots to mutate first");
    return;
  }
  context.scene.robots().mutate(context.scene.selection().robots(), context.creation.mutation);
  ++context.creation.mutation.seed;
}

void breed_selected(PanelContext& context) {
  const std::vector<RobotId> parents = context.scene.selection().robots();
  if (parents.size() != 2) {
    context.toasts.show(Tone::info, "select the two robots to breed from first");
    return;
  }
  context.scene.robots().breed(parents[0], parents[1], context.creation.mutation.seed);
  ++context.creation.mutation.seed;
}

void rename_selected(PanelContext& context) {
  const std::optional<RobotId> robot = context.scene.selection().current();
  if (!robot) {
    context.toasts.show(Tone::info, "select the robot to rename first");
    return;
  }
  const std::string name = name_of_robot(context.scene, *robot);
  context.dialogs.ask_text(
      "Rename", fmt::format("A new name for {}:", name), name, "Rename",
      [&context, id = *robot](const std::string& text) { context.scene.robots().rename(id, text); });
}

void invert_selection(PanelContext& context) {
  std::vector<RobotId> others;
  for (const RobotEntry& entry : context.scene.robots().entries())
    if (!entry.selected) others.push_back(entry.id);
  context.scene.selection().set(others);
}

void keep_only(PanelContext& context, const std::vector<RobotId>& robots) {
  if (robots.empty()) {
    context.toasts.show(Tone::info, "select the robots to keep first");
    return;
  }
  const std::unordered_set<RobotId> kept(robots.begin(), robots.end());
  std::vector<RobotId> removed;
  for (const RobotEntry& entry : context.scene.robots().entries())
    if (!kept.contains(entry.id)) removed.push_back(entry.id);
  context.scene.robots().remove(removed);
}

void ask_for_best(PanelContext& context, std::vector<RobotId> order) {
  const bool given = !order.empty();
  if (!given) {
    std::vector<RankingRow> rows = context.scene.measurements().ranking();
    std::ranges::stable_sort(rows, [](const RankingRow& a, const RankingRow& b) {
      return ranks_before(a, b, a.distance_at_equal_age, b.distance_at_equal_age);
    });
    for (const RankingRow& row : rows) order.push_back(row.robot);
  }
  if (order.size() < 2) return;
  context.dialogs.ask_text(
      "Keep the best",
      given ? "How many robots to keep, from the top of the ranking? The others are removed (undo brings them back)."
            : "How many robots to keep, of those that went farthest at equal age? The others are removed (undo brings "
              "them back).",
      std::to_string((order.size() + 1) / 2), "Keep", [&context, order](const std::string& text) {
        const std::size_t count = parse_number<std::size_t>(text).value_or(0);
        if (count == 0 || count > order.size()) {
          context.toasts.show(Tone::warning, fmt::format("\"{}\" is not accepted; give 1 to {}", text, order.size()));
          return;
        }
        keep_only(context, {order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count)});
      });
}

void with_window_camera(PanelContext& context, const std::function<void()>& act) {
  const ViewSettings before = context.scene.view();
  ViewSettings view = before;
  view.camera = context.camera.plan();
  context.scene.set_view(view);
  act();
  context.scene.set_view(before);
}

void copy_as_command(PanelContext& context, const char* subcommand) {
  CommandText command;
  with_window_camera(context, [&] { command = context.scene.files().command(subcommand); });
  ImGui::SetClipboardText(command.text.c_str());
  context.log.write("copied", {{"text", command.text}});
  context.toasts.show(Tone::success, "copied: " + command.text);
  for (const std::string& line : command.notes) context.toasts.show(Tone::warning, line);
}

void change_view(PanelContext& context, const std::function<void(ViewSettings& view)>& change) {
  ViewSettings view = context.scene.view();
  change(view);
  context.scene.set_view(view);
}

void toggle_arrows(PanelContext& context, Action action) {
  struct Kind {
    Action action;
    const char* name;
    bool ArrowKinds::*shown;
    bool (*exists)(const Environment& environment);
    const char* missing;
  };
  static constexpr Kind kinds[] = {
      {Action::drag_arrows, "drag", &ArrowKinds::drag, has_face_forces, "only the ocean environment has drag arrows"},
      {Action::contact_arrows, "contact", &ArrowKinds::contact, has_ground, "without ground there are no contacts"},
      {Action::force_arrows, "force", &ArrowKinds::force, [](const Environment&) { return true; }, ""}};
  const Kind& kind = *std::ranges::find(kinds, action, &Kind::action);
  ViewSettings view = context.scene.view();
  bool& shown = view.shown.arrows.*kind.shown;
  shown = !shown;
  if (shown && !kind.exists(context.scene.document().configuration.environment))
    context.toasts.show(Tone::info, kind.missing);
  context.log.write("view", {{kind.name, shown}});
  context.scene.set_view(view);
}

}  // namespace mercury::window
