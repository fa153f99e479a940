// SPDX-License-Identifier: Apache-2.0
#include "sim/cpu/places.h"

#include <numeric>

#include "mercury/backend.h"

namespace mercury::cpu {

Places arrange(const Robot& robot, std::size_t lanes) {
  Places places;
  places.lanes = lanes;
  places.of_mass.resize(robot.masses.size());
  std::iota(places.of_mass.begin(), places.of_mass.end(), 0u);
  places.mass_at.assign((robot.masses.size() + lanes - 1) / lanes * lanes, no_mass);
  for (std::uint32_t mass = 0; mass < places.of_mass.size(); ++mass) places.mass_at[places.of_mass[mass]] = mass;
  for (std::uint32_t place = 0; place < places.mass_at.size(); ++place)
    if (places.mass_at[place] == no_mass) places.stand_ins.push_back(place);
  return places;
}

}  // namespace mercury::cpu
