// SPDX-License-Identifier: Apache-2.0
// How masses move once the sums of what acts on them are complete.
#pragma once

#include "sim/cpu/kernels/body_arrays.h"
#include "sim/cpu/layout/step_setting.h"

HWY_BEFORE_NAMESPACE();
namespace mercury::cpu::HWY_NAMESPACE {

// The smallest box around the masses that were added.
struct Box {
  Lanes3 low, high;

  HWY_INLINE Box() : low{3e38f, 3e38f, 3e38f}, high{-3e38f, -3e38f, -3e38f} {}
  HWY_INLINE void add(Lanes3 x) {
    low = {smaller(low.x, x.x), smaller(low.y, x.y), smaller(low.z, x.z)};
    high = {larger(high.x, x.x), larger(high.y, x.y), larger(high.z, x.z)};
  }
  // Of all lanes together. Rounded like the length of a spring, so that no spring in the box can come out longer.
  HWY_INLINE float squared_diagonal() const {
    return squared_length(
        Vec3{largest(high.x) - smallest(low.x), largest(high.y) - smallest(low.y), largest(high.z) - smallest(low.z)});
  }
};

// Notes a mass that left the finite. Returns false if the slot is padding.
inline bool note_bad_mass(Body& body, std::size_t slot) {
  const std::uint32_t mass = body.slots.mass_at[slot];
  body.status.bad_mass = std::min(body.status.bad_mass, mass);
  return mass != no_mass;
}

// PointProperties of a tile, or of the same mass of each member of a group.
struct PointLanes {
  Lanes inverse_inertia, weight;
};

// The velocity before damping. `sum` counts units of `per_unit` newtons, a power of two: multiplying by it is exact, so
// it does not matter when that happens.
template <class EnvironmentModel>
HWY_INLINE Lanes3 accelerated_by(Integers3 sum, Lanes per_unit, Lanes3 v, PointLanes point,
                                 const EnvironmentModel& model, const StepConstants& constants) {
  if constexpr (EnvironmentModel::still_water) return multiply_add(constants.dt * per_unit, float_of(sum), v);
  if constexpr (EnvironmentModel::real_bodies)
    return accelerated(v, point.inverse_inertia * (per_unit * float_of(sum) + model.on_mass(v, point.weight)),
                       constants);
  else
    return accelerated(v, per_unit * float_of(sum) + model.on_mass(v), constants);
}

// The same with springs alone, after the forces of the environment.
HWY_INLINE Lanes3 accelerated_by_springs(Integers3 sum, Lanes per_unit, Lanes3 v, PointLanes point,
                                         const StepConstants& constants) {
  return accelerated(v, point.inverse_inertia * (per_unit * float_of(sum)), constants);
}

// XPBD's correction of a mass [m]; `sum` counts units of `per_unit` kg m.
template <class EnvironmentModel>
HWY_INLINE Lanes3 correction_by(Integers3 sum, Lanes per_unit, PointLanes point) {
  const Lanes3 correction = per_unit * float_of(sum);
  if constexpr (EnvironmentModel::real_bodies) return point.inverse_inertia * correction;
  return correction;
}

// Ground and damping at the end of a step.
template <class EnvironmentModel>
HWY_INLINE void end_step_of(Lanes3& x, Lanes3& v, PointLanes point, const EnvironmentModel& model,
                            const StepConstants& constants) {
  if constexpr (EnvironmentModel::real_bodies)
    end_step(x, v, point.inverse_inertia, model, constants);
  else
    end_step(x, v, model, constants);
}

// One phase of a body's step, tile by tile.
template <class EnvironmentModel, bool gathered_springs>
class Motion {
 public:
  static constexpr bool needs_aos = EnvironmentModel::has_faces || gathered_springs;

  // `scale`: units per newton, or per meter for corrections.
  HWY_INLINE Motion(Body& body, const EnvironmentModel& model, const StepConstants& constants, float scale)
      : body_(body), arrays_(body), model_(model), constants_(constants), inverse_scale_(1 / scale), box_() {}

