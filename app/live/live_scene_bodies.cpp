// SPDX-License-Identifier: Apache-2.0
// Edits the bodies of the window's robots, voxel by voxel.
#include "app/live/live_scene_parts.h"
#include "mercury/error.h"

namespace mercury {

bool LiveScene::has_voxels(RobotId robot) const {
  const DocumentRobot* found = parts_->document.find(robot);
  try {
    return found && voxel_grid_of(*found->body.robot);
  } catch (const InputError&) {
    return false;  // an origin that holds no valid grid
  }
}

std::optional<VoxelSide> LiveScene::voxel_side(const Hit& hit) const {
  const DocumentRobot* robot = parts_->document.find(hit.robot);
  if (!robot || !hit.face) return std::nullopt;
  try {
    return voxel_side_of(*robot->body.robot, *hit.face);
  } catch (const InputError&) {
    return std::nullopt;  // an origin that holds no valid grid
  }
}

bool LiveScene::edit_voxel(RobotId id, const VoxelSide& side, const VoxelEdit& edit) {
  const DocumentRobot* found = parts_->document.find(id);
  if (!found) return false;
  std::shared_ptr<const Robot> changed;
  try {
    Robot robot = with_voxel(*found->body.robot, side, edit);
    validate(robot);
    if (robot.springs == found->body.robot->springs && robot.masses == found->body.robot->masses) return false;
    changed = std::make_shared<const Robot>(std::move(robot));
  } catch (const InputError& error) {
    parts_->report(Severity::warning, error.what());
    return false;
  }
  static constexpr const char* names[] = {"add a voxel", "remove a voxel", "paint a voxel"};
  parts_->edit(names[static_cast<std::size_t>(edit.tool)]);
  DocumentRobot* robot = parts_->find(id);
  robot->body.robot = std::move(changed);
  robot->source = {.file = robot->source.file};  // the seed no longer makes this robot
  // Masses have other numbers now.
  std::erase_if(parts_->document.attachments, [&](const Attachment& one) { return one.spring.robot == id; });
  parts_->apply_document();
  parts_->send_perturbation();
  return true;
}

}  // namespace mercury
