// SPDX-License-Identifier: Apache-2.0
#include "app/live/scene_document.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "mercury/brain.h"

namespace mercury {

const DocumentRobot* SceneDocument::find(RobotId id) const {
  const auto found = std::ranges::find_if(robots, [&](const DocumentRobot& robot) { return robot.body.id == id; });
  return found == robots.end() ? nullptr : &*found;
}
DocumentRobot* SceneDocument::find(RobotId id) { return const_cast<DocumentRobot*>(std::as_const(*this).find(id)); }

std::vector<std::string> actuator_names(const Robot& robot) {
  std::vector<std::string> names;
  for (const Actuator& actuator : actuators_of(robot)) names.push_back(actuator.name);
  return names;
}
std::vector<std::string> neuron_names(const Robot& robot) { return brain_layout(robot).neurons; }

bool hold(LiveRobot& robot, std::vector<float> ByHand::*list, std::size_t count, std::size_t index,
          std::optional<float> wanted) {
  const float value = wanted.value_or(std::numeric_limits<float>::quiet_NaN());
  ByHand held = robot.by_hand ? *robot.by_hand : ByHand{};
  std::vector<float>& values = held.*list;
  values.resize(count, std::numeric_limits<float>::quiet_NaN());
  if (values[index] == value || (std::isnan(values[index]) && std::isnan(value))) return false;
  values[index] = value;
  const auto is_free = [](const std::vector<float>& all) {
    return std::ranges::all_of(all, [](float one) { return std::isnan(one); });
  };
  robot.by_hand =
      is_free(held.drives) && is_free(held.neurons) ? nullptr : std::make_shared<const ByHand>(std::move(held));
  return true;
}

bool release(LiveRobot& robot, std::vector<float> ByHand::*list) {
  bool changed = false;
  const std::size_t count = robot.by_hand ? (robot.by_hand.get()->*list).size() : 0;
  for (std::size_t i = 0; i < count; ++i) changed = hold(robot, list, count, i, std::nullopt) || changed;
  return changed;
}

HeldParts held_in(const SceneDocument& document) {
  HeldParts held;
  for (const auto& [spring, resets] : document.attachments) {
    const auto robot = std::ranges::find(document.robots, spring.robot, [](const auto& one) { return one.body.id; });
    if (robot == document.robots.end()) continue;
    AttachedMass& one = held.attached.emplace_back();
    one.robot = static_cast<std::size_t>(robot - document.robots.begin());
    one.mass = spring.mass;
    if (spring.kind == LivePerturbation::Kind::spring) one.spring = {spring.target, spring.stiffness};
  }
  const auto add = [](std::size_t robot, std::span<const float> values, const std::vector<std::string>& names,
                      std::vector<HeldValue>& to) {
    for (std::size_t i = 0; i < std::min(names.size(), values.size()); ++i)
      if (!std::isnan(values[i])) to.push_back({robot, names[i], values[i]});
  };
  for (std::size_t i = 0; i < document.robots.size(); ++i) {
    const LiveRobot& body = document.robots[i].body;
    if (!body.by_hand) continue;
    add(i, body.by_hand->drives, actuator_names(*body.robot), held.drives);
    add(i, body.by_hand->neurons, neuron_names(*body.robot), held.neurons);
  }
  return held;
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
