// SPDX-License-Identifier: Apache-2.0
// mercury run by an evaluator: any number of robots in bounded memory.
#pragma once

#include <cstdint>

#include "app/options/robot_options.h"
#include "app/recording/report.h"
#include "mercury/configuration.h"

namespace mercury {

inline constexpr double sample_period = 0.1;  // time between two samples of the telemetry [s]

// Simulates the robots, with a progress bar. If the user interrupts, the report holds those robots that
// have made all steps; if there is none yet, those that have come as far as the first. Robots that could not be made
// are reported on standard error and left out. Throws InputError if none of a request could be made.
RunReport evaluate(const RobotSequence& robots, const Configuration& configuration, std::int64_t steps);

}  // namespace mercury
