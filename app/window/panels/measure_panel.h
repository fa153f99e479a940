// SPDX-License-Identifier: Apache-2.0
// Plots over time, and the ranking.
#pragma once

#include <array>
#include <string>

#include "app/window/picture/desk.h"

namespace mercury::window {

class MeasurePanel {
 public:
  void draw(Desk& desk);

 private:
  void draw_plots(Desk& desk);
  void draw_exports(Desk& desk);

  std::array<bool, 5> shown_{true, true, false, false, false};  // by Quantity
};

class RankingPanel {
 public:
  void draw(Desk& desk, float aspect);

 private:
  int column_ = 1;
  bool ascending_ = false;
  bool sorted_ = false;  // as the headings say, and told so
};

}  // namespace mercury::window
