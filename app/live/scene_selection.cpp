// SPDX-License-Identifier: Apache-2.0
#include "app/live/scene_selection.h"

#include <algorithm>
#include <unordered_set>
#include <utility>

#include "app/live/scene_document.h"

namespace mercury {
namespace {

std::unordered_set<RobotId> ids_of(const SceneDocument& document) {
  std::unordered_set<RobotId> ids;
  for (const DocumentRobot& robot : document.robots) ids.insert(robot.body.id);
  return ids;
}

}  // namespace

void SceneSelection::select(RobotId robot, bool alone) {
  if (!document_.find(robot)) return;
  if (alone) ids_.clear();
  std::erase(ids_, robot);
  ids_.push_back(robot);
}

void SceneSelection::toggle(RobotId robot) {
  if (contains(robot))
    std::erase(ids_, robot);
  else
    select(robot, false);
}

void SceneSelection::select_all() {
  const std::set<RobotId> before = ids();
  for (const DocumentRobot& robot : document_.robots)
    if (!before.contains(robot.body.id)) ids_.push_back(robot.body.id);
}

void SceneSelection::set(const std::vector<RobotId>& robots) {
  std::unordered_set<RobotId> free = ids_of(document_);
  std::vector<RobotId> known;
  for (const RobotId id : robots)
    if (free.erase(id) > 0) known.push_back(id);
  ids_ = std::move(known);
}

bool SceneSelection::contains(RobotId robot) const { return std::ranges::find(ids_, robot) != ids_.end(); }

std::vector<RobotId> SceneSelection::robots() const {
  std::vector<RobotId> ordered;
  const std::set<RobotId> selected = ids();
  for (const DocumentRobot& robot : document_.robots)
    if (selected.contains(robot.body.id)) ordered.push_back(robot.body.id);
  return ordered;
}

std::optional<RobotId> SceneSelection::current() const {
  const auto last = std::find_if(ids_.rbegin(), ids_.rend(), [&](RobotId id) { return document_.find(id); });
  return last == ids_.rend() ? std::nullopt : std::optional(*last);
}

void SceneSelection::set_hidden(RobotId robot, bool hidden) {
  if (hidden)
    hidden_.insert(robot);
  else
    hidden_.erase(robot);
}

void SceneSelection::update() {
  if (ids_.empty()) return;
  const std::unordered_set<RobotId> there = ids_of(document_);
  std::erase_if(ids_, [&](RobotId id) { return !there.contains(id); });
}

}  // namespace mercury
