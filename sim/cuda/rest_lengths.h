// SPDX-License-Identifier: Apache-2.0
// The table of a robot's rest lengths (layout.h).
#pragma once

#include <cstdint>
#include <vector>

#include "mercury/robot.h"

namespace mercury::cuda {

struct RestLengths {
  // The different rest lengths in ascending order, beginning with 0 for padding [m]. It ends after max_lengths + 1 of
  // them.
  std::vector<float> table;
  // [spring] where the table has its rest length; empty if there are more than max_lengths.
  std::vector<std::uint8_t> index;
};

RestLengths rest_lengths(const Robot& robot);

// Words of the robot's spring records: 1 if its rest lengths fit into a table, else 2.
std::uint32_t record_words_for(const Robot& robot);

}  // namespace mercury::cuda
