// SPDX-License-Identifier: Apache-2.0
// How the masses of a body move, block by block, once what acts on them is summed.
#pragma once

#include "sim/cpu/arrays.h"
#include "sim/cpu/step.h"

HWY_BEFORE_NAMESPACE();
namespace mercury::cpu::HWY_NAMESPACE {

// The smallest box around the masses.
struct Box {
  Lanes3 low, high;

  HWY_INLINE Box() : low{3e38f, 3e38f, 3e38f}, high{-3e38f, -3e38f, -3e38f} {}
  HWY_INLINE void add(Lanes3 x) {
    low = {smaller(low.x, x.x), smaller(low.y, x.y), smaller(low.z, x.z)};
    high = {larger(high.x, x.x), larger(high.y, x.y), larger(high.z, x.z)};
  }
  // Rounded like the length of any spring in it, so that no spring can come out longer.
  HWY_INLINE float squared_diagonal() const {
    return squared_length(
        Vec3{largest(high.x) - smallest(low.x), largest(high.y) - smallest(low.y), largest(high.z) - smallest(low.z)});
  }
};

// Notes a mass that left the finite. False for a stand-in.
inline bool note_bad(Body& body, std::size_t place) {
  const std::uint32_t mass = body.places.mass_at[place];
  body.status.bad_mass = std::min(body.status.bad_mass, mass);
  return mass != no_mass;
}

// The velocity before damping, from a sum in units of which a newton has 1 / `per_unit`. That is a power of two, so
// that it does not matter when it is multiplied by.
template <class EnvironmentModel>
HWY_INLINE Lanes3 accelerated_by(Integers3 sum, Lanes per_unit, Lanes3 v, const EnvironmentModel& model,
                                 const StepConstants& constants) {
  if constexpr (EnvironmentModel::still_water) return multiply_add(constants.dt * per_unit, float_of(sum), v);
  return accelerated(v, per_unit * float_of(sum) + model.on_mass(v), constants);
}
// Calls with the environment model, StillWaterOceanModel if it fits.
template <class Call>
HWY_INLINE auto with_model(const StepSetting& setting, const Call& call) {
  constexpr float least_dt = 1e-6f;  // [s]; with much smaller ones a product of it with a unit would not be exact
  const auto* const ocean = std::get_if<OceanModel>(&setting.model);
  if (ocean != nullptr && StillWaterOceanModel::fits(*ocean) && setting.constants.dt >= least_dt)
    return call(StillWaterOceanModel{*ocean});
  return std::visit(call, setting.model);
}

// One phase of a step. Masses that are collected one by one, for faces or springs in rows, are kept in rows as well.
template <class EnvironmentModel, bool spring_rows>
class Motion {
 public:
  static constexpr bool needs_rows = EnvironmentModel::has_faces || spring_rows;

  // `scale`: units in a newton or, for corrections, in a metre.
  HWY_INLINE Motion(Body& body, const EnvironmentModel& model, const StepConstants& constants, float scale)
      : body_(body), arrays_(body), model_(model), constants_(constants), inverse_scale_(1 / scale), box_() {}

  // Algorithm 1: the end of the step.
  HWY_INLINE void end_with_forces(std::size_t place) {
    const Lanes3 x0 = load_aligned(arrays_.x, place), v0 = load_aligned(arrays_.v, place);
    Lanes3 v = accelerated_by(take<true>(place), inverse_scale_, v0, model_, constants_);
    Lanes3 x = multiply_add(constants_.dt, v, x0);
    end_step(x, v, model_, constants_);
    keep(x, v, x0, v0, place);
    box_.add(x);
    store_rows_of(x, v, place);
  }

  // Algorithm 2: leaves the prediction in place of the position and v + dt F in place of the velocity.
  HWY_INLINE void predict(std::size_t place) {
    const Lanes3 x0 = load_aligned(arrays_.x, place), v0 = load_aligned(arrays_.v, place);
    Lanes3 v = accelerated_by(take<false>(place), inverse_scale_, v0, model_, constants_);
    Lanes3 x = multiply_add(constants_.dt, v, x0);
    keep(x, v, x0, v0, place);
    box_.add(x);
    if constexpr (spring_rows) arrays_.store_x_rows(x, place);
  }
  // The end of the step after a prediction.
  HWY_INLINE void end_with_corrections(std::size_t place) {
    const Lanes3 x0 = load_aligned(arrays_.x, place), v0 = load_aligned(arrays_.v, place);
    const Lanes3 correction = Lanes(inverse_scale_) * float_of(take<true>(place));
    Lanes3 x = x0 + correction;
    Lanes3 v = multiply_add(constants_.inverse_dt, correction, v0);
    end_step(x, v, model_, constants_);
    keep(x, v, x0, v0, place);
    box_.add(x);
    store_rows_of(x, v, place);
  }

  // Whether all masses stayed within reach; the box around them.
  bool finite() const { return finite_; }
  HWY_INLINE float squared_diagonal() const { return box_.squared_diagonal(); }

 private:
  template <bool springs>
  HWY_INLINE Integers3 take(std::size_t place) const {
    return arrays_.template take<springs, needs_rows>(place);
  }

  // Stores the new state of those masses that are within reach. The others stay, and the robot has exploded.
  HWY_INLINE void keep(Lanes3& x, Lanes3& v, Lanes3 x0, Lanes3 v0, std::size_t place) {
    const Mask good = within_reach(x);
    if (HWY_UNLIKELY(!every(good))) {
      x = select(good, x, x0);
      v = select(good, v, v0);
      const std::uint32_t lanes = bits_of(good);
      for (std::size_t lane = 0; lane < lane_count; ++lane)
        if ((lanes >> lane & 1) == 0 && note_bad(body_, place + lane)) finite_ = false;
    }
    store_aligned(x, arrays_.x, place);
    store_aligned(v, arrays_.v, place);
  }

  HWY_INLINE void store_rows_of(Lanes3 x, Lanes3 v, std::size_t place) const {
    if constexpr (needs_rows) arrays_.store_x_rows(x, place);
    if constexpr (EnvironmentModel::has_faces) arrays_.store_v_rows(v, place);
  }

  Body& body_;
  const Arrays arrays_;
  const EnvironmentModel model_;
  const StepConstants constants_;
  const float inverse_scale_;
  Box box_;
  bool finite_ = true;
};

}  // namespace mercury::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
