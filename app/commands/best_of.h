// SPDX-License-Identifier: Apache-2.0
// A search among random robots: simulates each and keeps those that move farthest.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/options/robot_output.h"
#include "mercury/configuration.h"
#include "mercury/robot.h"

namespace mercury {

struct Contest {
  std::uint64_t candidates = 0;  // number of robots to try
  Configuration configuration;   // of the trial
  std::int64_t steps = 0;        // length of the trial
  std::int64_t settling = 0;     // of these, at the start; they do not count for the distance
};

struct Winner {
  std::shared_ptr<const Robot> robot;
  double distance;  // of the centre of mass from where it was after settling; on land along the ground [m]
};

// Returns the `count` robots of a seed that move farthest, the best first; equal ones are ordered by index. Robots that
// cannot be made or that explode are left out. Returns fewer robots if too few are left or the user interrupts. The
// result does not depend on how many robots are simulated at once.
std::vector<Winner> best_of(const Contest& contest, const MakeRobot& make, std::uint64_t seed, std::uint64_t count);

}  // namespace mercury
