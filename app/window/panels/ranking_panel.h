// SPDX-License-Identifier: Apache-2.0
// A table of all robots, sorted by distance, speed, energy or strain.
#pragma once

#include <string>
#include <vector>

#include "app/window/panels/panel.h"

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
  void sort(std::vector<Row>& rows) const;
  void log_order(PanelContext& context, const std::vector<Row>& rows);
  void draw_row(PanelContext& context, int index, const Row& row);

  int column_ = 1;  // to sort by
  bool ascending_ = false;
  bool logged_ = false;  // the present sort order is in the event log
};

}  // namespace mercury::window
