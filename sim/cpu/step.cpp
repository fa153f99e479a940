// SPDX-License-Identifier: Apache-2.0
#include "sim/cpu/step.h"

#include <algorithm>

namespace mercury::cpu {
namespace {

void add(Sums& sums, std::size_t place, Vec3 units) {
  add_units(sums.reaction.x[place], units.x);
  add_units(sums.reaction.y[place], units.y);
  add_units(sums.reaction.z[place], units.z);
}

}  // namespace

StepSetting setting_of(const Configuration& configuration) {
  StepSetting setting;
  setting.solver = configuration.solver;
  setting.model =
      std::visit([](const auto& kind) { return AnyEnvironmentModel(model_of(kind)); }, configuration.environment);
  if (const Land* land = std::get_if<Land>(&configuration.environment))
    setting.contact.stiffness = contact_stiffness_of(*land, configuration.solver, configuration.dt);
  setting.constants = {static_cast<float>(configuration.dt), static_cast<float>(1 / configuration.dt),
                       static_cast<float>(std::exp(-configuration.damping * configuration.dt))};
  return setting;
}

void add_perturbations(Body& body) {
  for (const Perturbation& perturbation : body.perturbations) {
    const Vec3 units =
        perturbation.stiffness * body.scale.force * (perturbation.target - body.position(perturbation.mass));
    if (fits(units)) add(body.sums, body.places.of_mass[perturbation.mass], units);
  }
}

void add_contacts(Body& body, float stiffness) {
  for_each_contact(
      body, stiffness, [&](std::uint32_t place) { return Body::at(body.x, place); },
      [&](std::uint32_t place, Vec3 units) { add(body.sums, place, units); });
}

bool accept_state(Body& body) {
  for (std::uint32_t mass = 0; mass < body.places.of_mass.size(); ++mass)
    if (!within_reach(body.position(mass))) {
      body.status.bad_mass = mass;
      return false;
    }
  body.written = false;
  return true;
}

void explode(Body& body, std::int64_t step) {
  body.status.exploded_step = step;
  body.rows_are_current = false;
  body.squared_diagonal = std::numeric_limits<float>::infinity();
  clear(body.sums);
}

}  // namespace mercury::cpu
