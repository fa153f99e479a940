// SPDX-License-Identifier: Apache-2.0
// How individuals of a run are shown: numbers, colors, a tooltip.
#pragma once

#include <imgui.h>

#include <string>

#include "app/live/run_view.h"

namespace mercury::window {

// "0.123"; "-" for the worst score and for what was not measured.
std::string score_text(double score);

// The range of the finite scores that were added, for colors and bars.
class ScoreRange {
 public:
  void add(double score);
  double low() const { return low_; }
  double high() const { return high_; }
  // 0 = lowest, 1 = highest; 0 for scores that are not finite.
  float share(double score) const;
  ImU32 color(double score) const;

 private:
  double low_ = 1e300, high_ = -1e300;
};

// A tooltip beside the panel with everything that is known of it; `hint` says what a click does.
void show_individual(const Individual& individual, const EvolutionSettings& settings, const char* hint);

}  // namespace mercury::window
