// SPDX-License-Identifier: Apache-2.0
// Replaces found_networks.cpp in a build that grows no network robots.
#include "robots/library/designs.h"

namespace mercury::library {

std::vector<Robot> found_network_robots() { return {}; }

}  // namespace mercury::library
