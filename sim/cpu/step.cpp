#include "sim/cpu/step.h"

#include <algorithm>

namespace mercury::cpu {
namespace {

// Wraps around.
void add(std::int32_t& sum, float units) {
  sum = static_cast<std::int32_t>(static_cast<std::uint32_t>(sum) + static_cast<std::uint32_t>(round_to_int(units)));
}
void add(Sums& sums, std::size_t place, Vec3 units) {
  add(sums.reaction.x[place], units.x);
  add(sums.reaction.y[place], units.y);
  add(sums.reaction.z[place], units.z);
}

}  // namespace

StepSetting setting_of(const Configuration& configuration) {
  StepSetting setting;
  setting.solver = configuration.solver;
  setting.hooks = std::visit([](const auto& kind) { return AnyHooks(hooks_of(kind)); }, configuration.environment);
  if (const Land* land = std::get_if<Land>(&configuration.environment))
    setting.contact.stiffness = contact_stiffness_of(*land, configuration.solver, configuration.dt);
  setting.constants = {static_cast<float>(configuration.dt), static_cast<float>(1 / configuration.dt),
                       static_cast<float>(std::exp(-configuration.damping * configuration.dt))};
  return setting;
}

void add_pulls(Body& body) {
  for (const Pull& pull : body.pulls) {
    const Vec3 units = pull.stiffness * body.scale.force * (pull.target - body.position(pull.mass));
    if (fits(units)) add(body.sums, body.places.of_mass[pull.mass], units);
  }
}

void add_contacts(Body& body, float stiffness) {
  const float distance = body.measures.contact_distance();
  for (const auto& [i, j] : body.near_pairs.pairs()) {
    const Vec3 d = Body::at(body.x, j) - Body::at(body.x, i);
    const float squared = squared_length(d);
    if (!(squared < distance * distance)) continue;
    const Vec3 units = repulsion(squared, distance, stiffness * body.scale.force) * d;
    add(body.sums, i, units);
    add(body.sums, j, -units);
  }
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
  clear(body.sums);
}

}  // namespace mercury::cpu
