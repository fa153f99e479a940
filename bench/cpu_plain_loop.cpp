// SPDX-License-Identifier: Apache-2.0
#include "bench/cpu_plain_loop.h"

#include <algorithm>
#include <bit>

#include "sim/physics/contact.h"
#include "sim/physics/fixed_point.h"

namespace mercury::bench {

PlainLoop::PlainLoop(const Robot& robot, const Configuration& configuration)
    : robot_(robot), configuration_(configuration), measures_(measure(robot)), faces_(pair_faces(robot)),
      backs_(masses_behind(robot, faces_)) {
  std::array<Material, max_materials> materials{};
  std::ranges::copy(materials_of(robot), materials.begin());
  const bool real = has_own_points(robot, configuration.environment);
  points_ =
      real ? point_properties(robot, configuration.environment) : std::vector<PointProperties>(robot.masses.size());
  const InertiaRange inertia = inertia_range(points_);
  highest_length_rate_ = highest_length_rate(measures_, materials);
  contact_distance_ = contact_distance(robot, measures_, configuration.environment);
  scale_ = fixed_point_scale(measures_, materials, configuration, contact_distance_, inertia);
  const Clock clock{.dt = configuration.dt};
  const double scale = static_cast<double>(stiffness_scale_of(configuration.environment));
  for (std::size_t id = 0; id < max_materials; ++id) {
    const double stiffness = scale * static_cast<double>(materials[id].stiffness);
    stiffness_[id] = static_cast<float>(stiffness) * scale_.force;
    compliance_[id] = static_cast<float>(1 / (stiffness * configuration.dt * configuration.dt)) / scale_.correction;
    phases_[id] = muscle_phase(materials[id], clock);
  }
  contact_stiffness_ = contact_stiffness_of(configuration.environment, configuration.solver, configuration.dt,
                                            stiffest_spring(measures_, materials), inertia.lightest);
  constants_ = step_constants(configuration);
  const std::size_t masses = robot.masses.size();
  state_ = {robot.masses, start_velocities(robot)};
  sums_.resize(masses);
  neighbors_.resize(masses);
  heads_.resize(std::bit_ceil(2 * masses));
  links_.resize(masses);
  const std::vector<std::uint32_t> at = valences(robot);
  for (const Spring& spring : robot.springs) {
    const auto valence_at = [&](std::uint16_t mass) {
      return static_cast<float>(at[mass]) * points_[mass].inverse_inertia;
    };
    relaxation_times_.push_back(materials[spring.material].relaxation_time);
    valence_sums_.push_back(viscous_factor(relaxation_times_.back(), constants_.inverse_dt) *
                            (valence_at(spring.a) + valence_at(spring.b)));
    neighbors_[spring.a].push_back(spring.b);
    neighbors_[spring.b].push_back(spring.a);
  }
}

void PlainLoop::update_muscles() {
  const std::span<const Material> materials = materials_of(robot_);
  for (std::size_t id = 0; id < materials.size(); ++id)
    if (measures_.used[id]) factor_[id] = muscle_factor(materials[id], phase_at(phases_[id], now_));
}

// Adds each spring's contribution, per_distance_of(squared length, rest length, spring) times d. Returns false if a
// spring is beyond the stretch limit.
template <class PerDistance>
bool PlainLoop::add_springs(const PerDistance& per_distance_of) {
  float longest_squared = 0;
  for (std::size_t s = 0; s < robot_.springs.size(); ++s) {
    const Spring& spring = robot_.springs[s];
    const Vec3 d = state_.positions[spring.b] - state_.positions[spring.a];
    const float squared = squared_length(d);
    longest_squared = squared > longest_squared ? squared : longest_squared;
    // Not without viscosity: an infinite velocity would make it NaN.
    const float approach =
        relaxation_times_[s] == 0 ? 0 : inner(d, state_.velocities[spring.b] - state_.velocities[spring.a]);
    const float length = viscous_length(spring.rest_length * factor_[spring.material], relaxation_times_[s],
                                        length_rate(squared, approach, highest_length_rate_));
    const float per_distance = per_distance_of(squared, length, s);
    const auto units = [&](float along) { return static_cast<std::uint32_t>(to_fixed_small(per_distance, along)); };
    const std::uint32_t fx = units(d.x), fy = units(d.y), fz = units(d.z);
    Sum &a = sums_[spring.a], &b = sums_[spring.b];
    a.x += fx;
    a.y += fy;
    a.z += fz;
    b.x -= fx;
    b.y -= fy;
    b.z -= fz;
  }
  return longest_squared <= measures_.squared_stretch_limit();
}

bool PlainLoop::add_spring_forces() {
  return add_springs([&](float squared, float length, std::size_t s) {
    return hooke(squared, length, stiffness_[robot_.springs[s].material]);
  });
}

bool PlainLoop::add_spring_corrections() {
  const float inverse_scale = 1 / scale_.correction;
  return add_springs([&](float squared, float length, std::size_t s) {
    return xpbd(squared, length, valence_sums_[s] * inverse_scale, compliance_[robot_.springs[s].material]);
  });
}

void PlainLoop::add(std::size_t mass, Vec3 units) {
  sums_[mass].x += static_cast<std::uint32_t>(round_to_int(units.x));
  sums_[mass].y += static_cast<std::uint32_t>(round_to_int(units.y));
  sums_[mass].z += static_cast<std::uint32_t>(round_to_int(units.z));
}

// Adds a third of each face's force to each of its masses. If a force is out of range, notes the lowest of its masses
// and returns false.
template <class EnvironmentModel>
bool PlainLoop::add_face_forces(const EnvironmentModel& model) {
  const FaceCoefficients<float> coefficients = model.of_sums(scale_.environment);
  bool fit = true;
  std::uint32_t pair = 0;
  for (const auto& [a, b, c, d] : faces_) {
    const std::uint32_t dither = dither_of_pair(pair++) + dither_of_step(now_);
    const std::vector<Vec3>&x = state_.positions, &v = state_.velocities;
    const Vec3 to_c = x[c] - x[a], common = v[a] + v[c] - model.thrice_flow;
    const auto on_face = [&](Vec3 normal, Vec3 sum, std::uint16_t PairBacks::*face) {
      FaceCoefficients<float> by = coefficients;
      if constexpr (EnvironmentModel::has_one_sided_water)
        if (model.one_sided) {
          const std::uint16_t behind = backs_[pair - 1].*face;
          model.see_from_outside(normal, x[behind] - x[a], v[behind], sum, by);
        }
      return model.on_face(normal, sum, inner(sum, sum), by);
    };
    const Vec3 first = on_face(cross(to_c, x[b] - x[a]), common + v[b], &PairBacks::first);
    const Vec3 second = on_face(cross(x[d] - x[a], to_c), common + v[d], &PairBacks::second);
    if (!fits(first) || !fits(second)) {
      bad_mass_ = std::min({bad_mass_, std::uint32_t{a}, std::uint32_t{b}, std::uint32_t{c}, std::uint32_t{d}});
      fit = false;
      continue;
    }
    const Vec3 on_first = dithered(first, dither, model.dither());
    const Vec3 on_second = dithered(second, dither + second_face_dither, model.dither());
    for (const std::uint16_t corner : {a, b, c}) add(corner, on_first);
    for (const std::uint16_t corner : {a, c, d}) add(corner, on_second);
  }
  return fit;
}

bool PlainLoop::joined(std::uint16_t i, std::uint16_t j) const {
  return std::ranges::find(neighbors_[i], j) != neighbors_[i].end();
}

void PlainLoop::add_contact(std::uint16_t i, std::uint16_t j, float distance) {
  const Vec3 d = state_.positions[j] - state_.positions[i];
  const float squared = squared_length(d);
  if (!(squared < distance * distance) || joined(i, j)) return;
  const Vec3 units = repulsion(squared, distance, contact_stiffness_ * scale_.environment) * d;
  add(i, units);
  add(j, -units);
}

void PlainLoop::add_contacts() {
  const float distance = contact_distance_;
  if (contact_stiffness_ == 0 || distance == 0) return;
  // Cells are a little larger than the distance, so that rounding cannot separate masses that touch.
  const float inverse_size = 1 / (1.01f * distance);
  const auto mask = static_cast<std::uint32_t>(heads_.size() - 1);
  std::ranges::fill(heads_, end_of_list);
  for (std::size_t i = 0; i < links_.size(); ++i) {
    std::uint16_t& head = heads_[bucket_of(hash_of(cell_of(state_.positions[i], inverse_size)), mask)];
    links_[i] = head;
    head = static_cast<std::uint16_t>(i);
  }
  for (std::size_t mass = 0; mass < links_.size(); ++mass) {
    const auto i = static_cast<std::uint16_t>(mass);
    const Cell cell = cell_of(state_.positions[i], inverse_size);
    for (int n = 0; n < half_neighborhood; ++n) {
      const Cell other = cell + neighbor(n);
      for (std::uint16_t j = heads_[bucket_of(hash_of(other), mask)]; j != end_of_list; j = links_[j])
        if ((n > 0 || j > i) && cell_of(state_.positions[j], inverse_size) == other) add_contact(i, j, distance);
    }
  }
}

void PlainLoop::add_perturbations() {
  for (const Perturbation& perturbation : perturbations_) {
    const Vec3 units =
        perturbation.stiffness * scale_.environment * (perturbation.target - state_.positions[perturbation.mass]);
    if (fits(units)) add(perturbation.mass, units);
  }
}

template <class EnvironmentModel>
bool PlainLoop::add_environment(const EnvironmentModel& model) {
  add_perturbations();
  if constexpr (EnvironmentModel::has_contacts) add_contacts();
  if constexpr (EnvironmentModel::has_faces) return !model.acts_on_faces() || add_face_forces(model);
  return true;
}

Vec3 PlainLoop::take(std::size_t mass, float inverse_scale) {
  const Sum sum = sums_[mass];
  sums_[mass] = {};
  const auto value = [](std::uint32_t units) { return static_cast<float>(static_cast<std::int32_t>(units)); };
  return inverse_scale * Vec3{value(sum.x), value(sum.y), value(sum.z)};
}

// Stores a mass's new state. If that is out of reach, keeps the old one and returns false: the robot has exploded.
bool PlainLoop::store_state(std::size_t mass, Vec3 x, Vec3 v) {
  if (within_reach(x)) {
    state_.positions[mass] = x;
    state_.velocities[mass] = v;
    return true;
  }
  bad_mass_ = std::min(bad_mass_, static_cast<std::uint32_t>(mass));
  return false;
}

// The velocity that all forces on a mass lead to, before damping.
template <class EnvironmentModel>
Vec3 PlainLoop::accelerate(std::size_t mass, const EnvironmentModel& model) {
  const Vec3 v = state_.velocities[mass], force = take(mass, 1 / scale_.environment);
  if constexpr (EnvironmentModel::real_bodies) {
    const auto [inverse_inertia, weight] = points_[mass];
    return accelerated(v, inverse_inertia * (force + model.on_mass(v, weight)), constants_);
  } else {
    return accelerated(v, force + model.on_mass(v), constants_);
  }
}

template <class EnvironmentModel>
bool PlainLoop::end(std::size_t mass, Vec3 x, Vec3 v, const EnvironmentModel& model) {
  if constexpr (EnvironmentModel::real_bodies)
    end_step(x, v, points_[mass].inverse_inertia, model, constants_);
  else
    end_step(x, v, model, constants_);
  return store_state(mass, x, v);
}

// The end of Algorithm 1, after the forces of the environment.
template <class EnvironmentModel>
bool PlainLoop::step_springs(const EnvironmentModel& model) {
  bool finite = true;
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    const Vec3 force = take(i, 1 / scale_.force);
    const Vec3 v = accelerated(state_.velocities[i], points_[i].inverse_inertia * force, constants_);
    finite &= end(i, multiply_add(constants_.dt, v, state_.positions[i]), v, model);
  }
  return finite;
}

