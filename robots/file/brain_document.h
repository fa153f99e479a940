// SPDX-License-Identifier: Apache-2.0
// Sensors and brain in a robot's document (docs/brains.md); mercury/robot_file.h reads them.
#pragma once

#include "mercury/robot.h"
#include "robots/file/document.h"

namespace mercury {

void write_sensors(const Robot& robot, DocumentEvents& events);
void write_brain(const Brain& brain, DocumentEvents& events);

}  // namespace mercury
