// SPDX-License-Identifier: Apache-2.0
// Forces on few masses, computed one by one: perturbations and contacts. Also what happens to a body when it explodes.
#pragma once

#include "sim/cpu/layout/body.h"
#include "sim/physics/environments.h"

namespace mercury::cpu {

// Rounds, and wraps around.
inline void add_units(std::int32_t& sum, float units) {
  sum = static_cast<std::int32_t>(static_cast<std::uint32_t>(sum) + static_cast<std::uint32_t>(round_to_int(units)));
}

void add_perturbations(Body& body);
// Of the listed pairs.
void add_contacts(Body& body);

// Calls add(slot, units) for both masses of each listed pair that touches, their positions being positions(slot).
template <class Positions, class Add>
void for_each_contact(const Body& body, const Positions& positions, const Add& add) {
  const float distance = body.contact_distance;
  for (const auto& [i, j] : body.near_pairs.pairs()) {
    const Vec3 d = positions(j) - positions(i);
    const float squared = squared_length(d);
    if (!(squared < distance * distance)) continue;
    const Vec3 units = repulsion(squared, distance, body.contact_stiffness * body.scale.environment) * d;
    add(i, units);
    add(j, -units);
  }
}

// Checks a state that the caller has set. If a mass is out of reach, notes the first such mass and returns false.
bool accept_state(Body& body);

// Notes that this step ended in an explosion, and clears what it left half done.
void explode(Body& body, std::int64_t step);

}  // namespace mercury::cpu
