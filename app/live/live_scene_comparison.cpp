// SPDX-License-Identifier: Apache-2.0
// The second side of the window's scene, and its ghosts.
#include <algorithm>
#include <cmath>

#include "app/live/live_scene_parts.h"
#include "app/live/stepping.h"

namespace mercury {

void LiveScene::set_second(const std::optional<SideDifference>& difference) {
  ViewSettings settings = parts_->view;
  settings.compare = difference;
  set_view(settings);
}
const std::optional<SideDifference>& LiveScene::second() const { return parts_->view.compare; }
LivePicture* LiveScene::second_picture() { return parts_->second_picture.get(); }

void LiveScene::point_at_second(bool second) { parts_->pointed_second = second; }
bool LiveScene::points_at_second() const { return parts_->points_at_second(); }
const Snapshot& LiveScene::pointed_snapshot() const { return parts_->pointed_snapshot(); }
const LivePicture& LiveScene::pointed_picture() const { return parts_->pointed_picture(); }

// Both sides have the same layout, colors and scale, so that what differs is the robots.
void LiveScene::Parts::update_second_picture(ViewSettings shown, const std::optional<RobotId>& held) {
  const auto on_land = [](const Snapshot& one) { return has_ground(one.configuration.environment); };
  if (!snapshot->second) {
    second_picture.reset();
    return;
  }
  if (!second_picture) second_picture = std::make_unique<LivePicture>();
  const render::Scene& first = picture.scene();
  if (shown.color->has_values() && first.scale.low < first.scale.high)
    shown.scale = std::pair(first.scale.low, first.scale.high);
  if (on_land(*snapshot) && !on_land(*snapshot->second)) shown.camera.mode = CameraMode::top;  // side by side, as there
  second_picture->update(snapshot->second, shown, aspect, {selected.begin(), selected.end()}, hidden, held, wall_now());
}

std::size_t LiveScene::show_ghosts(const std::vector<RobotId>& robots, GhostOf of) {
  parts_->ghosts.clear();
  for (const RobotId id : robots) {
    const DocumentRobot* robot = parts_->document.find(id);
    if (!robot) continue;
    const LiveRobot& unchanged = robot->made ? *robot->made : robot->body;
    const bool changed = unchanged.robot != robot->body.robot || unchanged.materials != robot->body.materials;
    const bool of_parent = of == GhostOf::parent || (of == GhostOf::automatic && !changed && robot->parent);
    if (of_parent && !robot->parent) continue;
    LiveGhost ghost{id, of_parent, of_parent ? *robot->parent : unchanged};
    ghost.body.id = id;
    ghost.body.begins_as = 0;
    parts_->ghosts.push_back(std::move(ghost));
  }
  std::vector<LiveRobot> bodies;
  for (const LiveGhost& ghost : parts_->ghosts) bodies.push_back(ghost.body);
  parts_->physics.set_ghosts(std::move(bodies));
  return parts_->ghosts.size();
}

void LiveScene::hide_ghosts() { show_ghosts({}); }
const std::vector<LiveGhost>& LiveScene::ghosts() const { return parts_->ghosts; }

void LiveScene::Parts::update_ghosts() {
  std::erase_if(ghosts, [&](const LiveGhost& ghost) { return !document.find(ghost.robot); });
}

bool LiveScene::has_parent(RobotId robot) const {
  const DocumentRobot* found = parts_->document.find(robot);
  return found && found->parent;
}

std::vector<GhostFigures> LiveScene::ghost_figures() const {
  std::vector<GhostFigures> all;
  if (!parts_->snapshot->ghosts) return all;
  const std::vector<RankingRow> robots = parts_->physics.measurements().ranking();
  for (const RankingRow& ghost : parts_->physics.ghost_measurements().ranking()) {
    const auto robot = std::ranges::find(robots, ghost.robot, &RankingRow::robot);
    const auto wanted = std::ranges::find(parts_->ghosts, ghost.robot, &LiveGhost::robot);
    if (robot == robots.end() || wanted == parts_->ghosts.end()) continue;
    const double age = std::min(ghost.age, robot->age);
    GhostFigures figures{.robot = ghost.robot, .of_parent = wanted->of_parent, .age = age};
    figures.robot_distance = parts_->physics.measurements().distance_at_age(ghost.robot, age);
    figures.ghost_distance = parts_->physics.ghost_measurements().distance_at_age(ghost.robot, age);
    if (age > 0) {
      figures.robot_speed = figures.robot_distance / age;
      figures.ghost_speed = figures.ghost_distance / age;
    }
    figures.same_age = std::abs(robot->age - ghost.age) < 1e-6;
    figures.ghost_exploded = ghost.exploded;
    all.push_back(figures);
  }
  return all;
}

}  // namespace mercury
