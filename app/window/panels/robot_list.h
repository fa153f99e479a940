// SPDX-License-Identifier: Apache-2.0
// The list of robots: search, sort, select.
#pragma once

#include <string>
#include <vector>

#include "app/window/panels/panel_context.h"
#include "app/window/panels/row_selection.h"

namespace mercury::window {

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

}  // namespace mercury::window
