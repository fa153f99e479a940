// SPDX-License-Identifier: Apache-2.0
#include "sim/senses.h"

#include <cstddef>

namespace mercury {
namespace {

class Measuring {
 public:
  Measuring(const Robot& robot, std::span<const Vec3> positions, std::span<const Vec3> velocities)
      : robot_(robot), positions_(positions), velocities_(velocities) {}

  PlaceMeasures place(const BrainPlan::Place& place, bool whole, bool ground) const {
    PlaceMeasures measured;
    if (place.measures & measure_center) measured.center = mean(positions_, place, whole);
    if (place.measures & measure_velocity) measured.velocity = mean(velocities_, place, whole);
    if (place.measures & (measure_strain | measure_strain_rate)) add_strain(place, whole, measured);
    if ((place.measures & measure_touch) && ground) {
      std::size_t touching = 0, masses = 0;
      for_each_mass(place, whole, [&](std::size_t i) {
        touching += on_ground(positions_[i].z) ? 1 : 0;
        ++masses;
      });
      measured.touch = static_cast<double>(touching) / static_cast<double>(masses);
    }
    return measured;
  }

  Rotation frame() const {
    const Double3 rest = mean(robot_.masses, {}, true), center = mean(positions_, {}, true);
    double s[9] = {};
    for (std::size_t i = 0; i < positions_.size(); ++i) {
      const Double3 X = mass(i) * (Double3(robot_.masses[i]) - rest), x = Double3(positions_[i]) - center;
      const double products[] = {X.x * x.x, X.x * x.y, X.x * x.z, X.y * x.x, X.y * x.y,
                                 X.y * x.z, X.z * x.x, X.z * x.y, X.z * x.z};
      for (std::size_t k = 0; k < 9; ++k) s[k] += products[k];
    }
    return rotation_of(s);
  }

  Double3 turn_rate(const PlaceMeasures& whole) const {
    Double3 momentum;
    Inertia j;
    for (std::size_t i = 0; i < positions_.size(); ++i) {
      const double m = mass(i);
      const Double3 d = Double3(positions_[i]) - whole.center;
      momentum = momentum + m * cross(d, Double3(velocities_[i]) - whole.velocity);
      j.xx += m * (d.y * d.y + d.z * d.z);
      j.yy += m * (d.x * d.x + d.z * d.z);
      j.zz += m * (d.x * d.x + d.y * d.y);
      j.xy -= m * d.x * d.y;
      j.xz -= m * d.x * d.z;
      j.yz -= m * d.y * d.z;
    }
    return angular_velocity(momentum, j);
  }

 private:
  double mass(std::size_t i) const { return static_cast<double>(mass_of(robot_, i)); }

  template <class Visit>
  void for_each_mass(const BrainPlan::Place& place, bool whole, const Visit& visit) const {
    if (whole)
      for (std::size_t i = 0; i < robot_.masses.size(); ++i) visit(i);
    else
      for (const std::uint16_t i : place.masses) visit(std::size_t{i});
  }

  Double3 mean(std::span<const Vec3> vectors, const BrainPlan::Place& place, bool whole) const {
    Double3 sum;
    double weight = 0;
    for_each_mass(place, whole, [&](std::size_t i) {
      sum = sum + mass(i) * Double3(vectors[i]);
      weight += mass(i);
    });
    return (1 / weight) * sum;
  }

  void add_strain(const BrainPlan::Place& place, bool whole, PlaceMeasures& measured) const {
    std::size_t count = 0;
    const auto add = [&](const Spring& spring) {
      const Double3 d = Double3(positions_[spring.b]) - Double3(positions_[spring.a]);
      const Double3 v = Double3(velocities_[spring.b]) - Double3(velocities_[spring.a]);
      const auto rest = static_cast<double>(spring.rest_length);
      measured.strain += strain_of(d, rest);
      measured.strain_rate += strain_rate_of(d, v, rest);
      ++count;
    };
    if (whole)
      for (const Spring& spring : robot_.springs) add(spring);
    else
      for (const std::uint32_t spring : place.springs) add(robot_.springs[spring]);
    const double share = count > 0 ? 1 / static_cast<double>(count) : 0;
    measured.strain *= share;
    measured.strain_rate *= share;
  }

  const Robot& robot_;
  const std::span<const Vec3> positions_, velocities_;
};

}  // namespace

SensedBody measure_body(const Robot& robot, const BrainPlan& plan, std::span<const Vec3> positions,
                        std::span<const Vec3> velocities, bool ground) {
  SensedBody measured;
  const Measuring measuring(robot, positions, velocities);
  for (std::size_t i = 0; i < plan.places.size(); ++i)
    measured.places.push_back(measuring.place(plan.places[i], i == 0, ground));
  if (plan.uses_frame) measured.body.frame = measuring.frame();
  if (plan.uses_turn_rate) measured.body.turn_rate = measuring.turn_rate(measured.places[0]);
  return measured;
}

Rotation body_frame(const Robot& robot, std::span<const Vec3> positions) {
  return Measuring(robot, positions, {}).frame();
}

}  // namespace mercury
