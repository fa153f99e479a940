// SPDX-License-Identifier: Apache-2.0
// The drawing of a line of ancestors, with a side branch to the second parent of each crossover:
//
//   o     41  2618  ######## 1.31      the individual itself
//   |\.                                a crossover
//   | o   35  2260  ######   1.02        its second parent
//   o     38  2440  #######  1.17      its first parent, and so on
#pragma once

#include "app/window/panels/panel_context.h"

namespace mercury::window {

// Draws the family over the remaining width, `height` pixels high; it scrolls. Returns true when the user asked for the
// family of another individual, with a double click; `id` is that individual.
bool draw_family(PanelContext& context, const Family& family, const EvolutionSettings& settings, float height,
                 std::uint64_t& id);

}  // namespace mercury::window
