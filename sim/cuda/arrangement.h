// SPDX-License-Identifier: Apache-2.0
// The arrangement of a topology on the device: the slots of its masses, the schedule of its springs, and its face
// tiles. Robots of one topology share an arrangement, whatever their materials, rest lengths and states are.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "sim/cuda/face_tiles.h"
#include "sim/cuda/schedule.h"
#include "sim/cuda/slot_order.h"
#include "sim/cuda/tile.h"

namespace mercury::cuda {

struct Arrangement {
  std::shared_ptr<const SlotOrder> order;
  Schedule schedule;
  std::vector<FacePair> faces;  // in face tiles, padding included
};

// `pairs` = pair_faces(robot). The last `ghosts` masses are ghosts (parts.h).
Arrangement arrange(const Robot& robot, std::span<const FacePair> pairs, std::uint32_t ghosts = 0);
inline Arrangement arrange(const Robot& robot) { return arrange(robot, pair_faces(robot)); }

// For each robot the first one of the same topology (mercury/robot.h), which may be the robot itself. `keys` = those of
// their topologies. Uses all cores, as the other one does.
std::vector<std::uint32_t> first_of_topology(std::span<const Robot* const> robots, std::span<const std::uint64_t> keys);
std::vector<std::uint32_t> first_of_topology(std::span<const Robot* const> robots);

}  // namespace mercury::cuda
