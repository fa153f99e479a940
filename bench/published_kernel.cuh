// SPDX-License-Identifier: Apache-2.0
// The kernel as the paper describes it (II.C), to be measured beside Mercury's on the same card and robots: one block a
// robot, its masses in shared memory (position, velocity, force: 36 bytes each), one thread a spring, forces summed by
// float atomics, one step a launch.
#pragma once

#include <cstdint>
#include <span>

#include "mercury/robot.h"

namespace mercury::published {

struct Result {
  double springs_a_second = 0;
  long long steps = 0;
  double seconds = 0;  // by device events
};

// Steps copies of the robots in water with surface drag (the defaults of Ocean) for at least `least_seconds` after a
// warm-up. Throws DeviceError without a device, or if a robot has more masses than fit into a block's shared memory.
Result measure(std::span<const Robot> robots, double least_seconds);

// Positions of one robot after `steps` steps, to check that the kernel computes the same physics.
std::vector<Vec3> positions_after(const Robot& robot, int steps);

}  // namespace mercury::published
