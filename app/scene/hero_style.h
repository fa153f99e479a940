// SPDX-License-Identifier: Apache-2.0
// The style "hero" of a still: one robot near the camera against the light, the others behind it, out of focus.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "app/scene/group_layout.h"
#include "app/scene/view_settings.h"
#include "mercury/environment.h"
#include "mercury/robot.h"
#include "render/scene.h"

namespace mercury {

// Camera, layout, light and lens of the style, where the settings leave them at their defaults.
void set_hero_style(ViewSettings& view, const Environment& environment);

// Adds copies, each turned another way, until there are as many robots as the style has places. The copies of one robot
// move alike.
void add_siblings(std::vector<std::shared_ptr<const Robot>>& robots, const Environment& environment);

// The offset of each robot: the first in the middle, the others in their places behind it.
std::vector<render::Vector3> hero_layout(std::span<const Room> rooms, const ViewSettings& view,
                                         const Environment& environment);

// The key light of the style: low, and ahead of the camera.
render::KeyLight hero_light(const ViewSettings& view, const Environment& environment);

}  // namespace mercury
