// SPDX-License-Identifier: Apache-2.0
// The step of one robot alone, for each pair of solver and environment.
#pragma once

#include "sim/cpu/kernels/face_tiles.h"
#include "sim/cpu/kernels/motion.h"
#include "sim/cpu/kernels/near_search.h"
#include "sim/cpu/kernels/spring_rows.h"
#include "sim/cpu/layout/scalar_forces.h"

HWY_BEFORE_NAMESPACE();
namespace mercury::cpu::HWY_NAMESPACE {

template <class EnvironmentModel, bool gathered_springs>
class BodyStepper {
 public:
  BodyStepper(Body& body, const EnvironmentModel& model, const StepSetting& setting)
      : body_(body), model_(model), constants_(setting.constants) {
    if (needs_aos != body.sums.with_scattered) {
      clear(body.sums);
      body.sums.with_scattered = needs_aos;
    }
    if (needs_aos && !body.aos_is_current) {
      const BodyArrays arrays(body);
      for (std::size_t slot = 0; slot < arrays.slots; slot += lane_count) {
        arrays.store_x_aos(load_aligned(arrays.x, slot), slot);
        arrays.store_v_aos(load_aligned(arrays.v, slot), slot);
      }
    }
    body.aos_is_current = EnvironmentModel::has_faces;
  }

  // Returns false if the robot has exploded.
  bool step(Solver solver, StepFactors factors, std::int64_t number) {
    dither_ = dither_of_step(number);
    return solver == Solver::force ? step_force(factors) : step_xpbd(factors);
  }

 private:
  using BodyMotion = Motion<EnvironmentModel, gathered_springs>;
  static constexpr bool needs_aos = BodyMotion::needs_aos;

  // Algorithm 1.
  bool step_force(StepFactors factors) {
    if (!add_environment()) return false;
    if constexpr (EnvironmentModel::real_bodies)
      if (model_.sums_apart()) {
        BodyMotion motion(body_, model_, constants_, body_.scale.environment);
        for (std::size_t slot = 0; slot < body_.slots.mass_at.size(); slot += lane_count) motion.accelerate(slot);
      }
    BodyMotion end(body_, model_, constants_, body_.scale.force);
    if (!add_springs(factors, body_.squared_diagonal, [&](std::size_t slot) HWY_ATTR { end.end_with_forces(slot); }))
      return false;
    reset_padding();
    body_.squared_diagonal = end.squared_diagonal();
    return end.is_finite();
  }

  // Algorithm 2.
  bool step_xpbd(StepFactors factors) {
    if (!add_environment()) return false;
    BodyMotion prediction(body_, model_, constants_, body_.scale.environment);
    for (std::size_t slot = 0; slot < body_.slots.mass_at.size(); slot += lane_count) prediction.predict(slot);
    if (!prediction.is_finite()) return false;
    BodyMotion end(body_, model_, constants_, body_.scale.correction);
    if (!add_springs(factors, prediction.squared_diagonal(),
                     [&](std::size_t slot) HWY_ATTR { end.end_with_corrections(slot); }))
      return false;
    reset_padding();
    body_.squared_diagonal = end.squared_diagonal();
    return end.is_finite();
  }

  // No spring is longer than the diagonal of the box around all masses: springs need no check if that is short enough.
  template <class Finish>
  bool add_springs(StepFactors factors, float squared_diagonal, const Finish& finish) {
    if constexpr (EnvironmentModel::real_bodies)
      if (body_.viscous) return add_springs<true>(factors, squared_diagonal, finish);
    return add_springs<false>(factors, squared_diagonal, finish);
  }
  template <bool viscous, class Finish>
  bool add_springs(StepFactors factors, float squared_diagonal, const Finish& finish) {
    if (squared_diagonal <= body_.measures.squared_stretch_limit())
      return HWY_NAMESPACE::add_springs<false, gathered_springs, viscous>(body_, factors, finish);
    return HWY_NAMESPACE::add_springs<true, gathered_springs, viscous>(body_, factors, finish);
  }

  // Adds all forces but those of springs and those on single masses.
  bool add_environment() {
    if (!body_.perturbations.empty()) add_perturbations(body_);
    if constexpr (EnvironmentModel::has_contacts) {
      const float distance = body_.contact_distance;
      if (body_.contact_stiffness != 0 && distance != 0) {
        if (!body_.near_pairs.listed() || moved_beyond(list_reach * distance)) search_near_pairs(body_);
        add_contacts(body_);
      }
    }
    if constexpr (EnvironmentModel::has_faces)
      if (model_.acts_on_faces()) {
        const FaceTiles<EnvironmentModel> faces(body_, model_, dither_);
        if (faces.add_forces()) return true;
        faces.for_each_bad_corner([&](std::size_t slot) { note_bad_mass(body_, slot); });
        return false;
      }
    return true;
  }

  // Whether a mass has moved farther than this, relative to the first mass, since near pairs were searched.
  bool moved_beyond(float reach) const {
    const BodyArrays arrays(body_);
    const float *const x = body_.near_pairs.x().data(), *const y = body_.near_pairs.y().data(),
                       *const z = body_.near_pairs.z().data();
    const Lanes3 first_moved{arrays.x.x[0] - x[0], arrays.x.y[0] - y[0], arrays.x.z[0] - z[0]};
    Lanes farthest_squared = 0.0f;
    for (std::size_t slot = 0; slot < arrays.slots; slot += lane_count) {
      const Lanes3 then{load_aligned(x + slot), load_aligned(y + slot), load_aligned(z + slot)};
      farthest_squared = larger(farthest_squared, squared_length(load_aligned(arrays.x, slot) - then - first_moved));
    }
    return largest(farthest_squared) > reach * reach;
  }

  void reset_padding() {
    const std::size_t first = body_.slots.of_mass[0];
    for (const std::uint32_t slot : body_.slots.padding) {
      body_.x.x[slot] = body_.x.x[first];
      body_.x.y[slot] = body_.x.y[first];
      body_.x.z[slot] = body_.x.z[first];
      body_.v.x[slot] = body_.v.y[slot] = body_.v.z[slot] = 0;
    }
  }

  Body& body_;
  const EnvironmentModel model_;
  const StepConstants constants_;
  std::uint32_t dither_ = 0;
};

template <class EnvironmentModel, bool gathered_springs>
std::int64_t advance_body(Body& body, const EnvironmentModel& model, const StepSetting& setting, Factors factors,
                          StepRange steps) {
  BodyStepper<EnvironmentModel, gathered_springs> stepper(body, model, setting);
  for (std::int64_t n = 0; n < steps.count; ++n)
    if (!stepper.step(setting.solver, factors.of_step(n), steps.first + n)) return n;
  return steps.count;
}

// Kernel::advance.
inline std::int64_t advance(Body& body, const StepSetting& setting, Factors factors, StepRange steps) {
  return std::visit(
      [&](const auto& model) {
        using EnvironmentModel = std::decay_t<decltype(model)>;
        if (!body.springs.has_gathered_rows())
          return advance_body<EnvironmentModel, false>(body, model, setting, factors, steps);
        return advance_body<EnvironmentModel, true>(body, model, setting, factors, steps);
      },
      setting.model);
}

}  // namespace mercury::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
