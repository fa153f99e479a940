// SPDX-License-Identifier: Apache-2.0
// A search among many random robots: each is simulated, the ones that get farthest are kept.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "app/options/robot_output.h"
#include "mercury/configuration.h"
#include "mercury/robot.h"

namespace mercury {

struct Contest {
  std::uint64_t candidates = 0;  // how many robots take part
  Configuration configuration;   // where they are tried
  std::int64_t steps = 0;        // for how long
  std::int64_t settling = 0;     // of these steps, those before the distance is measured
};

struct Winner {
  Robot robot;
  double distance;  // that its centre of mass got from where it was once settled; on land along the ground [m]
};

// The `count` robots of a seed that get farthest, the best first; equals in the order of their index. Robots that
// cannot be made or explode take no prize. Fewer are returned when fewer can be, or when the user interrupts. The
// result does not depend on how many are simulated at once.
std::vector<Winner> best_of(const Contest& contest, const MakeRobot& make, std::uint64_t seed, std::uint64_t count);

}  // namespace mercury
