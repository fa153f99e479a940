// SPDX-License-Identifier: Apache-2.0
// What is around robots, and the legend of their materials.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "mercury/environment.h"
#include "mercury/material.h"
#include "render/scene.h"

namespace mercury {

// Land is ground without water.
render::Surroundings surroundings_of(const Environment& environment);

// The legend of robots with the default materials: the base materials of those that they have (`springs_of`, by id),
// alone or in pairs.
std::vector<std::pair<render::Color, std::string>> swatches_of(const std::array<bool, max_materials>& springs_of);

}  // namespace mercury
