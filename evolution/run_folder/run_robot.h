// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "mercury/robot.h"
#include "mercury/run_folder.h"

namespace mercury {

// The robot of an individual, "RUN-ID", with its ancestry in the origin. Throws InputError if it cannot be grown.
Robot run_robot(const RunHistory& run, std::uint64_t id);

}  // namespace mercury
