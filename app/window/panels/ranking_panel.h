// SPDX-License-Identifier: Apache-2.0
// A table of all robots, sorted by distance, age, speed, energy or strain.
#pragma once

#include <string>
#include <vector>

#include "app/window/panels/panel.h"
#include "app/window/panels/robot_list.h"

namespace mercury::window {

class RankingPanel : public Panel {
 public:
  void draw(PanelContext& context) override;

 private:
  struct Row {
    std::string name;
    RankingRow values;
  };
  void draw_headings(PanelContext& context);
  void read_sort_order();
  void arrange(std::vector<Row>& rows);
  void sort(std::vector<Row>& rows) const;
  void log_order(PanelContext& context, const std::vector<Row>& rows);
  void draw_row(PanelContext& context, int index, const Row& row);
  void draw_notes(PanelContext& context, const std::vector<Row>& rows);

  int column_ = 1;  // to sort by
  bool ascending_ = false;
  bool logged_ = false;  // the current sort order is in the event log
  bool held_ = false;    // the mouse is over the table, so rows stay where they are
  std::vector<RobotId> order_;
  RowSelection selection_;
};

}  // namespace mercury::window
