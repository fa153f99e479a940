// SPDX-License-Identifier: Apache-2.0
// The kernel as the paper describes it (II.C), to be compared with Mercury's on the same GPU and robots: one block per
// robot, masses in shared memory (position, velocity, force: 36 bytes each), one thread per spring, forces summed by
// float atomics, one step per launch.
#pragma once

#include <cstdint>
#include <span>

#include "mercury/robot.h"

namespace mercury::published {

struct Result {
  double springs_per_second = 0;
  long long steps = 0;
  double seconds = 0;  // by device events
};

// Steps the robots in water with surface drag (the defaults of Ocean) for at least `min_seconds` after a warm-up.
// Throws DeviceError without a device, or if a robot has more masses than fit into a block's shared memory.
Result measure(std::span<const Robot> robots, double min_seconds);

// Positions of one robot after this many steps, to check that the kernel computes the same physics.
std::vector<Vec3> positions_after(const Robot& robot, int steps);

}  // namespace mercury::published
