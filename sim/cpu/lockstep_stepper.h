// SPDX-License-Identifier: Apache-2.0
// The step of a group of robots in lockstep (lockstep.h), in vector code.
#pragma once

#include "sim/cpu/lockstep.h"
#include "sim/cpu/motion.h"
#include "sim/cpu/near_search.h"
#include "sim/cpu/skin.h"
#include "sim/cpu/spring_slots.h"

HWY_BEFORE_NAMESPACE();
namespace mercury::cpu::HWY_NAMESPACE {

template <class EnvironmentModel>
class LockstepStepper {
 public:
  LockstepStepper(Lockstep& group, const EnvironmentModel& model, const StepSetting& setting)
      : group_(group), x_(group.x.data()), v_(group.v.data()), sums_(group.sums.data()), joints_(group.joints),
        model_(model), constants_(setting.constants), contact_stiffness_(setting.contact.stiffness),
        force_scale_(load_aligned(group.force_scale.data())),
        correction_scale_(load_aligned(group.correction_scale.data())), per_force_(inverse(force_scale_)),
        per_correction_(inverse(correction_scale_)),
        squared_stretch_limit_(load_aligned(group.squared_stretch_limit.data())) {}

  // False if a robot may have exploded.
  bool step(Solver solver, const float* factors) {
    if (!group_.perturbations.empty()) add_perturbations(group_);
    if constexpr (EnvironmentModel::has_contacts)
      if (contact_stiffness_ != 0 && group_.contact_distance[0] != 0) touch();
    if constexpr (EnvironmentModel::has_faces)
      if (!add_faces()) return false;
    return solver == Solver::force ? step_force(factors) : step_xpbd(factors);
  }

 private:
  // Algorithm 1. A mass ends its step as soon as its own springs are done: those that it is partner in came before.
  bool step_force(const float* factors) {
    Box box;
    const bool is_compact = compact(load_aligned(group_.squared_diagonal.data()));
    const bool sound = add_springs(factors, is_compact, [&](std::size_t mass, Integers3 sum) HWY_ATTR {
      const Lanes3 x0 = of_mass(x_, mass), v0 = of_mass(v_, mass);
      Lanes3 v = accelerated_by(sum, per_force_, v0, model_, constants_), x = multiply_add(constants_.dt, v, x0);
      end_step(x, v, model_, constants_);
      keep(x, v, mass);
      box.add(x);
    });
    store_aligned(squared_diagonal(box), group_.squared_diagonal.data());
    return sound && within_reach(box);
  }

  // Algorithm 2.
  bool step_xpbd(const float* factors) {
    Box predicted;
    for (std::size_t mass = 0; mass < joints_.size(); ++mass) {
      const Lanes3 v = accelerated_by(take(mass), per_force_, of_mass(v_, mass), model_, constants_);
      const Lanes3 x = multiply_add(constants_.dt, v, of_mass(x_, mass));
      keep(x, v, mass);
      predicted.add(x);
    }
    if (!within_reach(predicted)) return false;
    Box box;
    const bool sound =
        add_springs(factors, compact(squared_diagonal(predicted)), [&](std::size_t mass, Integers3 sum) HWY_ATTR {
          const Lanes3 correction = per_correction_ * float_of(sum);
          Lanes3 x = of_mass(x_, mass) + correction;
          Lanes3 v = multiply_add(constants_.inverse_dt, correction, of_mass(v_, mass));
          end_step(x, v, model_, constants_);
          keep(x, v, mass);
          box.add(x);
        });
    store_aligned(squared_diagonal(box), group_.squared_diagonal.data());
    return sound && within_reach(box);
  }

  // Adds the forces of contacts, and sees to it that near pairs are listed.
  void touch() {
    const std::uint32_t lanes = group_.lists.empty() ? ~0u : bits_of(strayed());
    if (lanes != 0) list_near_pairs(group_, lanes, [](Body& body) { HWY_NAMESPACE::list_near_pairs(body); });
    add_contacts(group_, contact_stiffness_);
  }

