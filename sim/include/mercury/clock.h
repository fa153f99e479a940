// SPDX-License-Identifier: Apache-2.0
// The time of a simulation, as a count of steps.
#pragma once

#include <cstdint>

#include "mercury/host_device.h"

namespace mercury {

// The instant at which a step begins: time = base_time + (step - base_step) dt.
//
// Time is not summed step by step, because every addition would round: after 1e9 steps of 1 ms the sum would be off by
// milliseconds. When dt changes, the base moves to the current instant and counting goes on with the new dt.
//
//     base_time                        time
//         |--dt--|--dt--|--dt--|--dt--|
//     base_step                       step
struct Clock {
  double dt = 1e-3;            // time step since the base [s]
  double base_time = 0;        // [s]
  std::int64_t base_step = 0;  // number of the step at base_time, at least 0
  std::int64_t step = 0;       // steps since the start of the simulation, at least base_step
};

// [s]
MERCURY_HOST_DEVICE double time_of(const Clock& clock) {
  return clock.base_time + static_cast<double>(clock.step - clock.base_step) * clock.dt;
}

}  // namespace mercury