// Algorithm 1.
template <class EnvironmentModel>
bool PlainLoop::step_force(const EnvironmentModel& model) {
  if (!add_environment(model)) return false;
  if constexpr (EnvironmentModel::real_bodies)
    if (model.sums_apart()) {
      for (std::size_t i = 0; i < sums_.size(); ++i) state_.velocities[i] = accelerate(i, model);
      return add_spring_forces() && step_springs(model);
    }
  if (!add_spring_forces()) return false;
  bool finite = true;
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    const Vec3 v = accelerate(i, model);
    finite &= end(i, multiply_add(constants_.dt, v, state_.positions[i]), v, model);
  }
  return finite;
}

// Algorithm 2. Between prediction and correction the state holds the prediction and the accelerated velocity.
template <class EnvironmentModel>
bool PlainLoop::step_xpbd(const EnvironmentModel& model) {
  if (!add_environment(model)) return false;
  bool finite = true;
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    const Vec3 predicted = accelerate(i, model);
    finite &= store_state(i, multiply_add(constants_.dt, predicted, state_.positions[i]), predicted);
  }
  if (!finite || !add_spring_corrections()) return false;
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    const Vec3 correction = points_[i].inverse_inertia * take(i, 1 / scale_.correction);
    finite &= end(i, state_.positions[i] + correction,
                  multiply_add(constants_.inverse_dt, correction, state_.velocities[i]), model);
  }
  return finite;
}

void PlainLoop::step(std::int64_t steps) {
  const AnyEnvironmentModel any_model =
      solver_model_of(configuration_, has_own_points(robot_) || has_viscous_springs(measures_, materials_of(robot_)));
  const auto step_once = [&](const auto& model) {
    return configuration_.solver == Solver::force ? step_force(model) : step_xpbd(model);
  };
  for (std::int64_t n = 0; n < steps && exploded_step_ < 0; ++n, ++now_) {
    update_muscles();
    if (!std::visit(step_once, any_model)) exploded_step_ = now_;
  }
}

}  // namespace mercury::bench
