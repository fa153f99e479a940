// SPDX-License-Identifier: Apache-2.0
// The step of a lockstep group (layout/lockstep_group.h), for each pair of solver and environment.
#pragma once

#include "sim/cpu/kernels/face_tiles.h"
#include "sim/cpu/kernels/motion.h"
#include "sim/cpu/kernels/near_search.h"
#include "sim/cpu/kernels/spring_rows.h"
#include "sim/cpu/layout/lockstep_group.h"

HWY_BEFORE_NAMESPACE();
namespace mercury::cpu::HWY_NAMESPACE {

// x, y and z of a slot in a group's arrays.
template <class T>
HWY_INLINE Pointers3<T> slot_at(T* values, std::size_t offset) {
  T* const first = values + offset;
  return {first, first + lane_count, first + 2 * lane_count};
}
HWY_INLINE Lanes3 load_slot(const float* values, std::size_t offset) {
  const float* const first = values + offset;
  return {load_aligned(first), load_aligned(first + lane_count), load_aligned(first + 2 * lane_count)};
}
HWY_INLINE Lanes3 load_slot(const float* values, LockstepGroup::Halves offsets) {
  const float *const lower = values + offsets.lower, *const upper = values + offsets.upper;
  return {load_halves(lower, upper), load_halves(lower + lane_count, upper + lane_count),
          load_halves(lower + 2 * lane_count, upper + 2 * lane_count)};
}
// Each lane its own slot, whose x is at the offset.
HWY_INLINE Lanes3 load_slots(const float* values, const std::uint32_t* offsets) {
  return {load_each(values, offsets), load_each(values + lane_count, offsets),
          load_each(values + 2 * lane_count, offsets)};
}
HWY_INLINE void add_to_slot(std::int32_t* sums, std::size_t offset, Integers3 a) {
  const Pointers3<std::int32_t> sum = slot_at(sums, offset);
  store_aligned(load_aligned(sum, 0) + a, sum, 0);
}
HWY_INLINE void add_to_slot(std::int32_t* sums, LockstepGroup::Halves offsets, Integers3 a) {
  const Pointers3<std::int32_t> lower = slot_at(sums, offsets.lower), upper = slot_at(sums, offsets.upper);
  add_halves(a.x, lower.x, upper.x);
  add_halves(a.y, lower.y, upper.y);
  add_halves(a.z, lower.z, upper.z);
}

template <class EnvironmentModel>
class LockstepStepper {
 public:
  LockstepStepper(LockstepGroup& group, const EnvironmentModel& model, const StepSetting& setting)
      : group_(group), x_(group.x.data()), v_(group.v.data()), sums_(group.sums.data()), slots_(group.slots),
        model_(model), constants_(setting.constants), force_scale_(load_aligned(group.force_scale.data())),
        correction_scale_(load_aligned(group.correction_scale.data())), per_force_(inverse(force_scale_)),
        per_environment_(inverse(load_aligned(group.environment_scale.data()))),
        per_correction_(inverse(correction_scale_)),
        squared_stretch_limit_(load_aligned(group.squared_stretch_limit.data())) {}

  // Returns false if a member may have exploded.
  bool step(Solver solver, StepFactors factors, std::int64_t number) {
    dither_ = dither_of_step(number);
    if (!group_.perturbations.empty()) add_perturbations(group_);
    if constexpr (EnvironmentModel::has_contacts)
      if (group_.bodies.front()->contact_stiffness != 0 && group_.contact_distance[0] != 0) add_contact_forces();
    if constexpr (EnvironmentModel::has_faces)
      if (model_.acts_on_faces() && !add_faces()) return false;
    return solver == Solver::force ? step_force(factors) : step_xpbd(factors);
  }

