// SPDX-License-Identifier: Apache-2.0
// How a robot of a certain build stands on the device: which slot each mass has, the rows of its springs, the bundles
// of its faces. Robots of one build share it, whatever their materials, lengths and states are.
#pragma once

#include <span>
#include <vector>

#include "sim/cuda/layout.h"
#include "sim/cuda/schedule.h"

namespace mercury::cuda {

struct Arrangement {
  SlotOrder order;
  Schedule schedule;            // of slots
  std::vector<FacePair> faces;  // of slots, in bundles
};

Arrangement arrange(const Robot& robot);

// For each robot the first one of the same build (mercury/robot.h), itself if there is none before. Uses all cores.
std::vector<std::uint32_t> first_of_build(std::span<const Robot* const> robots);

}  // namespace mercury::cuda
