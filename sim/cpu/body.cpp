#include "sim/cpu/body.h"

#include <algorithm>
#include <limits>

#include "sim/cpu/build.h"

namespace mercury::cpu {

Body make_body(const Robot& robot, std::size_t lanes) {
  Body body;
  body.robot = &robot;
  body.measures = measure(robot);
  body.places = arrange(robot, lanes);
  body.build_key = build_key(robot);
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
  body.splits.assign(padded, 0);
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
  body.scale = fixed_point_scale(body.measures, body.materials, configuration);
  const double scale = static_cast<double>(stiffness_scale_of(configuration.environment));
  for (std::size_t id = 0; id < max_materials; ++id) {
    const double stiffness = scale * static_cast<double>(body.materials[id].stiffness);
    body.hardness[id] = configuration.solver == Solver::force
                       ? static_cast<float>(stiffness) * body.scale.force
                       : static_cast<float>(1 / (stiffness * configuration.dt * configuration.dt)) / body.scale.correction;
  }
  body.hardness[air] = configuration.solver == Solver::force ? 0 : std::numeric_limits<float>::infinity();
  SpringPlan& springs = body.springs;
  for (std::size_t i = 0; i < springs.hardness.size(); ++i) springs.hardness[i] = body.hardness[springs.material[i]];

  const std::vector<std::uint32_t> at = springs_at_masses(*body.robot);
  for (std::size_t mass = 0; mass < at.size(); ++mass) {
    const std::size_t place = body.places.of_mass[mass];
    body.splits[place] = static_cast<float>(at[mass]) / body.scale.correction;
    body.x_rows[4 * place + 3] = body.splits[place];
  }
}

void set_factors(Body& body, const std::array<FactorId, max_materials>& factors) {
  SpringPlan& springs = body.springs;
  for (std::size_t i = 0; i < springs.factor.size(); ++i) springs.factor[i] = factors[springs.material[i]];
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
  body.compact = false;
  body.rows_are_current = false;
  body.written = true;
  body.near_pairs.forget();
}

}  // namespace mercury::cpu
