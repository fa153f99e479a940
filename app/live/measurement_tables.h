// SPDX-License-Identifier: Apache-2.0
// Measurements as tables: CSV, with names and units in the first line.
#pragma once

#include <string>
#include <vector>

#include "app/live/measurements.h"
#include "app/live/scene_document.h"

namespace mercury {

// Time series, one column per robot and quantity.
std::string series_csv(const SceneDocument& document, const Measurements& measurements,
                       const std::vector<RobotId>& robots);
// One line per robot, those that went farthest first.
std::string ranking_csv(const SceneDocument& document, const Measurements& measurements);

}  // namespace mercury
