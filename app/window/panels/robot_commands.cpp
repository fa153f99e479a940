// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/robot_commands.h"

namespace mercury::window {
namespace {

// The bounding boxes of these robots in the picture. Robots that are hidden have none.
std::vector<render::Bounds> boxes_of(LiveScene& scene, const std::vector<RobotId>& robots) {
  const std::span<const render::Bounds> bounds = scene.picture().bounds();
  std::vector<render::Bounds> boxes;
  for (const RobotId robot : robots)
    if (const auto index = scene.snapshot().robots->index_of(robot);
        index && *index < bounds.size() && !bounds[*index].empty())
      boxes.push_back(bounds[*index]);
  return boxes;
}

}  // namespace

std::vector<RobotId> selected_or_all(const LiveScene& scene) {
  std::vector<RobotId> robots = scene.selection();
  if (robots.empty())
    for (const RobotEntry& entry : scene.entries()) robots.push_back(entry.id);
  return robots;
}

std::string name_of_robot(const LiveScene& scene, RobotId robot) {
  // The list of the snapshot has an index, which counts with a thousand robots; the document knows the newest ones.
  const LiveRobots& robots = *scene.snapshot().robots;
  if (const auto index = robots.index_of(robot)) return robots.robots[*index].name;
  const DocumentRobot* found = scene.document().find(robot);
  return found ? found->body.name : "?";
}

void frame_robots(PanelContext& context, const std::vector<RobotId>& robots) {
  std::vector<render::Bounds> boxes = boxes_of(context.scene, robots);
  if (boxes.empty()) boxes = boxes_of(context.scene, selected_or_all(context.scene));
  context.camera.frame(boxes, context.aspect);
}

void generate_robots(PanelContext& context) {
  RobotCreation& creation = context.creation;
  context.scene.generate(creation.generation, creation.replace);
  ++creation.generation.seed;
}

void mutate_selected(PanelContext& context) {
  if (context.scene.selection().empty()) {
    context.toasts.show(Tone::info, "select the robots to mutate first");
    return;
  }
  context.scene.mutate(context.scene.selection(), context.creation.mutation);
  ++context.creation.mutation.seed;
}

}  // namespace mercury::window
