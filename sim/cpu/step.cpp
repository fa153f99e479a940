#include "sim/cpu/step.h"

#include <algorithm>

#include "sim/contact.h"

namespace mercury::cpu {
namespace {

void update_muscles(Body& body, std::int64_t steps_since_base) {
  for (std::size_t id = 0; id < max_materials; ++id)
    if (body.measures.used[id])
      body.law.factor[id] =
          muscle_factor(body.materials[id].amplitude, phase_at(body.phases[id], steps_since_base));
}

// Adds every spring's contribution, `law(squared, length, spring)` times d. False if one is beyond the stretch limit.
template <class Law>
bool add_springs(Body& body, const Law& law) {
  const Springs& springs = body.springs;
  float longest = 0;
  for (std::size_t s = 0; s < springs.a.size(); ++s) {
    const std::size_t a = springs.a[s], b = springs.b[s];
    const Vec3 d = body.x[b] - body.x[a];
    const float squared = squared_length(d);
    longest = squared > longest ? squared : longest;
    const float length = springs.rest_length[s] * body.law.factor[springs.material[s]];
    const float per_distance = law(squared, length, s);
    const std::int32_t fx = to_fixed_small(per_distance, d.x), fy = to_fixed_small(per_distance, d.y),
                       fz = to_fixed_small(per_distance, d.z);
    body.force.x[a] += fx;
    body.force.y[a] += fy;
    body.force.z[a] += fz;
    body.force.x[b] -= fx;
    body.force.y[b] -= fy;
    body.force.z[b] -= fz;
  }
  return longest <= body.measures.squared_stretch_limit();
}

bool add_spring_forces(Body& body) {
  return add_springs(body, [&](float squared, float length, std::size_t s) {
    return hooke(squared, length, body.law.stiffness[body.springs.material[s]]);
  });
}

bool add_spring_corrections(Body& body) {
  const float inverse_scale = 1 / body.scale.correction;
  return add_springs(body, [&](float squared, float length, std::size_t s) {
    return xpbd(squared, length, body.springs.splits[s] * inverse_scale,
                body.law.compliance[body.springs.material[s]]);
  });
}

void add(Sums& sums, std::size_t i, Vec3 units) {
  sums.x[i] += round_to_int(units.x);
  sums.y[i] += round_to_int(units.y);
  sums.z[i] += round_to_int(units.z);
}

// A third of each face's force to each of its masses. False, and the mass noted, if a force is out of range.
template <class Hooks>
bool add_face_forces(Body& body, const Hooks& hooks) {
  constexpr float third = 1.0f / 3.0f;
  for (const Face& face : body.robot->faces) {
    const Vec3 a = body.x[face.a];
    const Vec3 area_normal = 0.5f * cross(body.x[face.b] - a, body.x[face.c] - a);
    const Vec3 velocity = third * (body.v[face.a] + body.v[face.b] + body.v[face.c]);
    const Vec3 units = third * body.scale.force * hooks.on_face(area_normal, velocity);
    if (!fits(units)) {
      body.status.bad_mass = std::min({face.a, face.b, face.c});
      return false;
    }
    add(body.force, face.a, units);
    add(body.force, face.b, units);
    add(body.force, face.c, units);
  }
  return true;
}

void build_grid(Body& body, float inverse_size) {
  ContactGrid& grid = body.grid;
  const auto mask = static_cast<std::uint32_t>(grid.head.size() - 1);
  std::ranges::fill(grid.head, end_of_list);
  for (std::size_t i = 0; i < body.x.x.size(); ++i) {
    std::uint16_t& head = grid.head[bucket_of(cell_of(body.x[i], inverse_size), mask)];
    grid.next[i] = head;
    head = static_cast<std::uint16_t>(i);
  }
}

void add_contact(Body& body, std::uint16_t i, std::uint16_t j, float distance, float stiffness) {
  const Vec3 d = body.x[j] - body.x[i];
  const float squared = squared_length(d);
  if (!(squared < distance * distance) || body.neighbours.joined(i, j)) return;
  const Vec3 units = repulsion(squared, distance, stiffness * body.scale.force) * d;
  add(body.force, i, units);
  add(body.force, j, -units);
}

void add_contacts(Body& body, float stiffness) {
  const float distance = body.measures.contact_distance();
  if (stiffness == 0 || distance == 0) return;
  const float inverse_size = 1 / distance;
  build_grid(body, inverse_size);
  const auto mask = static_cast<std::uint32_t>(body.grid.head.size() - 1);
  for (std::size_t mass = 0; mass < body.x.x.size(); ++mass) {
    const auto i = static_cast<std::uint16_t>(mass);
    const Cell cell = cell_of(body.x[i], inverse_size);
    for (int n = 0; n < half_neighbourhood; ++n) {
      const Cell other = neighbour_cell(cell, n);
      for (std::uint16_t j = body.grid.head[bucket_of(other, mask)]; j != end_of_list; j = body.grid.next[j])
        if ((n > 0 || j > i) && cell_of(body.x[j], inverse_size) == other) add_contact(body, i, j, distance, stiffness);
    }
  }
}

void add_pulls(Body& body) {
  for (const Pull& pull : body.pulls) {
    const Vec3 units = pull.stiffness * body.scale.force * (pull.target - body.x[pull.mass]);
    if (fits(units)) add(body.force, pull.mass, units);
  }
}

template <class Hooks>
bool add_environment(Body& body, const Hooks& hooks, const ContactLaw& contact) {
  add_pulls(body);
  if constexpr (Hooks::has_contacts) add_contacts(body, contact.stiffness);
  if constexpr (Hooks::has_faces) return add_face_forces(body, hooks);
  return true;
}

Vec3 take(Sums& sums, std::size_t i, float inverse_scale) {
  const Vec3 value{static_cast<float>(sums.x[i]) * inverse_scale, static_cast<float>(sums.y[i]) * inverse_scale,
                   static_cast<float>(sums.z[i]) * inverse_scale};
  sums.x[i] = sums.y[i] = sums.z[i] = 0;
  return value;
}

// Stores a mass's new state unless it left the finite; then the mass stays and the robot has exploded.
bool store(Body& body, std::size_t i, Vec3 x, Vec3 v) {
  if (within_reach(x)) {
    body.x.set(i, x);
    body.v.set(i, v);
    return true;
  }
  body.status.bad_mass = std::min(body.status.bad_mass, static_cast<std::uint32_t>(i));
  return false;
}

// Algorithm 1.
template <class Hooks>
bool step_force(Body& body, const Hooks& hooks, const StepSetting& setting) {
  if (!add_environment(body, hooks, setting.contact) || !add_spring_forces(body)) return false;
  bool finite = true;
  for (std::size_t i = 0; i < body.x.x.size(); ++i) {
    Vec3 v = body.v[i];
    const Vec3 force = take(body.force, i, 1 / body.scale.force) + hooks.on_mass(v);
    v = accelerated(v, force, setting.constants);
    Vec3 x = multiply_add(setting.constants.dt, v, body.x[i]);
    end_step(x, v, hooks, setting.constants);
    finite &= store(body, i, x, v);
  }
  return finite;
}

// Algorithm 2. Between prediction and correction `body.x` holds the prediction and `body.v` the accelerated velocity.
template <class Hooks>
bool step_xpbd(Body& body, const Hooks& hooks, const StepSetting& setting) {
  if (!add_environment(body, hooks, setting.contact)) return false;
  const StepConstants& constants = setting.constants;
  bool finite = true;
  for (std::size_t i = 0; i < body.x.x.size(); ++i) {
    const Vec3 v = body.v[i];
    const Vec3 force = take(body.force, i, 1 / body.scale.force) + hooks.on_mass(v);
    const Vec3 predicted = accelerated(v, force, constants);
    finite &= store(body, i, multiply_add(constants.dt, predicted, body.x[i]), predicted);
  }
  if (!finite || !add_spring_corrections(body)) return false;
  for (std::size_t i = 0; i < body.x.x.size(); ++i) {
    const Vec3 correction = take(body.force, i, 1 / body.scale.correction);
    Vec3 x = body.x[i] + correction;
    Vec3 v = multiply_add(constants.inverse_dt, correction, body.v[i]);
    end_step(x, v, hooks, constants);
    finite &= store(body, i, x, v);
  }
  return finite;
}

template <class Hooks>
bool step_once(Body& body, const Hooks& hooks, const StepSetting& setting) {
  return setting.solver == Solver::force ? step_force(body, hooks, setting) : step_xpbd(body, hooks, setting);
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

void advance(Body& body, const StepSetting& setting, const Clock& clock, std::int64_t steps) {
  if (body.status.exploded_step >= 0) return;
  std::visit(
      [&](const auto& hooks) {
        for (std::int64_t n = 0; n < steps; ++n) {
          update_muscles(body, clock.step - clock.base_step + n);
          if (step_once(body, hooks, setting)) continue;
          body.status.exploded_step = clock.step + n;
          body.force.assign(body.x.x.size());
          return;
        }
      },
      setting.hooks);
}

}  // namespace mercury::cpu