  // Whether a mass of a lane's robot went farther than lists reach, seen from its first mass.
  Mask strayed() const {
    float* const listed = group_.listed_x.data();
    const Lanes reach = Lanes(list_reach) * load_aligned(group_.contact_distance.data());
    alignas(64) float now[3 * lane_count], then[3 * lane_count];
    for (std::size_t lane = 0; lane < lane_count; ++lane)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t first = group_.first_of(group_.seatings[lane]->seats[0], lane) + axis * lane_count;
        now[axis * lane_count + lane] = x_[first];
        then[axis * lane_count + lane] = listed[first];
      }
    const Lanes3 common = of_mass(now, 0) - of_mass(then, 0);
    Lanes farthest_squared = 0.0f;
    for (std::size_t mass = 0; mass < joints_.size(); ++mass) {
      const Lanes is_mass = load_aligned(group_.is_mass.data() + mass * lane_count);
      farthest_squared =
          larger(farthest_squared, is_mass * squared_length(of_mass(x_, mass) - of_mass(listed, mass) - common));
    }
    return farthest_squared > reach * reach;
  }

  // False if a face's force is out of range. That is looked for only where no bound excludes it.
  bool add_faces() {
    const Lanes fastest_squared = add_face_forces();
    const Lanes most =
        load_aligned(group_.most_force.data()) * load_aligned(group_.squared_diagonal.data()) * fastest_squared;
    return every(most < 0.5f * face_limit_units) || face_forces_fit();
  }
  // Returns the greatest square of the sum of a face's velocities.
  Lanes add_face_forces() {
    std::int32_t* const sums = sums_;
    Lanes fastest_squared = 0.0f;
    for_each_pair_of_faces([&](const auto& corners, const FaceForces& f) HWY_ATTR {
      fastest_squared = larger(fastest_squared, f.fastest_squared);
      const Integers3 on_b = round_to_int(f.first), on_d = round_to_int(f.second), on_both = on_b + on_d;
      add_to(sums, corners.a, on_both);
      add_to(sums, corners.b, on_b);
      add_to(sums, corners.c, on_both);
      add_to(sums, corners.d, on_d);
    });
    return fastest_squared;
  }
  HWY_NOINLINE bool face_forces_fit() const {
    Integers largest_force = no_integers();
    for_each_pair_of_faces([&](const auto&, const FaceForces& f)
                               HWY_ATTR { largest_force = larger(largest_force, f.largest_component()); });
    return largest(largest_force) < mercury::bits_of(face_limit_units);
  }
  // Calls visit(corners, FaceForces).
  template <class Visit>
  HWY_INLINE void for_each_pair_of_faces(const Visit& visit) const {
    const std::size_t whole = group_.faces.size() * lane_count;
    for_each_pair_of_faces(group_.faces, group_.face_drag.data(), group_.face_lift.data(), visit);
    for_each_pair_of_faces(group_.split_faces, group_.face_drag.data() + whole, group_.face_lift.data() + whole, visit);
  }
  template <class Corners, class Visit>
  HWY_INLINE void for_each_pair_of_faces(const std::vector<Corners>& slots, const float* drag, const float* lift,
                                         const Visit& visit) const {
    const float *const x = x_, *const v = v_;
    const Lanes3 thrice_flow{model_.thrice_flow.x, model_.thrice_flow.y, model_.thrice_flow.z};
    for (const Corners& corners : slots) {
      const auto& [a, b, c, d] = corners;
      const Lanes3 xa = at(x, a);
      Lanes3 common = at(v, a) + at(v, c);
      if constexpr (!EnvironmentModel::still_water) common = common - thrice_flow;
      visit(corners, face_forces<EnvironmentModel>(load_aligned(drag), load_aligned(lift), at(x, b) - xa, at(x, c) - xa,
                                                   at(x, d) - xa, common + at(v, b), common + at(v, d)));
      drag += lane_count;
      lift += lane_count;
    }
  }

  template <class Finish>
  bool add_springs(const float* factors, bool compact, const Finish& finish) {
    return compact ? add_springs<false>(factors, finish) : add_springs<true>(factors, finish);
  }

  // Calls finish(mass, sum of all that acts on it) for each mass. False if a spring is beyond the stretch limit, which
  // only `checked` finds.
  template <bool checked, class Finish>
  bool add_springs(const float* factors, const Finish& finish) {
    SlotLaw<checked> law{factors, group_.rest_length.data(), group_.hardness.data(), group_.factor.data(), 0.0f};
    const float* const x = x_;
    std::int32_t* const sums = sums_;
    const std::uint32_t* partner = group_.partners.data();
    std::size_t mass = 0;
    for (const auto& [owned, bias] : joints_) {
      const Lanes3 own = of_mass(x_, mass);
      const Integers none = every_one(bias);
      Integers3 sum{none, none, none};
      for (const std::uint32_t* const end = partner + owned; partner != end; ++partner) {
        const Integers3 f = law(own - at(x, *partner));
        sum = sum - f;
        add_to(sums, *partner, f);
      }
      finish(mass, take(mass) + sum);
      ++mass;
    }
    return !checked || every(law.longest <= squared_stretch_limit_);
  }

