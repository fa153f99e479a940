// SPDX-License-Identifier: Apache-2.0
// Colours and spaces of the panels.
#pragma once

#include <imgui.h>

#include "render/colormap.h"
#include "render/scene.h"

namespace mercury::window {

// Sets ImGui's style; every length is multiplied by `scale`.
void apply_theme(render::Theme theme, float scale);

// Colours beside ImGui's own, of the theme applied last.
struct Palette {
  ImU32 accent, good, warning, bad, faint, grid, panel, on_picture;
  ImU32 mark, mark_ground;  // of what must be seen wherever it lies on the picture, and of the edge around it
};
const Palette& palette();

// As a colour of ImGui's.
inline ImU32 packed(render::Color color, float opacity = 1) {
  return IM_COL32(color.r, color.g, color.b, static_cast<int>(opacity * static_cast<float>(color.a)));
}

}  // namespace mercury::window
