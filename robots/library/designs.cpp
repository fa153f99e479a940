// SPDX-License-Identifier: Apache-2.0
#include "robots/library/designs.h"

namespace mercury::library {

std::vector<Robot> all_designs() {
  return {eel(),      fish(),      ray(),    manta(),    jellyfish(),   squid(), turtle(),
          sea_star(), quadruped(), beetle(), inchworm(), caterpillar(), hopper()};
}

std::vector<Robot> all_robots() {
  std::vector<Robot> robots = all_designs();
  for (auto& some : {found_voxel_robots(), found_network_robots()})
    robots.insert(robots.end(), some.begin(), some.end());
  return robots;
}

}  // namespace mercury::library