  // x, y and z of a seat start so far apart.
  template <class T>
  static HWY_INLINE Pointers3<T> lanes_of(T* first) {
    return {first, first + lane_count, first + 2 * lane_count};
  }
  // Of the seat whose values start there.
  static HWY_INLINE Lanes3 at(const float* values, std::uint32_t seat) {
    const float* const first = values + seat;
    return {load_aligned(first), load_aligned(first + lane_count), load_aligned(first + 2 * lane_count)};
  }
  static HWY_INLINE Lanes3 at(const float* values, Lockstep::Halves seats) {
    const float *const lower = values + seats.lower, *const upper = values + seats.upper;
    return {load_halves(lower, upper), load_halves(lower + lane_count, upper + lane_count),
            load_halves(lower + 2 * lane_count, upper + 2 * lane_count)};
  }
  static HWY_INLINE void add_to(std::int32_t* sums, std::uint32_t seat, Integers3 a) {
    const Pointers3<std::int32_t> sum = lanes_of(sums + seat);
    store_aligned(load_aligned(sum, 0) + a, sum, 0);
  }
  static HWY_INLINE void add_to(std::int32_t* sums, Lockstep::Halves seats, Integers3 a) {
    const Pointers3<std::int32_t> lower = lanes_of(sums + seats.lower), upper = lanes_of(sums + seats.upper);
    add_halves(a.x, lower.x, upper.x);
    add_halves(a.y, lower.y, upper.y);
    add_halves(a.z, lower.z, upper.z);
  }
  static HWY_INLINE Lanes3 of_mass(const float* values, std::size_t mass) {
    return at(values + 3 * lane_count * mass, 0u);
  }
  HWY_INLINE Integers3 take(std::size_t mass) const {
    const Pointers3<std::int32_t> from = lanes_of(sums_ + 3 * lane_count * mass);
    const Integers3 sum = load_aligned(from, 0);
    store_aligned(Integers3{no_integers(), no_integers(), no_integers()}, from, 0);
    return sum;
  }
  HWY_INLINE void keep(Lanes3 x, Lanes3 v, std::size_t mass) const {
    store_aligned(x, lanes_of(x_ + 3 * lane_count * mass), 0);
    store_aligned(v, lanes_of(v_ + 3 * lane_count * mass), 0);
  }
  static Lanes squared_diagonal(const Box& box) { return squared_length(box.high - box.low); }
  // Whether all masses in the box are. None is NaN: what acts on masses is made of integers, and a velocity that a
  // robot comes with is finite (ready()).
  static bool within_reach(const Box& box) {
    return every(mercury::within_reach(box.low) & mercury::within_reach(box.high));
  }
  // Whether no two masses of a robot are farther apart than its springs may be long.
  bool compact(Lanes squared_diagonal) const { return every(squared_diagonal <= squared_stretch_limit_); }

  Lockstep& group_;
  float *const x_, *const v_;
  std::int32_t* const sums_;
  const std::vector<Lockstep::Joint>& joints_;
  const EnvironmentModel model_;
  const StepConstants constants_;
  const float contact_stiffness_;
  const Lanes force_scale_, correction_scale_, per_force_, per_correction_, squared_stretch_limit_;
};

template <class EnvironmentModel>
bool advance_with(const EnvironmentModel& model, Lockstep& group, const StepSetting& setting, Factors factors,
                  std::int64_t steps) {
  LockstepStepper stepper(group, model, setting);
  for (std::int64_t n = 0; n < steps; ++n)
    if (!stepper.step(setting.solver, factors.of_step(n))) return false;
  return true;
}

// Kernel::advance_together.
inline bool advance_together(Lockstep& group, const StepSetting& setting, Factors factors, std::int64_t steps) {
  return with_model(setting, [&](const auto& model) { return advance_with(model, group, setting, factors, steps); });
}

}  // namespace mercury::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
