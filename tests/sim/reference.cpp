// SPDX-License-Identifier: Apache-2.0
#include "reference.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mercury::reference {

Vector vector_of(Vec3 v) { return {v.x, v.y, v.z}; }

double rest_length(const Material& material, double rest_length, double time) {
  const double omega = material.frequency, phi = material.phase, amplitude = material.amplitude;
  const double sine = std::sin(omega * time + phi);
  return rest_length * (1 + amplitude * (material.half_wave ? std::min(0.0, sine) : sine));
}

Reference::Reference(const Configuration& configuration, const Robot& robot)
    : configuration_(configuration), robot_(robot), springs_at_(robot.masses.size(), 0.0) {
  double shortest = std::numeric_limits<double>::infinity();
  for (const Spring& spring : robot.springs) {
    joined_.insert({spring.a, spring.b});
    joined_.insert({spring.b, spring.a});
    springs_at_[spring.a] += 1;
    springs_at_[spring.b] += 1;
    shortest = std::min(shortest, double{spring.rest_length});
  }
  if (!robot.springs.empty())
    contact_distance_ =
        shortest *
        (configuration.environment.contacts ? double{configuration.environment.contacts->contact_distance} : 0.5);
  for (const Vec3 mass : robot.masses) x_.push_back(vector_of(mass));
  v_.assign(x_.size(), Vector::Zero());
  for (std::size_t i = 0; i < robot.velocity.size(); ++i) v_[i] = vector_of(robot.velocity[i]);
  set_inertia();
  if (const auto* water = std::get_if<ResistiveDrag>(&configuration.environment.water); water && water->one_sided)
    for (const Face& face : robot.faces) behind_.push_back(mass_behind(face));
  if (has_ground(configuration.environment)) {
    double lowest = std::numeric_limits<double>::infinity();
    for (const Vector& x : x_) lowest = std::min(lowest, x.z());
    for (Vector& x : x_) x.z() -= lowest;
  }
}

void Reference::set_state(const State& state) {
  for (std::size_t i = 0; i < x_.size(); ++i) {
    x_[i] = vector_of(state.positions[i]);
    v_[i] = vector_of(state.velocities[i]);
  }
}

double Reference::stiffness(const Spring& spring) const {
  const double scale = configuration_.environment.stiffness_scale;
  return scale * materials_of(robot_)[spring.material].stiffness;
}

double Reference::length_now(const Spring& spring) const {
  return rest_length(materials_of(robot_)[spring.material], spring.rest_length, time());
}

void Reference::step(std::int64_t steps) {
  const double dt = configuration_.dt;
  const double zeta = std::exp(-configuration_.damping * dt);
  for (std::int64_t step = 0; step < steps; ++step, ++steps_) {
    Field force = environment_forces();
    if (configuration_.solver == Solver::force) {
      const Field elastic = spring_forces();
      for (std::size_t i = 0; i < x_.size(); ++i) force[i] += elastic[i];
    }
    Field next(x_.size());
    for (std::size_t i = 0; i < x_.size(); ++i) next[i] = x_[i] + dt * v_[i] + dt * dt * inverse_inertia_[i] * force[i];
    if (configuration_.solver == Solver::xpbd) project_springs(next);
    resolve_contact(next);
    const Vector flow = vector_of(flow_of(configuration_.environment));
    for (std::size_t i = 0; i < x_.size(); ++i) {
      if (inverse_inertia_[i] == 0) {
        next[i] = x_[i] + dt * v_[i];
        continue;
      }
      v_[i] = flow + zeta * ((next[i] - x_[i]) / dt - flow);
    }
    x_ = next;
  }
}

// Hooke's law, paper, equation 2, in parallel with a dashpot (Kelvin-Voigt).
Field Reference::spring_forces() const {
  Field force(x_.size(), Vector::Zero());
  for (const Spring& spring : robot_.springs) {
    const Vector d = x_[spring.b] - x_[spring.a];
    if (d.norm() == 0) continue;
    const double rate = d.dot(v_[spring.b] - v_[spring.a]) / d.norm();
    const double tau = materials_of(robot_)[spring.material].relaxation_time;
    const Vector pull = stiffness(spring) * (d.norm() - length_now(spring) + tau * rate) * d.normalized();
    force[spring.a] += pull;
    force[spring.b] -= pull;
  }
  return force;
}

