// SPDX-License-Identifier: Apache-2.0
// The sample robots. Each records in its origin where it belongs.
#pragma once

#include <vector>

#include "mercury/robot.h"

namespace mercury::library {

// Swimmers: muscles of some 100 kPa, stiff enough to bend a body against water, in waves that run from head to tail.
Robot eel();
Robot fish();
Robot ray();
Robot manta();
Robot jellyfish();
Robot squid();
Robot turtle();

// Crawlers: legs whose feet run round ellipses, bodies that lift themselves over the ground in waves.
Robot quadruped();
Robot beetle();
Robot inchworm();
Robot caterpillar();
Robot sea_star();
Robot hopper();

std::vector<Robot> all_designs();

// Found by searches: those of thousands of random robots that got farthest. A build without network robots has none of
// the latter.
std::vector<Robot> found_voxel_robots();
std::vector<Robot> found_network_robots();

// All of the above.
std::vector<Robot> all_robots();

// Of real materials.
std::vector<Robot> animals();

}  // namespace mercury::library
