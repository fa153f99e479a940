// SPDX-License-Identifier: Apache-2.0
// The telemetry of a body.
#pragma once

#include "sim/cpu/layout/body.h"

namespace mercury::cpu {

Telemetry measure_state(const Body& body, const Configuration& configuration, const Clock& clock);

}  // namespace mercury::cpu