// Paper, equations 3 and 4, with - L restored and the masses split among their springs. Viscous springs as in Macklin,
// Mueller and Chentanez, XPBD (2016), equation 26: x - x^n is the way from the start of the step.
void Reference::project_springs(Field& predicted) const {
  const double dt = configuration_.dt;
  Field correction(x_.size(), Vector::Zero());
  for (const Spring& spring : robot_.springs) {
    const Vector d = predicted[spring.b] - predicted[spring.a];
    if (d.norm() == 0) continue;
    const double constraint = d.norm() - length_now(spring);
    const double compliance = 1 / (stiffness(spring) * dt * dt);
    const double gamma = double{materials_of(robot_)[spring.material].relaxation_time} / dt;
    const Vector way = (predicted[spring.b] - x_[spring.b]) - (predicted[spring.a] - x_[spring.a]);
    const double wa = inverse_inertia_[spring.a], wb = inverse_inertia_[spring.b];
    const double lambda = (constraint + gamma * d.normalized().dot(way)) /
                          ((1 + gamma) * (wa * springs_at_[spring.a] + wb * springs_at_[spring.b]) + compliance);
    correction[spring.a] += wa * lambda * d.normalized();
    correction[spring.b] -= wb * lambda * d.normalized();
  }
  for (std::size_t i = 0; i < x_.size(); ++i) predicted[i] += correction[i];
}

Field Reference::environment_forces() const {
  const Environment& environment = configuration_.environment;
  Field force(x_.size());
  for (std::size_t i = 0; i < x_.size(); ++i) force[i] = weight_[i] * vector_of(environment.gravity);
  if (const auto* water = std::get_if<FaceDrag>(&environment.water)) add_surface_drag(*water, force);
  if (const auto* water = std::get_if<ResistiveDrag>(&environment.water)) add_resistive_drag(*water, force);
  if (const auto* simple = std::get_if<PointDrag>(&environment.water))
    for (std::size_t i = 0; i < x_.size(); ++i)
      force[i] += double{simple->point_drag} * (vector_of(simple->flow) - v_[i]);
  if (environment.contacts && environment.contacts->self_collision) add_repulsion(*environment.contacts, force);
  for (const Perturbation& perturbation : perturbations_)
    if (perturbation.robot == 0)
      force[perturbation.mass] +=
          double{perturbation.stiffness} * (vector_of(perturbation.target) - x_[perturbation.mass]);
  return force;
}

// Paper, equation 1, of the flow relative to the face, and tangential drag; the normal points downstream.
void Reference::add_surface_drag(const FaceDrag& ocean, Field& force) const {
  for (const Face& face : robot_.faces) {
    const Vector u = vector_of(ocean.flow) - (v_[face.a] + v_[face.b] + v_[face.c]) / 3;
    const Vector twice_area = (x_[face.b] - x_[face.a]).cross(x_[face.c] - x_[face.a]);
    if (twice_area.norm() == 0) continue;
    const double area = twice_area.norm() / 2;
    Vector n = twice_area.normalized();
    if (n.dot(u) < 0) n = -n;
    const double drag = ocean.drag_coefficient, lift = ocean.lift_coefficient;
    Vector total = 0.5 * ocean.density * area * ((drag - lift) * u.dot(n) * u + lift * u.squaredNorm() * n);
    const Vector slide = u - u.dot(n) * n;
    total += 0.5 * ocean.density * area * ocean.drag_tangential * slide.norm() * slide;
    for (const int corner : {face.a, face.b, face.c}) force[static_cast<std::size_t>(corner)] += total / 3;
  }
}

