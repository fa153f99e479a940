// SPDX-License-Identifier: Apache-2.0
// How individuals of a run are shown: numbers, colors, a tooltip, the map of elites, and a family.
#pragma once

#include <imgui.h>

#include <optional>
#include <string>

#include "app/live/run_view.h"
#include "app/window/panels/panel.h"

namespace mercury {
struct Quantity;
}

namespace mercury::window {

// "cruise speed [m/s]"
std::string title_of(const Quantity& quantity);
// Of a quantity, its label; a formula as it is.
std::string objective_label(const std::string& objective);

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
void show_individual(PanelContext& context, const Individual& individual, const EvolutionSettings& settings,
                     const char* hint);

// Draws the map of elites as a colored grid over the remaining width. Returns the individual whose cell was clicked.
std::optional<std::uint64_t> draw_elite_map(PanelContext& context, const EliteMap& map,
                                            const EvolutionSettings& settings);

// The drawing of a line of ancestors, with a side branch to the second parent of each crossover:
//
//   o     41  2618  ######## 1.31      the individual itself
//   |\.                                a crossover
//   | o   35  2260  ######   1.02        its second parent
//   o     38  2440  #######  1.17      its first parent, and so on
//
// Draws the family over the remaining width, `height` pixels high; it scrolls. Returns true when the user asked for the
// family of another individual, with a double click; `id` is that individual.
bool draw_family(PanelContext& context, const Family& family, const EvolutionSettings& settings, float height,
                 std::uint64_t& id);

}  // namespace mercury::window
