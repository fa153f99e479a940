// SPDX-License-Identifier: Apache-2.0
// What is around robots, and the legend of their materials.
#pragma once

#include <memory>
#include <span>

#include "app/scene/robot_shape.h"
#include "mercury/environment.h"
#include "mercury/robot.h"
#include "render/scene.h"

namespace mercury {

// Land is ground without water.
render::Surroundings surroundings_of(const Environment& environment);

// The legend of the materials of springs. Robots with the default materials have the base materials of theirs, alone or
// in pairs; others those of their own tables by name, each with its middle color. Where names do not say which muscles
// differ, because several phases share one or because there are very many, muscles are a wheel of phases instead.
render::Legend material_legend(std::span<const Robot* const> robots,
                               std::span<const std::shared_ptr<const RobotShape>> shapes);

}  // namespace mercury
