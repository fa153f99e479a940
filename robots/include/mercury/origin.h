// SPDX-License-Identifier: Apache-2.0
// What a robot's origin says, whatever its kind.
#pragma once

#include <string>

#include "mercury/robot.h"

namespace mercury {

// Origin key "kind": "voxel", "nn", ...; empty where it is not said.
std::string kind_of(const Robot& robot);

// Origin key "environment", where the robot is meant to live: "ocean", "ocean-simple", "land"; empty where it is not
// said. The text is the file's; environment_named() judges it.
std::string environment_of(const Robot& robot);

}  // namespace mercury
