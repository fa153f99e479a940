// SPDX-License-Identifier: Apache-2.0
// What is written on the picture: names, legend, clock, lengths; by ImGui, so that it is sharp however coarse the
// picture.
#pragma once

#include <span>

#include "app/window/viewport/viewport_area.h"
#include "render/camera.h"
#include "render/scene.h"

namespace mercury::window {

// The scene without its texts.
render::Scene without_text(const render::Scene& scene);

// The texts of the scene, over its picture, the clock where it is wanted. `bounds`: one box a body, in the picture.
void draw_viewport_text(const render::Scene& scene, std::span<const render::Bounds> bounds, const ViewportArea& area,
                        const render::Camera& camera, bool clock);

}  // namespace mercury::window
