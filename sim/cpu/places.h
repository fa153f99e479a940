// SPDX-License-Identifier: Apache-2.0
// Where a robot's masses stand in the CPU's arrays.
#pragma once

#include <cstdint>
#include <vector>

#include "mercury/robot.h"

namespace mercury::cpu {

// Places are cut into blocks of as many as an instruction has lanes. A place without a mass is a stand-in.
struct Places {
  std::size_t lanes = 1;
  std::vector<std::uint32_t> of_mass;
  std::vector<std::uint32_t> mass_at;  // no_mass at stand-ins
  std::vector<std::uint32_t> stand_ins;

  std::size_t blocks() const { return mass_at.size() / lanes; }
  // Behind the last block there is room for one more, which loads that do not start at a block may reach.
  std::size_t padded() const { return mass_at.size() + lanes; }
};

Places arrange(const Robot& robot, std::size_t lanes);

}  // namespace mercury::cpu
