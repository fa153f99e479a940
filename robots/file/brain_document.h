// SPDX-License-Identifier: Apache-2.0
// Sensors and brain in a robot's document (docs/brains.md).
#pragma once

#include <string_view>

#include "mercury/robot.h"
#include "robots/file/document.h"

namespace mercury {

// Give a robot the list of sensors, or the brain, of this JSON text. Keys that the format does not know are ignored.
// Throw InputError with the place as a JSON pointer for what is no list of sensors, or no brain; validate_brain()
// checks whether it fits the robot.
void read_sensors(std::string_view text, Robot& robot);
void read_brain(std::string_view text, Robot& robot);

void write_sensors(const Robot& robot, DocumentEvents& events);
void write_brain(const Brain& brain, DocumentEvents& events);

}  // namespace mercury
