// SPDX-License-Identifier: Apache-2.0
// Colors and spacing of the panels.
#pragma once

#include <imgui.h>

#include "render/colormap.h"
#include "render/scene.h"

namespace mercury::window {

// Sets ImGui's style, with all lengths multiplied by `scale`.
void apply_theme(render::Theme theme, float scale);

// Colors in addition to ImGui's own, from the theme that was applied last.
struct Palette {
  ImU32 accent, accent_hovered, good, warning, bad, faint, grid, panel, on_view;
  ImU32 mark, mark_outline;  // contrast with everything in the view
};
const Palette& palette();

// What columns and bars lie on. The window is cleared with it, so they need not paint it, which takes long without a
// GPU.
ImVec4 panel_background();

// Converts to ImGui's color format.
inline ImU32 packed(render::Color color, float opacity = 1) {
  return IM_COL32(color.r, color.g, color.b, static_cast<int>(opacity * static_cast<float>(color.a)));
}

}  // namespace mercury::window
