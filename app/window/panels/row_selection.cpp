// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/row_selection.h"

#include <imgui.h>

#include <algorithm>
#include <vector>

namespace mercury::window {

void RowSelection::click(LiveScene& scene, RobotId robot, std::span<const RobotId> rows) {
  const ImGuiIO& io = ImGui::GetIO();
  auto first = std::ranges::find(rows, anchor_), last = std::ranges::find(rows, robot);
  if (io.KeyShift && first != rows.end() && last != rows.end()) {
    if (last < first) std::swap(first, last);
    std::vector<RobotId> selected = io.KeyCtrl ? scene.selection() : std::vector<RobotId>{};
    selected.insert(selected.end(), first, last + 1);
    scene.set_selection(selected);
    return;
  }
  if (io.KeyCtrl)
    scene.toggle_selected(robot);
  else
    scene.select(robot);
  anchor_ = robot;
}

}  // namespace mercury::window
