#include "sim/cpu/body.h"

#include <bit>

namespace mercury::cpu {
namespace {

Springs copy_springs(const Robot& robot) {
  Springs springs;
  const std::vector<std::uint32_t> at = springs_at_masses(robot);
  for (const Spring& spring : robot.springs) {
    springs.a.push_back(spring.a);
    springs.b.push_back(spring.b);
    springs.material.push_back(spring.material);
    springs.rest_length.push_back(spring.rest_length);
    springs.splits.push_back(static_cast<float>(at[spring.a] + at[spring.b]));
  }
  return springs;
}

Neighbours find_neighbours(const Robot& robot) {
  Neighbours neighbours;
  const std::vector<std::uint32_t> at = springs_at_masses(robot);
  neighbours.start.assign(at.size() + 1, 0);
  for (std::size_t i = 0; i < at.size(); ++i) neighbours.start[i + 1] = neighbours.start[i] + at[i];
  neighbours.mass.resize(neighbours.start.back());
  std::vector<std::uint32_t> next(neighbours.start.begin(), neighbours.start.end() - 1);
  for (const Spring& spring : robot.springs) {
    neighbours.mass[next[spring.a]++] = spring.b;
    neighbours.mass[next[spring.b]++] = spring.a;
  }
  return neighbours;
}

}  // namespace

Body make_body(const Robot& robot) {
  Body body;
  body.robot = &robot;
  body.measures = measure(robot);
  const std::size_t masses = robot.masses.size();
  body.x.resize(masses);
  body.v.resize(masses);
  for (std::size_t i = 0; i < masses; ++i) body.x.set(i, robot.masses[i]);
  body.force.assign(masses);
  body.springs = copy_springs(robot);
  body.neighbours = find_neighbours(robot);
  body.grid.head.resize(std::bit_ceil(2 * masses));
  body.grid.next.resize(masses);
  body.materials.assign(max_materials, {});
  std::ranges::copy(materials_of(robot), body.materials.begin());
  return body;
}

void update_laws(Body& body, const Configuration& configuration) {
  body.scale = fixed_point_scale(body.measures, body.materials, configuration);
  const double scale = static_cast<double>(stiffness_scale_of(configuration.environment));
  for (std::size_t id = 0; id < max_materials; ++id) {
    const double stiffness = scale * static_cast<double>(body.materials[id].stiffness);
    body.law.stiffness[id] = static_cast<float>(stiffness) * body.scale.force;
    body.law.compliance[id] =
        static_cast<float>(1 / (stiffness * configuration.dt * configuration.dt)) / body.scale.correction;
  }
}

void update_phases(Body& body, const Clock& clock) {
  body.phases.resize(max_materials);
  for (std::size_t id = 0; id < max_materials; ++id) body.phases[id] = muscle_phase(body.materials[id], clock);
}

}  // namespace mercury::cpu
