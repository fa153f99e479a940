// SPDX-License-Identifier: Apache-2.0
// Whether a robot's masses fit into a multiprocessor's own memory, where CUDA steps them without leaving the chip.
#pragma once

#include <cstddef>

#include "mercury/configuration.h"
#include "mercury/robot.h"

namespace mercury {

// Shared memory of a block that steps this one robot, with no room spent on speed [bytes]: 36 a mass (paper, table II),
// the table of materials, rest lengths, and on land the grid that finds contacts. A device whose blocks may have
// so much steps the robot on the chip, the contacts too.
std::size_t chip_bytes(const Robot& robot, const Configuration& configuration);

struct ChipFit {
  std::size_t most_bytes = 0;      // shared memory that a block may have on the device [bytes]
  bool on_chip = false;            // masses are stepped on the chip, else in device memory, more slowly
  bool contacts_on_chip = false;   // and so are the lists of contacts
  std::size_t robots_at_once = 0;  // how many such robots the device steps at the same time
};

// How a large batch of robots like this one lies on a CUDA device. Throws DeviceError where there is none of that
// index.
ChipFit chip_fit(const Robot& robot, const Configuration& configuration, int device);

}  // namespace mercury
