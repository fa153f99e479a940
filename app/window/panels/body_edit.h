// SPDX-License-Identifier: Apache-2.0
// What panels and mouse agree on while they edit a body or show a menu.
#pragma once

#include <optional>

#include "app/live/picking.h"
#include "app/live/voxel_edit.h"

namespace mercury::window {

// The body that is edited and the tool in use (body_editor.h).
struct BodyEdit {
  RobotId robot = 0;  // 0 = none
  VoxelEdit edit{.tool = VoxelTool::add};
};

// The menu of a right click (robot_menu.h).
struct RobotMenu {
  bool requested = false;  // it opens in the next frame
  RobotId robot = 0;
  std::optional<Hit> hit;  // in the picture
};

}  // namespace mercury::window