// Of the masses that springs join to all corners, the one that is farthest from the middle of the face in the rest
// pose, and more than a tenth of that off its plane.
int Reference::mass_behind(const Face& face) const {
  const Vector a = vector_of(robot_.masses[face.a]), b = vector_of(robot_.masses[face.b]),
               c = vector_of(robot_.masses[face.c]);
  int found = -1;
  double farthest = 0;
  for (int i = 0; i < static_cast<int>(robot_.masses.size()); ++i) {
    if (!joined_.contains({i, face.a}) || !joined_.contains({i, face.b}) || !joined_.contains({i, face.c})) continue;
    const Vector way = vector_of(robot_.masses[static_cast<std::size_t>(i)]) - (a + b + c) / 3;
    const double depth = std::abs((b - a).cross(c - a).normalized().dot(way));
    if (depth <= way.norm() / 10 || way.norm() <= farthest * 1.0001) continue;
    farthest = way.norm();
    found = i;
  }
  return found;
}

// Resistive theory: the parts of the flow across and along a face act apart. One-sided water meets the middle between
// the face and the mass behind it, and pushes only where that goes outward, away from this mass.
void Reference::add_resistive_drag(const ResistiveDrag& water, Field& force) const {
  for (std::size_t i = 0; i < robot_.faces.size(); ++i) {
    const Face& face = robot_.faces[i];
    const Vector twice_area = (x_[face.b] - x_[face.a]).cross(x_[face.c] - x_[face.a]);
    if (twice_area.norm() == 0) continue;
    Vector velocity = (v_[face.a] + v_[face.b] + v_[face.c]) / 3;
    const bool has_body = water.one_sided && behind_[i] >= 0;
    const auto behind = static_cast<std::size_t>(has_body ? behind_[i] : face.a);
    if (has_body) velocity = (velocity + v_[behind]) / 2;
    const Vector u = vector_of(water.flow) - velocity;
    Vector across = u.dot(twice_area.normalized()) * twice_area.normalized();
    const Vector along = u - across, outward = (x_[face.a] + x_[face.b] + x_[face.c]) / 3 - x_[behind];
    const double side = outward.dot(twice_area) > 0 ? 1 : -1;
    if (has_body && -across.dot(side * twice_area) < 0) across.setZero();
    const Vector total =
        0.25 * water.density * twice_area.norm() *
        (water.normal_coefficient * across.norm() * across + water.tangential_coefficient * along.norm() * along);
    for (const int corner : {face.a, face.b, face.c}) force[static_cast<std::size_t>(corner)] += total / 3;
  }
}

// A mass of the skin displaces the body's volume by its share of the skin's area.
void Reference::set_inertia() {
  std::vector<double> area(x_.size());
  double skin = 0, volume = 0;
  for (const Face& face : robot_.faces) {
    const Vector a = vector_of(robot_.masses[face.a]), b = vector_of(robot_.masses[face.b]),
                 c = vector_of(robot_.masses[face.c]);
    const double own = (b - a).cross(c - a).norm() / 2;
    for (const int corner : {face.a, face.b, face.c}) area[static_cast<std::size_t>(corner)] += own / 3;
    skin += own;
    volume += a.dot(b.cross(c)) / 6;
  }
  const auto* water = std::get_if<ResistiveDrag>(&configuration_.environment.water);
  for (std::size_t i = 0; i < x_.size(); ++i) {
    const double mass = mass_of(robot_, i);
    const double displaced = water && skin > 0 ? water->density * volume * area[i] / skin : 0;
    weight_.push_back(mass - displaced);
    inverse_inertia_.push_back(1 / (mass + (water ? water->added_mass_coefficient * displaced : 0)));
  }
  for (const int point : robot_.fixed) inverse_inertia_[static_cast<std::size_t>(point)] = 0;
}

// Every pair is looked at: slow, but there is no grid to get wrong.
void Reference::add_repulsion(const Contacts& contacts, Field& force) const {
  double k = double{contacts.contact_stiffness} * double{configuration_.environment.stiffness_scale};
  if (contacts.relative_stiffness > 0) {
    double stiffest = 0;
    for (const Spring& spring : robot_.springs) stiffest = std::max(stiffest, stiffness(spring));
    k = contacts.relative_stiffness * stiffest;
  }
  const double dt = configuration_.dt;
  if (configuration_.solver == Solver::xpbd)  // docs/physics.md, Contact
    k = std::min(k, 1 / (8 * dt * dt * std::ranges::max(inverse_inertia_)));
  for (std::size_t i = 0; i < x_.size(); ++i)
    for (std::size_t j = i + 1; j < x_.size(); ++j) {
      const Vector d = x_[j] - x_[i];
      if (d.squaredNorm() >= contact_distance_ * contact_distance_ || d.squaredNorm() == 0) continue;
      if (joined_.contains({static_cast<int>(i), static_cast<int>(j)})) continue;
      const Vector push = k * (contact_distance_ - d.norm()) * d.normalized();
      force[i] -= push;
      force[j] += push;
    }
}

