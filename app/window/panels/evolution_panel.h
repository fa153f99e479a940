// SPDX-License-Identifier: Apache-2.0
// An evolution: its scores over time, champions, map of elites and the family of one individual.
#pragma once

#include <optional>
#include <vector>

#include "app/window/panels/panel.h"

namespace mercury::window {

class EvolutionPanel : public Panel {
 public:
  void draw(PanelContext& context) override;
  // Follows the run while the tab is closed, too.
  void work(PanelContext& context, double seconds) override;

 private:
  void choose(PanelContext& context, std::uint64_t id);
  void draw_run(PanelContext& context, const RunView& view);
  void draw_champions(PanelContext& context, const RunView& view);
  void read_sort_order();
  void sort(const RunView& view);
  void draw_family_section(PanelContext& context, const RunView& view);

  std::shared_ptr<const RunView> view_;  // of the last frame; shows whether there is a newer one
  std::optional<std::uint64_t> chosen_;  // whose family is shown; none = that of the best champion
  std::vector<std::size_t> order_;       // of the champions in the table
  int column_ = 2;                       // to sort by
  bool ascending_ = false;
};

}  // namespace mercury::window