 private:
  // Algorithm 1.
  bool step_force(StepFactors factors) {
    const bool apart = accelerate_by_environment();
    Box box;
    const bool compact = is_compact(load_aligned(group_.squared_diagonal.data()));
    const bool within_limit = add_springs(factors, compact, [&](std::size_t slot, Integers3 sum) HWY_ATTR {
      const Lanes3 x0 = load_nth_slot(x_, slot), v0 = load_nth_slot(v_, slot);
      const PointLanes point = point_at(slot);
      Lanes3 v;
      if constexpr (EnvironmentModel::real_bodies)
        v = apart ? accelerated_by_springs(sum, per_force_, v0, point, constants_)
                  : accelerated_by(sum, per_force_, v0, point, model_, constants_);
      else
        v = accelerated_by(sum, per_force_, v0, point, model_, constants_);
      Lanes3 x = multiply_add(constants_.dt, v, x0);
      end_step_of(x, v, point, model_, constants_);
      store_state(x, v, slot);
      box.add(x);
    });
    store_aligned(squared_diagonal(box), group_.squared_diagonal.data());
    return within_limit && is_within_reach(box);
  }

  // Algorithm 1, where the forces of the environment are summed apart. Returns whether they are.
  bool accelerate_by_environment() {
    if constexpr (!EnvironmentModel::real_bodies) return false;
    if (!model_.sums_apart()) return false;
    for (std::size_t slot = 0; slot < slots_.size(); ++slot) {
      const Lanes3 v =
          accelerated_by(take(slot), per_environment_, load_nth_slot(v_, slot), point_at(slot), model_, constants_);
      store_aligned(v, slot_at(v_, 3 * lane_count * slot), 0);
    }
    return true;
  }

  // Algorithm 2.
  bool step_xpbd(StepFactors factors) {
    Box predicted;
    for (std::size_t slot = 0; slot < slots_.size(); ++slot) {
      const Lanes3 v =
          accelerated_by(take(slot), per_environment_, load_nth_slot(v_, slot), point_at(slot), model_, constants_);
      const Lanes3 x = multiply_add(constants_.dt, v, load_nth_slot(x_, slot));
      store_state(x, v, slot);
      predicted.add(x);
    }
    if (!is_within_reach(predicted)) return false;
    Box box;
    const bool compact = is_compact(squared_diagonal(predicted));
    const bool within_limit = add_springs(factors, compact, [&](std::size_t slot, Integers3 sum) HWY_ATTR {
      const PointLanes point = point_at(slot);
      const Lanes3 correction = correction_by<EnvironmentModel>(sum, per_correction_, point);
      Lanes3 x = load_nth_slot(x_, slot) + correction;
      Lanes3 v = multiply_add(constants_.inverse_dt, correction, load_nth_slot(v_, slot));
      end_step_of(x, v, point, model_, constants_);
      store_state(x, v, slot);
      box.add(x);
    });
    store_aligned(squared_diagonal(box), group_.squared_diagonal.data());
    return within_limit && is_within_reach(box);
  }

  void add_contact_forces() {
    const std::uint32_t lanes = group_.searches.empty() ? ~0u : bits_of(moved_beyond_reach());
    if (lanes != 0) search_near_pairs(group_, lanes, [](Body& body) { HWY_NAMESPACE::search_near_pairs(body); });
    add_contacts(group_);
  }

  // By lane: whether a mass has moved farther than lists reach, relative to the first mass, since near pairs were
  // searched.
  Mask moved_beyond_reach() const {
    float* const searched = group_.searched_x.data();
    const Lanes reach = Lanes(list_reach) * load_aligned(group_.contact_distance.data());
    alignas(64) float now[3 * lane_count], then[3 * lane_count];
    for (std::size_t lane = 0; lane < lane_count; ++lane)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t first = group_.offset_of(group_.index_maps[lane]->slots[0], lane) + axis * lane_count;
        now[axis * lane_count + lane] = x_[first];
        then[axis * lane_count + lane] = searched[first];
      }
    const Lanes3 first_moved = load_slot(now, 0) - load_slot(then, 0);
    Lanes farthest_squared = 0.0f;
    for (std::size_t slot = 0; slot < slots_.size(); ++slot) {
      const Lanes is_mass = load_aligned(group_.is_mass.data() + slot * lane_count);
      const Lanes3 moved = load_nth_slot(x_, slot) - load_nth_slot(searched, slot) - first_moved;
      farthest_squared = larger(farthest_squared, is_mass * squared_length(moved));
    }
    return farthest_squared > reach * reach;
  }

