// SPDX-License-Identifier: Apache-2.0
#include "app/live/scene_document.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace mercury {

const DocumentRobot* SceneDocument::find(RobotId id) const {
  const auto found = std::ranges::find_if(robots, [&](const DocumentRobot& robot) { return robot.body.id == id; });
  return found == robots.end() ? nullptr : &*found;
}

std::vector<AttachedMass> attached_in(const SceneDocument& document) {
  std::vector<AttachedMass> all;
  for (const auto& [spring, resets] : document.attachments) {
    const auto robot = std::ranges::find(document.robots, spring.robot, [](const auto& one) { return one.body.id; });
    if (robot == document.robots.end()) continue;
    AttachedMass& one = all.emplace_back();
    one.robot = static_cast<std::size_t>(robot - document.robots.begin());
    one.mass = spring.mass;
    if (spring.kind == LivePerturbation::Kind::spring) one.spring = {spring.target, spring.stiffness};
  }
  return all;
}

std::vector<DrivenActuator> driven_in(const SceneDocument& document) {
  std::vector<DrivenActuator> all;
  for (std::size_t i = 0; i < document.robots.size(); ++i) {
    const LiveRobot& body = document.robots[i].body;
    if (!body.by_hand) continue;
    const std::vector<Actuator> actuators = actuators_of(*body.robot);
    for (std::size_t a = 0; a < std::min(actuators.size(), body.by_hand->drives.size()); ++a)
      if (const float drive = body.by_hand->drives[a]; !std::isnan(drive)) all.push_back({i, actuators[a].name, drive});
  }
  return all;
}

Robot whole_robot(const LiveRobot& robot) {
  Robot whole = *robot.robot;
  whole.name = robot.name;
  const auto now = materials_of(robot), before = materials_of(*robot.robot);
  if (std::ranges::equal(now, before)) return whole;
  if (whole.materials.empty())
    for (std::size_t id = 0; id < now.size(); ++id)
      whole.material_names.push_back(default_material_name(static_cast<MaterialId>(id)));
  whole.materials.assign(now.begin(), now.end());
  return whole;
}

void EditHistory::before_change(const SceneDocument& document, std::string name, std::string key) {
  future_.clear();
  if (!key.empty() && key == open_key_) return;
  past_.push_back({std::move(name), document});
  forget_oldest(document);
  open_key_ = std::move(key);
}

void EditHistory::forget_oldest(const SceneDocument& document) {
  if (past_.size() > most) past_.erase(past_.begin());
  std::set<const Robot*> known;
  for (const DocumentRobot& robot : document.robots) known.insert(robot.body.robot.get());
  std::size_t springs = 0;
  for (std::size_t i = past_.size(); i-- > 0;) {
    for (const DocumentRobot& robot : past_[i].document.robots)
      if (known.insert(robot.body.robot.get()).second) springs += robot.body.robot->springs.size();
    if (springs <= most_springs_ || i + 1 == past_.size()) continue;
    past_.erase(past_.begin(), past_.begin() + static_cast<std::ptrdiff_t>(i) + 1);
    return;
  }
}

void EditHistory::clear() {
  past_.clear();
  future_.clear();
  open_key_.clear();
}

void EditHistory::undo(SceneDocument& document) {
  if (past_.empty()) return;
  Edit edit = std::move(past_.back());
  past_.pop_back();
  std::swap(edit.document, document);
  future_.push_back(std::move(edit));
  open_key_.clear();
}

void EditHistory::redo(SceneDocument& document) {
  if (future_.empty()) return;
  Edit edit = std::move(future_.back());
  future_.pop_back();
  std::swap(edit.document, document);
  past_.push_back(std::move(edit));
  open_key_.clear();
}

}  // namespace mercury
