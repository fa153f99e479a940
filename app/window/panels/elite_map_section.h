// SPDX-License-Identifier: Apache-2.0
// The map of elites as a colored grid.
#pragma once

#include <optional>

#include "app/window/panels/panel_context.h"

namespace mercury::window {

// Draws the map over the remaining width. Returns the individual whose cell was clicked.
std::optional<std::uint64_t> draw_elite_map(PanelContext& context, const EliteMap& map,
                                            const EvolutionSettings& settings);

}  // namespace mercury::window
