// SPDX-License-Identifier: Apache-2.0
// The list of robots: search, sort, select, and the menu of a right click on a robot, in a list or in the view.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "app/live/live_scene.h"
#include "app/live/scene_robots.h"
#include "app/window/panels/panel.h"
#include "app/window/toolkit/key_bindings.h"

namespace mercury::window {

// Clicks on rows of robots, as in a file manager.
class RowSelection {
 public:
  // A plain click selects one robot. Shift-click selects all rows from the last one that was clicked, Ctrl-click adds
  // or removes one, and with both keys the range is added. `rows`: the robots in the order that the user sees.
  void click(LiveScene& scene, RobotId robot, std::span<const RobotId> rows);

 private:
  RobotId anchor_ = 0;  // where a range starts; 0 = nowhere
};

class RobotList {
 public:
  // `room`: the height that the list may take, with its heading and search field [pixels].
  void draw(PanelContext& context, float room);

 private:
  std::vector<RobotEntry> listed(std::vector<RobotEntry> entries) const;
  void draw_table(PanelContext& context, const std::vector<RobotEntry>& entries, float height);
  void draw_row(PanelContext& context, const RobotEntry& entry, int index);

  std::string search_;
  int column_ = -1;  // to sort by: 0 = name, 1 = springs; -1 = the order in which they were added
  bool ascending_ = true;
  std::vector<RobotId> order_;  // as shown
  RowSelection selection_;
};

// Opens the menu when the item that was just drawn is right-clicked. Its robot is selected first, unless it is one of
// several that are.
void robot_menu_of_row(PanelContext& context, RobotId robot);

// Opens the menu for what was right-clicked in the view.
void open_robot_menu(PanelContext& context, const Hit& hit);
// Draws the menu that is open. `execute` carries out a command.
void draw_robot_menu(PanelContext& context, const std::function<void(Action)>& execute);

}  // namespace mercury::window
