// SPDX-License-Identifier: Apache-2.0
// Where a robot is simulated, in the terms of VXA.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mercury/configuration.h"
#include "mercury/import.h"

namespace mercury {

struct VxaWorld {
  ImportedSettings settings;
  std::vector<std::string> lost;  // what VXA cannot say, a sentence each
};

// `seconds`: how long to simulate; none = the file does not say.
VxaWorld vxa_world(const Environment& environment, double damping, std::optional<double> seconds = {});

}  // namespace mercury
