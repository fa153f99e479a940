// SPDX-License-Identifier: Apache-2.0
#include "sim/cpu/layout/slots.h"

#include <numeric>

#include "mercury/backend.h"

namespace mercury::cpu {

Slots assign_slots(const Robot& robot, std::size_t lanes) {
  Slots slots;
  slots.lanes = lanes;
  slots.of_mass.resize(robot.masses.size());
  std::iota(slots.of_mass.begin(), slots.of_mass.end(), 0u);
  slots.mass_at.assign((robot.masses.size() + lanes - 1) / lanes * lanes, no_mass);
  for (std::uint32_t mass = 0; mass < slots.of_mass.size(); ++mass) slots.mass_at[slots.of_mass[mass]] = mass;
  for (std::uint32_t slot = 0; slot < slots.mass_at.size(); ++slot)
    if (slots.mass_at[slot] == no_mass) slots.padding.push_back(slot);
  return slots;
}

}  // namespace mercury::cpu
