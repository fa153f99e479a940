// SPDX-License-Identifier: Apache-2.0
#include "sim/cpu/body.h"

#include <algorithm>
#include <limits>

#include "mercury/telemetry.h"
#include "sim/cpu/build.h"
#include "sim/physics/springs.h"

namespace mercury::cpu {

Body make_body(const Robot& robot, std::size_t lanes) {
  Body body;
  body.robot = &robot;
  body.measures = measure(robot);
  body.places = arrange(robot, lanes);
  body.topology_key = topology_key(robot);
  body.springs = plan_springs(robot, body.places);
  body.face_pairs = pair_faces(robot);
  body.faces = plan_faces(body.face_pairs, body.places);
  body.cells = cells_of(robot);
  body.near_pairs = NearPairs(robot, body.places);
  body.materials.assign(max_materials, {});
  std::ranges::copy(materials_of(robot), body.materials.begin());
  const std::size_t padded = body.places.padded();
  body.x.assign(padded, 0);
  body.v.assign(padded, 0);
  body.sums.own.assign(padded, 0);
  body.sums.reaction.assign(reaction_arrays * padded, 0);
  body.sums.rows.assign(4 * padded, 0);
  body.sums.taken.assign(padded, 0);
  body.x_rows.assign(4 * padded, 0);
  body.v_rows.assign(4 * padded, 0);
  return body;
}

void clear(Sums& sums) {
  for (Triples<std::int32_t>* triples : {&sums.own, &sums.reaction, &sums.taken}) {
    std::ranges::fill(triples->x, 0);
    std::ranges::fill(triples->y, 0);
    std::ranges::fill(triples->z, 0);
  }
  std::ranges::fill(sums.rows, 0);
}

void update_laws(Body& body, const Configuration& configuration) {
  const Robot& robot = *body.robot;
  body.scale = fixed_point_scale(body.measures, body.materials, configuration);
  const double scale = static_cast<double>(stiffness_scale_of(configuration.environment));
  const bool force = configuration.solver == Solver::force;
  std::array<float, max_materials> of_material;  // stiffness or compliance
  for (std::size_t id = 0; id < max_materials; ++id) {
    const double stiffness = scale * static_cast<double>(body.materials[id].stiffness);
    of_material[id] =
        force ? static_cast<float>(stiffness) * body.scale.force
              : static_cast<float>(1 / (stiffness * configuration.dt * configuration.dt)) / body.scale.correction;
  }
  of_material[air] = force ? 0 : std::numeric_limits<float>::infinity();

  const std::vector<std::uint32_t> at = valences(robot);
  const float per_scale = 1 / body.scale.correction;
  body.hardness.resize(robot.springs.size());
  for (std::size_t s = 0; s < robot.springs.size(); ++s) {
    const Spring& spring = robot.springs[s];
    const float of_its = of_material[spring.material];
    body.hardness[s] =
        force ? of_its : xpbd_stiffness(static_cast<float>(at[spring.a] + at[spring.b]) * per_scale, of_its);
  }
  SpringPlan& springs = body.springs;
  for (std::size_t i = 0; i < springs.hardness.size(); ++i)
    springs.hardness[i] = springs.spring[i] == no_spring ? 0 : body.hardness[springs.spring[i]];
}

void set_factors(Body& body, const std::array<FactorId, max_materials>& factors) {
  SpringPlan& springs = body.springs;
  for (std::size_t i = 0; i < springs.factor.size(); ++i)
    springs.factor[i] =
        springs.spring[i] == no_spring ? FactorId{0} : factors[body.robot->springs[springs.spring[i]].material];
}

void set_state(Body& body, std::span<const Vec3> positions, std::span<const Vec3> velocities) {
  const auto set = [](Triples<float>& values, std::size_t place, Vec3 value) {
    values.x[place] = value.x;
    values.y[place] = value.y;
    values.z[place] = value.z;
  };
  for (std::size_t mass = 0; mass < positions.size(); ++mass) set(body.x, body.places.of_mass[mass], positions[mass]);
  for (std::size_t mass = 0; mass < velocities.size(); ++mass) set(body.v, body.places.of_mass[mass], velocities[mass]);
  for (const std::uint32_t place : body.places.stand_ins) {
    set(body.x, place, positions[0]);
    set(body.v, place, {});
  }
  body.squared_diagonal = std::numeric_limits<float>::infinity();
  body.rows_are_current = false;
  body.written = true;
  body.near_pairs.forget();
}

}  // namespace mercury::cpu