// The floor z = 0: out of it, and the step's tangential move shortened by at most friction times the depth; to nothing
// where it is at most the static friction times that.
void Reference::resolve_contact(Field& next) const {
  const auto* plane = std::get_if<Plane>(&configuration_.environment.ground);
  if (!plane) return;
  for (std::size_t i = 0; i < next.size(); ++i) {
    if (next[i].z() >= 0) continue;
    const double depth = -next[i].z();
    Vector slide = next[i] - x_[i];
    slide.z() = 0;
    const double kept = std::max(0.0, slide.norm() - double{plane->friction} * depth);
    if (slide.norm() <= double{plane->static_friction} * depth)
      slide.setZero();
    else
      slide *= kept / slide.norm();
    next[i] = {x_[i].x() + slide.x(), x_[i].y() + slide.y(), 0};
  }
}

Vector Reference::center_of_mass() const {
  Vector sum = Vector::Zero();
  double mass = 0;
  for (std::size_t i = 0; i < x_.size(); mass += mass_of(robot_, i++)) sum += double{mass_of(robot_, i)} * x_[i];
  return sum / mass;
}

Vector Reference::center_velocity() const {
  Vector sum = Vector::Zero();
  double mass = 0;
  for (std::size_t i = 0; i < v_.size(); mass += mass_of(robot_, i++)) sum += double{mass_of(robot_, i)} * v_[i];
  return sum / mass;
}

double Reference::kinetic_energy() const {
  double sum = 0;
  for (std::size_t i = 0; i < v_.size(); ++i) sum += double{mass_of(robot_, i)} * v_[i].squaredNorm() / 2;
  return sum;
}

double Reference::elastic_energy() const {
  double sum = 0;
  for (const Spring& spring : robot_.springs) {
    const double stretch = (x_[spring.b] - x_[spring.a]).norm() - length_now(spring);
    sum += stiffness(spring) * stretch * stretch / 2;
  }
  return sum;
}

double Reference::muscle_power() const {
  double sum = 0;
  for (const Spring& spring : robot_.springs) {
    const Material& material = materials_of(robot_)[spring.material];
    const double rest = spring.rest_length, amplitude = material.amplitude, omega = material.frequency;
    const double angle = omega * time() + double{material.phase};
    if (material.half_wave && std::sin(angle) >= 0) continue;
    const double rate = rest * amplitude * omega * std::cos(angle);
    sum -= stiffness(spring) * ((x_[spring.b] - x_[spring.a]).norm() - length_now(spring)) * rate;
  }
  return sum;
}

double Reference::strain(const Spring& spring) const {
  const double rest = spring.rest_length;
  return std::abs((x_[spring.b] - x_[spring.a]).norm() - rest) / rest;
}

double Reference::largest_strain() const {
  double largest = 0;
  for (const Spring& spring : robot_.springs) largest = std::max(largest, strain(spring));
  return largest;
}

std::int64_t Reference::springs_beyond(double limit) const {
  return std::ranges::count_if(robot_.springs, [&](const Spring& spring) { return strain(spring) > limit; });
}

double largest_deviation(const Field& expected, const std::vector<Vec3>& actual) {
  if (expected.size() != actual.size()) return std::numeric_limits<double>::infinity();
  double largest = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const double deviation = (expected[i] - vector_of(actual[i])).norm();
    if (!(deviation <= largest)) largest = std::isnan(deviation) ? std::numeric_limits<double>::infinity() : deviation;
  }
  return largest;
}

}  // namespace mercury::reference
