// SPDX-License-Identifier: Apache-2.0
// Lines for the user on robots that a configuration does not step as they are meant.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "mercury/configuration.h"
#include "mercury/robot.h"

namespace mercury {

// That XPBD softens the springs of one, that one vibrates too fast for the time step. Uses all cores, and of robots
// that appear several times in a row it looks at one.
std::vector<std::string> robot_notes(std::span<const std::shared_ptr<const Robot>> robots,
                                     const Configuration& configuration);

}  // namespace mercury
