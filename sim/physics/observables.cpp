// SPDX-License-Identifier: Apache-2.0
#include "mercury/observables.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "sim/physics/environments.h"
#include "sim/physics/face_backs.h"
#include "sim/physics/muscle.h"

namespace mercury {

MaterialNow material_at(const Material& material, const Environment& environment, const Clock& clock) {
  const std::uint64_t phase = phase_at(muscle_phase(material, clock), clock.step - clock.base_step);
  return {.stiffness = stiffness_scale_of(environment) * material.stiffness,
          .length_factor = muscle_factor(material, phase),
          .length_rate = muscle_rate(material, phase)};
}

std::vector<MaterialNow> materials_at(std::span<const Material> table, const Environment& environment,
                                      const Clock& clock) {
  std::vector<MaterialNow> now;
  now.reserve(table.size());
  for (const Material& material : table) now.push_back(material_at(material, environment, clock));
  return now;
}

std::vector<MaterialNow> materials_at(std::span<const Material> table, const Environment& environment, double time) {
  return materials_at(table, environment, Clock{.base_time = time});
}

float contraction(const Material& material, double time) {
  const float sine = sine_of_phase(muscle_phase(material, Clock{.base_time = time}).at_base);
  return -material.amplitude * std::min(sine, highest_sine(material));
}

std::array<double, 3> mean_over_masses(const Robot& robot, std::span<const Vec3> values) {
  std::array<double, 3> sum{};
  double total = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto mass = static_cast<double>(mass_of(robot, i));
    total += mass;
    sum[0] += mass * static_cast<double>(values[i].x);
    sum[1] += mass * static_cast<double>(values[i].y);
    sum[2] += mass * static_cast<double>(values[i].z);
  }
  for (double& each : sum) each /= total;
  return sum;
}

std::vector<Vec3> spring_forces(const Robot& robot, std::span<const MaterialNow> materials,
                                std::span<const Vec3> positions) {
  std::vector<Vec3> forces(robot.masses.size());
  for (const Spring& spring : robot.springs) {
    const MaterialNow& material = materials[spring.material];
    const Vec3 d = positions[spring.b] - positions[spring.a];
    // Masses in one place exert no force on each other, as in the solvers.
    const float length_now = std::max(length(d), 1e-10f);
    const float along =
        spring_force(material.stiffness, stretch(length_now, spring.rest_length, material.length_factor));
    const Vec3 on_a = (along / length_now) * d;
    forces[spring.a] += on_a;
    forces[spring.b] -= on_a;
  }
  return forces;
}

Vec3 mass_force(const Environment& environment, float weight, Vec3 velocity) {
  return GeneralModel(environment).on_mass(velocity, weight);
}

FaceForce face_force(const Environment& environment, const Face& face, std::span<const Vec3> positions,
                     std::span<const Vec3> velocities, std::optional<std::uint16_t> behind) {
  const Vec3 a = positions[face.a], b = positions[face.b], c = positions[face.c];
  const Vec3 area_normal = 0.5f * cross(b - a, c - a);
  const float third = 1.0f / 3;
  FaceForce result{.center = third * (a + b + c), .area = length(area_normal), .drag = {}, .lift = {}};
  if (has_face_forces(environment)) {
    const GeneralModel model(environment);
    FaceCoefficients<float> by = model.coefficients();
    Vec3 sum = velocities[face.a] + velocities[face.b] + velocities[face.c] - model.thrice_flow;
    if (behind && model.one_sided)
      model.see_from_outside(area_normal, positions[*behind] - a, velocities[*behind], sum, by);
    const Vec3 flow = -third * sum;
    const float squared = dot(flow, flow);
    const Vec3 force = GeneralModel::on_face(area_normal, flow, squared, by);
    result.drag = squared > 0 ? (dot(force, flow) / squared) * flow : Vec3{};
    result.lift = force - result.drag;
  }
  return result;
}

std::vector<std::uint16_t> masses_behind_faces(const Robot& robot, const Environment& environment) {
  std::vector<std::uint16_t> behind;
  behind.reserve(robot.faces.size());
  if (!has_one_sided_water(environment)) {
    for (const Face& face : robot.faces) behind.push_back(face.a);
    return behind;
  }
  const FaceBacks backs(robot);
  for (const Face& face : robot.faces) behind.push_back(backs.behind(face));
  return behind;
}

std::vector<FloorForce> floor_forces(const Robot& robot, const Configuration& configuration,
                                     std::span<const MaterialNow> materials, std::span<const Vec3> positions,
                                     std::span<const Vec3> velocities) {
  const auto* plane = std::get_if<Plane>(&configuration.environment.ground);
  if (!plane) return {};
  const std::vector<Vec3> springs = spring_forces(robot, materials, positions);
  const auto inverse_dt = static_cast<float>(1 / configuration.dt);
  std::vector<FloorForce> forces;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (positions[i].z > 0) continue;
    // The force that leaves the mass where it is.
    const float mass = mass_of(robot, i);
    const Vec3 hold = -(springs[i] + mass * (configuration.environment.gravity + inverse_dt * velocities[i]));
    if (!(hold.z > 0)) continue;
    const float along = std::hypot(hold.x, hold.y);
    const float share = along > static_friction_of(*plane) * hold.z ? plane->friction * hold.z / along : 1;
    forces.push_back({static_cast<std::uint32_t>(i), {share * hold.x, share * hold.y, hold.z}});
  }
  return forces;
}

}  // namespace mercury
