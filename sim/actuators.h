// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mercury/robot.h"

namespace mercury {

// The part of validate() that is about actuators.
void validate_actuators(const Robot& robot);

}  // namespace mercury
