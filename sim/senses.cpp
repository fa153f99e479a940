// SPDX-License-Identifier: Apache-2.0
#include "sim/senses.h"

#include <cmath>

#include "sim/physics/muscle.h"

namespace mercury {
namespace {

Double3 scaled(double factor, Double3 v) { return {factor * v.x, factor * v.y, factor * v.z}; }
double component_of(Double3 v, std::uint32_t component) { return component == 0 ? v.x : component == 1 ? v.y : v.z; }
double mass_of_point(const Robot& robot, std::size_t i) { return static_cast<double>(mass_of(robot, i)); }

// Mass-weighted mean of `vectors` over some points, or over all.
Double3 mean(const Robot& robot, std::span<const Vec3> vectors, std::span<const std::uint16_t> some, bool all) {
  Double3 sum;
  double weight = 0;
  const auto add = [&](std::size_t i) {
    sum = sum + scaled(mass_of_point(robot, i), Double3(vectors[i]));
    weight += mass_of_point(robot, i);
  };
  if (all)
    for (std::size_t i = 0; i < vectors.size(); ++i) add(i);
  else
    for (const std::uint16_t i : some) add(i);
  return scaled(1 / weight, sum);
}

}  // namespace

SensedBody::SensedBody(const Robot& robot, const BrainPlan& plan, std::span<const Vec3> positions,
                       std::span<const Vec3> velocities, const Environment& environment, Vec3 target)
    : robot_(robot), plan_(plan), positions_(positions), velocities_(velocities), environment_(environment),
      target_(target), places_(plan.places.size() + 1) {}

std::span<const std::uint16_t> SensedBody::masses(std::uint32_t place) const {
  return place == BrainPlan::none ? std::span<const std::uint16_t>() : plan_.places[place].masses;
}

SensedBody::OfPlace& SensedBody::of(std::uint32_t place) {
  return place == BrainPlan::none ? places_.back() : places_[place];
}

Double3 SensedBody::center(std::uint32_t place) {
  std::optional<Double3>& known = of(place).center;
  if (!known) known = mean(robot_, positions_, masses(place), place == BrainPlan::none);
  return *known;
}

Double3 SensedBody::velocity(std::uint32_t place) {
  std::optional<Double3>& known = of(place).velocity;
  if (!known) known = mean(robot_, velocities_, masses(place), place == BrainPlan::none);
  return *known;
}

// The mean over springs of (|d| - L0) / L0, or of its rate d . (v_b - v_a) / (|d| L0).
double SensedBody::strain(std::uint32_t place, bool rate) {
  OfPlace& known = of(place);
  if (!known.strain) {
    double strain = 0, strain_rate = 0;
    std::size_t count = 0;
    const auto add = [&](const Spring& spring) {
      const Double3 d = Double3(positions_[spring.b]) - Double3(positions_[spring.a]);
      const Double3 v = Double3(velocities_[spring.b]) - Double3(velocities_[spring.a]);
      const double length = std::sqrt(dot(d, d)), rest = static_cast<double>(spring.rest_length);
      strain += (length - rest) / rest;
      if (length > 0) strain_rate += dot(d, v) / (length * rest);
      ++count;
    };
    if (place == BrainPlan::none)
      for (const Spring& spring : robot_.springs) add(spring);
    else
      for (const std::uint32_t spring : plan_.places[place].springs) add(robot_.springs[spring]);
    const double share = count > 0 ? 1 / static_cast<double>(count) : 0;
    known.strain = strain * share;
    known.strain_rate = strain_rate * share;
  }
  return rate ? *known.strain_rate : *known.strain;
}

// The step puts masses below the ground back to exactly 0.
double SensedBody::touch(std::uint32_t place) const {
  if (!has_ground(environment_)) return 0;
  const auto on_ground = [&](std::size_t i) { return positions_[i].z <= 0 ? std::size_t{1} : std::size_t{0}; };
  std::size_t touching = 0;
  if (place == BrainPlan::none) {
    for (std::size_t i = 0; i < positions_.size(); ++i) touching += on_ground(i);
    return static_cast<double>(touching) / static_cast<double>(positions_.size());
  }
  for (const std::uint16_t i : masses(place)) touching += on_ground(i);
  return static_cast<double>(touching) / static_cast<double>(masses(place).size());
}

const Rotation& SensedBody::frame() {
  if (frame_) return *frame_;
  const Double3 rest = mean(robot_, robot_.masses, {}, true), now = center(BrainPlan::none);
  std::array<double, 9> s{};
  for (std::size_t i = 0; i < positions_.size(); ++i) {
    const Double3 X = scaled(mass_of_point(robot_, i), Double3(robot_.masses[i]) - rest);
    const Double3 x = Double3(positions_[i]) - now;
    const double products[] = {X.x * x.x, X.x * x.y, X.x * x.z, X.y * x.x, X.y * x.y,
                               X.y * x.z, X.z * x.x, X.z * x.y, X.z * x.z};
    for (std::size_t k = 0; k < 9; ++k) s[k] += products[k];
  }
  return frame_.emplace(rotation_of(s));
}

Double3 SensedBody::turn_rate() {
  if (turn_rate_) return *turn_rate_;
  const Double3 c = center(BrainPlan::none), v_c = velocity(BrainPlan::none);
  Double3 momentum;
  double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;
  for (std::size_t i = 0; i < positions_.size(); ++i) {
    const double m = mass_of_point(robot_, i);
    const Double3 d = Double3(positions_[i]) - c;
    momentum = momentum + scaled(m, cross(d, Double3(velocities_[i]) - v_c));
    xx += m * (d.y * d.y + d.z * d.z);
    yy += m * (d.x * d.x + d.z * d.z);
    zz += m * (d.x * d.x + d.y * d.y);
    xy -= m * d.x * d.y;
    xz -= m * d.x * d.z;
    yz -= m * d.y * d.z;
  }
  return turn_rate_.emplace(angular_velocity(momentum, xx, yy, zz, xy, xz, yz));
}

double SensedBody::measure(const BrainPlan::Sense& sense) {
  const auto in_body = [&](Double3 v) { return component_of(frame().to_body(v), sense.component); };
  switch (sense.kind) {
    case SensorKind::strain:
      return strain(sense.place, false);
    case SensorKind::strain_rate:
      return strain(sense.place, true);
    case SensorKind::touch:
      return touch(sense.place);
    case SensorKind::velocity:
      return in_body(velocity(sense.place));
    case SensorKind::turn_rate:
      return in_body(turn_rate());
    case SensorKind::up:
      return in_body({0, 0, 1});
    case SensorKind::depth:
      return -center(sense.place).z;
    case SensorKind::height:
      return center(sense.place).z;
    case SensorKind::target_direction: {
      const Double3 d = target_ - center(sense.place);
      const double distance = std::sqrt(dot(d, d));
      return distance > 0 ? in_body(scaled(1 / distance, d)) : 0;
    }
    case SensorKind::target_distance: {
      const Double3 d = target_ - center(sense.place);
      return std::sqrt(dot(d, d));
    }
    case SensorKind::light: {
      const Double3 d = Double3(environment_.light) - center(sense.place);
      return 1 / (1 + dot(d, d));
    }
    case SensorKind::flow:
      return in_body(Double3(flow_of(environment_)) - velocity(sense.place));
    default:
      return 0;  // the others do not depend on the body
  }
}

float clock_sense(const BrainPlan::Sense& sense, const Clock& clock) {
  const MusclePhase phase = muscle_phase({.frequency = sense.frequency, .phase = sense.phase}, clock);
  const std::uint64_t now = phase_at(phase, clock.step - clock.base_step);
  return sense.component == 0 ? sine_of_phase(now) : cosine_of_phase(now);
}

}  // namespace mercury
