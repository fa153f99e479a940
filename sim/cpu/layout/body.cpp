// SPDX-License-Identifier: Apache-2.0
#include "sim/cpu/layout/body.h"

#include <algorithm>
#include <limits>

#include "mercury/telemetry.h"
#include "sim/physics/environments.h"
#include "sim/physics/fixed_point.h"
#include "sim/physics/springs.h"

namespace mercury::cpu {

namespace {

// What springs and masses have in the schedule and the slots of a body that steps alone.
void set_scheduled_parameters(Body& body) {
  if (!body.steps_alone) return;
  SpringSchedule& springs = body.springs;
  for (std::size_t i = 0; i < springs.stiffness.size(); ++i) {
    const std::uint32_t spring = springs.spring[i];
    springs.stiffness[i] = spring == no_spring ? 0 : body.stiffness[spring];
    springs.relaxation_time[i] =
        spring == no_spring ? 0 : body.materials[body.robot->springs[spring].material].relaxation_time;
  }
  for (std::size_t slot = 0; slot < body.slots.mass_at.size(); ++slot) {
    const std::uint32_t mass = body.slots.mass_at[slot];
    const PointProperties point = mass == no_mass ? PointProperties{0, 0} : body.point(mass);
    body.inverse_inertia[slot] = point.inverse_inertia;
    body.weight[slot] = point.weight;
  }
}

}  // namespace

Body make_body(const Robot& robot, std::size_t lanes) {
  Body body;
  body.robot = &robot;
  body.measures = measure(robot);
  body.slots = assign_slots(robot, lanes);
  body.topology_key = topology_key(robot);
  body.face_pairs = pair_faces(robot);
  body.cells = lattice_cells_of(robot);
  body.materials = materials_of(robot);
  body.stiffness.resize(robot.springs.size());
  const std::size_t size = body.slots.size_with_spare();
  body.x.assign(size, 0);
  body.v.assign(size, 0);
  return body;
}

void prepare_to_step_alone(Body& body) {
  if (body.steps_alone) return;
  body.steps_alone = true;
  body.springs = schedule_springs(*body.robot, body.slots);
  body.faces = schedule_faces(body.face_pairs, body.backs, body.slots);
  const std::size_t size = body.slots.size_with_spare();
  body.inverse_inertia.assign(size, 0);
  body.weight.assign(size, 0);
  set_scheduled_parameters(body);
  body.sums.own.assign(size, 0);
  body.sums.reaction.assign(reaction_arrays * size, 0);
  body.sums.scattered.assign(4 * size, 0);
  body.sums.taken.assign(size, 0);
  body.x_aos.assign(4 * size, 0);
  body.v_aos.assign(4 * size, 0);
}

void prepare_contacts(Body& body) {
  if (!body.near_pairs.is_prepared()) body.near_pairs = NearPairs(*body.robot, body.slots);
}

void set_materials(Body& body, std::span<const Material> table) {
  body.changed_materials.assign(table.begin(), table.end());
  body.materials = body.changed_materials;
  for (DrivenMaterial& driven : body.drives.materials) driven.own = table[driven.id];
}

void clear(Sums& sums) {
  for (Triples<std::int32_t>* triples : {&sums.own, &sums.reaction, &sums.taken}) {
    std::ranges::fill(triples->x, 0);
    std::ranges::fill(triples->y, 0);
    std::ranges::fill(triples->z, 0);
  }
  std::ranges::fill(sums.scattered, 0);
}

Configuration configuration_of(const Body& body, Configuration of_batch) {
  if (body.own) of_batch.environment = body.own->environment;
  return of_batch;
}

void update_spring_parameters(Body& body, const Configuration& of_batch) {
  const Robot& robot = *body.robot;
  const Configuration configuration = configuration_of(body, of_batch);
  const Environment& environment = configuration.environment;
  if (has_one_sided_water(environment) && body.backs.empty()) {
    body.backs = masses_behind(robot, body.face_pairs);
    if (body.steps_alone) body.faces = schedule_faces(body.face_pairs, body.backs, body.slots);
  }
  const bool real = has_own_points(robot, environment);
  body.points = real ? point_properties(robot, environment) : std::vector<PointProperties>();
  const InertiaRange inertia = inertia_range(body.points);
  body.contact_distance = contact_distance(robot, body.measures, environment);
  body.contact_stiffness = contact_stiffness_of(environment, configuration.solver, configuration.dt,
                                                stiffest_spring(body.measures, body.materials), inertia.lightest);
  body.scale = fixed_point_scale(body.measures, body.materials, configuration, body.contact_distance, inertia);
  const double scale = static_cast<double>(stiffness_scale_of(environment));
  const bool force = configuration.solver == Solver::force;
  // By material that springs have: stiffness (force solver) or compliance (XPBD), in units.
  std::array<float, max_materials> coefficient;
  body.viscous = has_viscous_springs(body.measures, body.materials);
  for (std::size_t id = 0; id < body.materials.size(); ++id) {
    if (!body.measures.used[id]) continue;
    const double stiffness = scale * static_cast<double>(body.materials[id].stiffness);
    coefficient[id] =
        force ? static_cast<float>(stiffness) * body.scale.force
              : static_cast<float>(1 / (stiffness * configuration.dt * configuration.dt)) / body.scale.correction;
  }
  coefficient[air] = force ? 0 : std::numeric_limits<float>::infinity();

  const std::vector<std::uint32_t> valence = force ? std::vector<std::uint32_t>() : valences(robot);
  const float per_scale = 1 / body.scale.correction, inverse_dt = static_cast<float>(1 / configuration.dt);
  for (std::size_t s = 0; s < robot.springs.size(); ++s) {
    const Spring& spring = robot.springs[s];
    const auto valence_at = [&](std::uint16_t mass) {
      return static_cast<float>(valence[mass]) * body.point(mass).inverse_inertia;
    };
    const auto valence_sum = [&] {
      return viscous_factor(body.materials[spring.material].relaxation_time, inverse_dt) *
             (valence_at(spring.a) + valence_at(spring.b));
    };
    body.stiffness[s] =
        force ? coefficient[spring.material] : xpbd_stiffness(valence_sum() * per_scale, coefficient[spring.material]);
  }
  set_scheduled_parameters(body);
}

void set_factors(Body& body, const std::array<FactorId, max_materials>& factors) {
  SpringSchedule& springs = body.springs;
  for (std::size_t i = 0; i < springs.factor.size(); ++i)
    springs.factor[i] =
        springs.spring[i] == no_spring ? FactorId{0} : factors[body.robot->springs[springs.spring[i]].material];
}

void set_state(Body& body, std::span<const Vec3> positions, std::span<const Vec3> velocities) {
  const auto set = [](Triples<float>& values, std::size_t slot, Vec3 value) {
    values.x[slot] = value.x;
    values.y[slot] = value.y;
    values.z[slot] = value.z;
  };
  for (std::size_t mass = 0; mass < positions.size(); ++mass) set(body.x, body.slots.of_mass[mass], positions[mass]);
  for (std::size_t mass = 0; mass < velocities.size(); ++mass) set(body.v, body.slots.of_mass[mass], velocities[mass]);
  for (const std::uint32_t slot : body.slots.padding) {
    set(body.x, slot, positions[0]);
    set(body.v, slot, {});
  }
  body.squared_diagonal = std::numeric_limits<float>::infinity();
  body.aos_is_current = false;
  body.written = true;
  body.near_pairs.forget();
}

}  // namespace mercury::cpu
