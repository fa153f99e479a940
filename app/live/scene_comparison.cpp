// SPDX-License-Identifier: Apache-2.0
#include "app/live/scene_comparison.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/live/drawn_scene.h"
#include "app/live/scene_core.h"
#include "app/live/scene_selection.h"
#include "app/live/stepping.h"

namespace mercury {

SceneComparison::SceneComparison(SceneCore& core) : core_(core) {}
SceneComparison::~SceneComparison() = default;

void SceneComparison::update() {
  const Snapshot& now = core_.snapshot();
  if (std::exchange(failed_seconds_, now.failed_seconds) != now.failed_seconds) set_second(std::nullopt);
  if (std::exchange(failed_ghosts_, now.failed_ghosts) != now.failed_ghosts) hide_ghosts();
  std::erase_if(ghosts_, [&](const LiveGhost& ghost) { return !core_.document().find(ghost.robot); });
}

void SceneComparison::set_second(const std::optional<SideDifference>& difference) {
  ViewSettings settings = core_.view();
  settings.compare = difference;
  core_.set_view(settings);
}
const std::optional<SideDifference>& SceneComparison::second() const { return core_.view().compare; }

// Both sides have the same layout, colors and scale, so that what differs is the robots.
void SceneComparison::draw(DrawnScene& first, ViewSettings shown, float aspect, const SceneSelection& selection,
                           std::optional<RobotId> held) {
  const auto on_land = [](const Snapshot& one) { return has_ground(one.configuration.environment); };
  const Snapshot& now = core_.snapshot();
  if (!now.second) {
    second_drawn_.reset();
    return;
  }
  if (!second_drawn_) second_drawn_ = std::make_unique<DrawnScene>();
  const render::Scene& scene = first.scene();
  if (shown.color->has_values() && scene.scale.low < scene.scale.high)
    shown.scale = std::pair(scene.scale.low, scene.scale.high);
  if (on_land(now) && !on_land(*now.second)) shown.camera.mode = CameraMode::top;  // side by side, as there
  second_drawn_->update(now.second, shown, aspect, selection.ids(), selection.hidden(), held, wall_now());
}

Series SceneComparison::second_series(RobotId robot) const {
  return core_.snapshot().second ? core_.physics().second_measurements().series(robot) : Series{};
}
Series SceneComparison::ghost_series(RobotId robot) const {
  return core_.snapshot().ghosts ? core_.physics().ghost_measurements().series(robot) : Series{};
}

std::size_t SceneComparison::show_ghosts(const std::vector<RobotId>& robots, GhostOf of) {
  ghosts_.clear();
  for (const RobotId id : robots) {
    const DocumentRobot* robot = core_.document().find(id);
    if (!robot) continue;
    const LiveRobot& unchanged = robot->made ? *robot->made : robot->body;
    const bool changed = unchanged.robot != robot->body.robot || unchanged.materials != robot->body.materials ||
                         unchanged.by_hand != robot->body.by_hand || robot->body.by_hand;
    const bool of_parent = of == GhostOf::parent || (of == GhostOf::automatic && !changed && robot->parent);
    if (of_parent && !robot->parent) continue;
    LiveGhost ghost{id, of_parent, of_parent ? *robot->parent : unchanged};
    ghost.body.id = id;
    ghost.body.begins_as = 0;
    ghost.body.by_hand.reset();
    ghosts_.push_back(std::move(ghost));
  }
  std::vector<LiveRobot> bodies;
  for (const LiveGhost& ghost : ghosts_) bodies.push_back(ghost.body);
  core_.physics().set_ghosts(std::move(bodies));
  return ghosts_.size();
}

std::vector<GhostFigures> SceneComparison::ghost_figures() const {
  std::vector<GhostFigures> all;
  if (!core_.snapshot().ghosts) return all;
  const std::vector<RankingRow> robots = core_.physics().measurements().ranking();
  for (const RankingRow& ghost : core_.physics().ghost_measurements().ranking()) {
    const auto robot = std::ranges::find(robots, ghost.robot, &RankingRow::robot);
    const auto wanted = std::ranges::find(ghosts_, ghost.robot, &LiveGhost::robot);
    if (robot == robots.end() || wanted == ghosts_.end()) continue;
    const double age = std::min(ghost.age, robot->age);
    GhostFigures figures{.robot = ghost.robot, .of_parent = wanted->of_parent, .age = age};
    figures.robot_distance = core_.physics().measurements().distance_at_age(ghost.robot, age);
    figures.ghost_distance = core_.physics().ghost_measurements().distance_at_age(ghost.robot, age);
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