  // Returns false if a face's force is out of range. As in FaceTiles::add_forces(), a bound comes first.
  bool add_faces() {
    const Lanes fastest_squared = add_face_forces();
    const Lanes bound =
        load_aligned(group_.face_force_bound.data()) * load_aligned(group_.squared_diagonal.data()) * fastest_squared;
    return every(bound < 0.5f * face_limit_units) || face_forces_fit();
  }
  // Returns FaceForces::fastest_squared of all faces.
  Lanes add_face_forces() {
    std::int32_t* const sums = sums_;
    Lanes fastest_squared = 0.0f;
    for_each_face_tile([&](const auto& corners, const FaceForces& f) HWY_ATTR {
      fastest_squared = larger(fastest_squared, f.fastest_squared);
      const Integers3 on_b = round_to_int(f.first), on_d = round_to_int(f.second), on_both = on_b + on_d;
      add_to_slot(sums, corners.a, on_both);
      add_to_slot(sums, corners.b, on_b);
      add_to_slot(sums, corners.c, on_both);
      add_to_slot(sums, corners.d, on_d);
    });
    return fastest_squared;
  }
  HWY_NOINLINE bool face_forces_fit() const {
    Integers largest_force = zeros();
    for_each_face_tile([&](const auto&, const FaceForces& f)
                           HWY_ATTR { largest_force = larger(largest_force, f.largest_component()); });
    return largest(largest_force) < mercury::bits_of(face_limit_units);
  }
  // Calls visit(corners, FaceForces) for all face tiles, the split ones last.
  template <class Visit>
  HWY_INLINE void for_each_face_tile(const Visit& visit) const {
    const std::size_t whole = group_.face_tiles.size() * lane_count;
    for_each_face_tile(group_.face_tiles, 0, visit);
    for_each_face_tile(group_.split_face_tiles, whole, visit);
  }
  template <class Corners, class Visit>
  HWY_INLINE void for_each_face_tile(const std::vector<Corners>& tiles, std::size_t first_coefficient,
                                     const Visit& visit) const {
    const float *const x = x_, *const v = v_;
    const float *drag = group_.face_drag.data() + first_coefficient,
                *lift = group_.face_lift.data() + first_coefficient,
                *tangential = group_.face_tangential.data() + first_coefficient,
                *normal = group_.face_normal.data() + first_coefficient;
    const std::uint32_t* dither = group_.face_dither.data() + first_coefficient;
    const Lanes3 thrice_flow{model_.thrice_flow.x, model_.thrice_flow.y, model_.thrice_flow.z};
    for (const Corners& corners : tiles) {
      const auto& [a, b, c, d] = corners;
      const Lanes3 xa = load_slot(x, a);
      Lanes3 common = load_slot(v, a) + load_slot(v, c);
      if constexpr (!EnvironmentModel::still_water) common = common - thrice_flow;
      FaceCoefficients<Lanes> coefficients{load_aligned(drag), load_aligned(lift), 0.0f, 0.0f};
      if constexpr (EnvironmentModel::has_tangential_drag) coefficients.tangential = load_aligned(tangential);
      if constexpr (EnvironmentModel::real_bodies) coefficients.normal = load_aligned(normal);
      FaceForces forces =
          face_forces(model_, coefficients, load_slot(x, b) - xa, load_slot(x, c) - xa, load_slot(x, d) - xa,
                      common + load_slot(v, b), common + load_slot(v, d), [&](std::size_t face) HWY_ATTR {
                        const std::uint32_t* const behind =
                            group_.face_backs.data() + 2 * (dither - group_.face_dither.data()) + face * lane_count;
                        return Back{load_slots(x, behind) - xa, load_slots(v, behind)};
                      });
      if constexpr (EnvironmentModel::real_bodies)
        forces = forces.dithered(load_aligned(dither) + Words(dither_), model_.dither());
      visit(corners, forces);
      drag += lane_count;
      lift += lane_count;
      tangential += lane_count;
      normal += lane_count;
      dither += lane_count;
    }
  }

  template <class Finish>
  bool add_springs(StepFactors factors, bool compact, const Finish& finish) {
    if constexpr (EnvironmentModel::real_bodies)
      if (group_.viscous) return add_springs<true>(factors, compact, finish);
    return add_springs<false>(factors, compact, finish);
  }
  template <bool viscous, class Finish>
  bool add_springs(StepFactors factors, bool compact, const Finish& finish) {
    if (compact) return add_springs<false, viscous>(factors, finish);
    return add_springs<true, viscous>(factors, finish);
  }

