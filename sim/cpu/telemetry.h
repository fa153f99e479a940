// SPDX-License-Identifier: Apache-2.0
// A robot's state in a few numbers.
#pragma once

#include "sim/cpu/body.h"

namespace mercury::cpu {

Telemetry measure_state(const Body& body, const Configuration& configuration, const Clock& clock);

}  // namespace mercury::cpu
