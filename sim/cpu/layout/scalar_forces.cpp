// SPDX-License-Identifier: Apache-2.0
#include "sim/cpu/layout/scalar_forces.h"

#include "sim/physics/integration.h"

namespace mercury::cpu {
namespace {

void add(Sums& sums, std::size_t slot, Vec3 units) {
  add_units(sums.reaction.x[slot], units.x);
  add_units(sums.reaction.y[slot], units.y);
  add_units(sums.reaction.z[slot], units.z);
}

}  // namespace

void add_perturbations(Body& body) {
  for (const Perturbation& perturbation : body.perturbations) {
    const Vec3 units =
        perturbation.stiffness * body.scale.environment * (perturbation.target - body.position(perturbation.mass));
    if (fits(units)) add(body.sums, body.slots.of_mass[perturbation.mass], units);
  }
}

void add_contacts(Body& body) {
  for_each_contact(
      body, [&](std::uint32_t slot) { return Body::at(body.x, slot); },
      [&](std::uint32_t slot, Vec3 units) { add(body.sums, slot, units); });
}

bool accept_state(Body& body) {
  for (std::uint32_t mass = 0; mass < body.slots.of_mass.size(); ++mass)
    if (!within_reach(body.position(mass))) {
      body.status.bad_mass = mass;
      return false;
    }
  body.written = false;
  return true;
}

void explode(Body& body, std::int64_t step) {
  body.status.exploded_step = step;
  body.aos_is_current = false;
  body.squared_diagonal = std::numeric_limits<float>::infinity();
  clear(body.sums);
}

}  // namespace mercury::cpu