  // Algorithm 1: the end of the step.
  HWY_INLINE void end_with_forces(std::size_t slot) {
    const Lanes3 x0 = load_aligned(arrays_.x, slot), v0 = load_aligned(arrays_.v, slot);
    const PointLanes point = point_at(slot);
    Lanes3 v;
    if constexpr (EnvironmentModel::real_bodies) {
      const Integers3 sum = take<true>(slot);
      v = model_.sums_apart() ? accelerated_by_springs(sum, inverse_scale_, v0, point, constants_)
                              : accelerated_by(sum, inverse_scale_, v0, point, model_, constants_);
    } else {
      v = accelerated_by(take<true>(slot), inverse_scale_, v0, point, model_, constants_);
    }
    Lanes3 x = multiply_add(constants_.dt, v, x0);
    end_step_of(x, v, point, model_, constants_);
    store_state(x, v, x0, v0, slot);
    box_.add(x);
    store_aos_of(x, v, slot);
  }

  // Algorithm 1: adds the forces of the environment to the velocity, where they are summed apart.
  HWY_INLINE void accelerate(std::size_t slot) {
    const Lanes3 v = accelerated_by(take<false>(slot), inverse_scale_, load_aligned(arrays_.v, slot), point_at(slot),
                                    model_, constants_);
    store_aligned(v, arrays_.v, slot);
    if constexpr (gathered_springs) arrays_.store_v_aos(v, slot);
  }

  // Algorithm 2: replaces the position by the prediction and the velocity by v + dt F.
  HWY_INLINE void predict(std::size_t slot) {
    const Lanes3 x0 = load_aligned(arrays_.x, slot), v0 = load_aligned(arrays_.v, slot);
    Lanes3 v = accelerated_by(take<false>(slot), inverse_scale_, v0, point_at(slot), model_, constants_);
    Lanes3 x = multiply_add(constants_.dt, v, x0);
    store_state(x, v, x0, v0, slot);
    box_.add(x);
    if constexpr (gathered_springs) arrays_.store_x_aos(x, slot);
    if constexpr (gathered_springs && EnvironmentModel::real_bodies) arrays_.store_v_aos(v, slot);
  }
  // Algorithm 2: the end of the step, after a prediction.
  HWY_INLINE void end_with_corrections(std::size_t slot) {
    const Lanes3 x0 = load_aligned(arrays_.x, slot), v0 = load_aligned(arrays_.v, slot);
    const PointLanes point = point_at(slot);
    const Lanes3 correction = correction_by<EnvironmentModel>(take<true>(slot), inverse_scale_, point);
    Lanes3 x = x0 + correction;
    Lanes3 v = multiply_add(constants_.inverse_dt, correction, v0);
    end_step_of(x, v, point, model_, constants_);
    store_state(x, v, x0, v0, slot);
    box_.add(x);
    store_aos_of(x, v, slot);
  }

  // Of all masses moved so far: whether they are within reach, and the box around them.
  bool is_finite() const { return is_finite_; }
  HWY_INLINE float squared_diagonal() const { return box_.squared_diagonal(); }

 private:
  HWY_INLINE PointLanes point_at(std::size_t slot) const {
    if constexpr (EnvironmentModel::real_bodies)
      return {load_aligned(arrays_.inverse_inertia + slot), load_aligned(arrays_.weight + slot)};
    else
      return {1.0f, 1.0f};
  }
  template <bool springs>
  HWY_INLINE Integers3 take(std::size_t slot) const {
    return arrays_.template take<springs, needs_aos>(slot);
  }

  // Stores the new state of masses that are within reach. The others keep the old one, and the robot has exploded.
  HWY_INLINE void store_state(Lanes3& x, Lanes3& v, Lanes3 x0, Lanes3 v0, std::size_t slot) {
    const Mask good = within_reach(x);
    if (HWY_UNLIKELY(!every(good))) {
      x = select(good, x, x0);
      v = select(good, v, v0);
      const std::uint32_t lanes = bits_of(good);
      for (std::size_t lane = 0; lane < lane_count; ++lane)
        if ((lanes >> lane & 1) == 0 && note_bad_mass(body_, slot + lane)) is_finite_ = false;
    }
    store_aligned(x, arrays_.x, slot);
    store_aligned(v, arrays_.v, slot);
  }

  HWY_INLINE void store_aos_of(Lanes3 x, Lanes3 v, std::size_t slot) const {
    if constexpr (needs_aos) arrays_.store_x_aos(x, slot);
    if constexpr (EnvironmentModel::has_faces) arrays_.store_v_aos(v, slot);
  }

  Body& body_;
  const BodyArrays arrays_;
  const EnvironmentModel model_;
  const StepConstants constants_;
  const float inverse_scale_;
  Box box_;
  bool is_finite_ = true;
};

}  // namespace mercury::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