  // Calls finish(slot, sum of all that acts on it) for each slot. If `checked`, returns false if a spring is beyond the
  // stretch limit.
  template <bool checked, bool viscous, class Finish>
  bool add_springs(StepFactors factors, const Finish& finish) {
    SpringRow<checked, viscous> next_row{FactorTable(factors),
                                         group_.rest_length.data(),
                                         group_.stiffness.data(),
                                         group_.relaxation_time.data(),
                                         group_.factor.data(),
                                         load_aligned(group_.highest_length_rate.data()),
                                         0.0f};
    const float *const x = x_, *const v = v_;
    std::int32_t* const sums = sums_;
    const std::uint32_t* partner = group_.partners.data();
    std::size_t slot = 0;
    for (const auto& [owned, bias] : slots_) {
      const Lanes3 own = load_nth_slot(x_, slot);
      Lanes3 velocity = own;
      if constexpr (viscous) velocity = load_nth_slot(v_, slot);
      const Integers start = broadcast(bias);
      Integers3 sum{start, start, start};
      for (const std::uint32_t* const end = partner + owned; partner != end; ++partner) {
        const Integers3 f =
            next_row(own - load_slot(x, *partner), [&]() HWY_ATTR { return velocity - load_slot(v, *partner); });
        sum = sum - f;
        add_to_slot(sums, *partner, f);
      }
      finish(slot, take(slot) + sum);
      ++slot;
    }
    return !checked || every(next_row.longest_squared <= squared_stretch_limit_);
  }

  static HWY_INLINE Lanes3 load_nth_slot(const float* values, std::size_t slot) {
    return load_slot(values, 3 * lane_count * slot);
  }
  HWY_INLINE PointLanes point_at(std::size_t slot) const {
    if constexpr (EnvironmentModel::real_bodies)
      return {load_aligned(group_.inverse_inertia.data() + slot * lane_count),
              load_aligned(group_.weight.data() + slot * lane_count)};
    else
      return {1.0f, 1.0f};
  }
  // Returns a slot's sum and sets it to zero.
  HWY_INLINE Integers3 take(std::size_t slot) const {
    const Pointers3<std::int32_t> from = slot_at(sums_, 3 * lane_count * slot);
    const Integers3 sum = load_aligned(from, 0);
    store_aligned(Integers3{zeros(), zeros(), zeros()}, from, 0);
    return sum;
  }
  HWY_INLINE void store_state(Lanes3 x, Lanes3 v, std::size_t slot) const {
    store_aligned(x, slot_at(x_, 3 * lane_count * slot), 0);
    store_aligned(v, slot_at(v_, 3 * lane_count * slot), 0);
  }
  static Lanes squared_diagonal(const Box& box) { return squared_length(box.high - box.low); }
  // Whether all masses in the box are within reach. None of them is NaN: forces are sums of integers, and a group takes
  // only robots of finite velocity (could_overflow()).
  static bool is_within_reach(const Box& box) { return every(within_reach(box.low) & within_reach(box.high)); }
  // Whether no two masses of a robot are farther apart than its springs may be long. Springs then need no check.
  bool is_compact(Lanes squared_diagonal) const { return every(squared_diagonal <= squared_stretch_limit_); }

  LockstepGroup& group_;
  float *const x_, *const v_;
  std::int32_t* const sums_;
  const std::vector<LockstepGroup::Slot>& slots_;
  const EnvironmentModel model_;
  const StepConstants constants_;
  std::uint32_t dither_ = 0;
  const Lanes force_scale_, correction_scale_, per_force_, per_environment_, per_correction_, squared_stretch_limit_;
};

template <class EnvironmentModel>
bool advance_with(const EnvironmentModel& model, LockstepGroup& group, const StepSetting& setting, Factors factors,
                  StepRange steps) {
  LockstepStepper stepper(group, model, setting);
  for (std::int64_t n = 0; n < steps.count; ++n)
    if (!stepper.step(setting.solver, factors.of_step(n), steps.first + n)) return false;
  return true;
}

// Kernel::advance_group.
inline bool advance_group(LockstepGroup& group, const StepSetting& setting, Factors factors, StepRange steps) {
  return std::visit([&](const auto& model) { return advance_with(model, group, setting, factors, steps); },
                    setting.model);
}

}  // namespace mercury::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
