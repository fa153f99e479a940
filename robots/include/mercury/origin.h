// SPDX-License-Identifier: Apache-2.0
// What every robot's origin may say, whatever its kind. The origin (Robot::origin) is a JSON object that records how
// the robot was made.
#pragma once

#include <string>

#include "mercury/robot.h"

namespace mercury {

// The key "kind": "voxel", "nn", ..., usually a generator (generator.h). Empty if the origin has no such text.
std::string kind_of(const Robot& robot);

// The key "environment", where the robot belongs: "ocean", "ocean-simple", "land". Empty if the origin has no such
// text. It is not checked here; environment_named() checks it.
std::string environment_of(const Robot& robot);

}  // namespace mercury
