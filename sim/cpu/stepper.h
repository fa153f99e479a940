// SPDX-License-Identifier: Apache-2.0
// The step of one robot in vector code, for every pair of solver and environment.
#pragma once

#include "sim/cpu/motion.h"
#include "sim/cpu/near_search.h"
#include "sim/cpu/skin.h"
#include "sim/cpu/spring_slots.h"

HWY_BEFORE_NAMESPACE();
namespace mercury::cpu::HWY_NAMESPACE {

template <class EnvironmentModel, bool spring_rows>
class Stepper {
 public:
  Stepper(Body& body, const EnvironmentModel& model, const StepSetting& setting)
      : body_(body), model_(model), constants_(setting.constants), contact_stiffness_(setting.contact.stiffness) {
    if (needs_rows != body.sums.with_rows) {
      clear(body.sums);
      body.sums.with_rows = needs_rows;
    }
    if (needs_rows && !body.rows_are_current) {
      const Arrays arrays(body);
      for (std::size_t place = 0; place < arrays.places; place += lane_count) {
        arrays.store_x_rows(load_aligned(arrays.x, place), place);
        arrays.store_v_rows(load_aligned(arrays.v, place), place);
      }
    }
    body.rows_are_current = EnvironmentModel::has_faces;
  }

  // False if the robot has exploded.
  bool step(Solver solver, const float* factors) {
    return solver == Solver::force ? step_force(factors) : step_xpbd(factors);
  }

 private:
  using Moving = Motion<EnvironmentModel, spring_rows>;
  static constexpr bool needs_rows = Moving::needs_rows;

  // Algorithm 1.
  bool step_force(const float* factors) {
    if (!add_environment()) return false;
    Moving end(body_, model_, constants_, body_.scale.force);
    if (!add_springs(factors, body_.squared_diagonal, [&](std::size_t place) HWY_ATTR { end.end_with_forces(place); }))
      return false;
    settle_stand_ins();
    body_.squared_diagonal = end.squared_diagonal();
    return end.finite();
  }

  // Algorithm 2.
  bool step_xpbd(const float* factors) {
    if (!add_environment()) return false;
    Moving prediction(body_, model_, constants_, body_.scale.force);
    for (std::size_t place = 0; place < body_.places.mass_at.size(); place += lane_count) prediction.predict(place);
    if (!prediction.finite()) return false;
    Moving end(body_, model_, constants_, body_.scale.correction);
    if (!add_springs(factors, prediction.squared_diagonal(),
                     [&](std::size_t place) HWY_ATTR { end.end_with_corrections(place); }))
      return false;
    settle_stand_ins();
    body_.squared_diagonal = end.squared_diagonal();
    return end.finite();
  }

  // No spring is longer than the diagonal of the box around all masses.
  template <class Finish>
  bool add_springs(const float* factors, float squared_diagonal, const Finish& finish) {
    return squared_diagonal <= body_.measures.squared_stretch_limit()
               ? HWY_NAMESPACE::add_springs<false, spring_rows>(body_, factors, finish)
               : HWY_NAMESPACE::add_springs<true, spring_rows>(body_, factors, finish);
  }

  // Forces that do not depend on one mass alone.
  bool add_environment() {
    if (!body_.perturbations.empty()) add_perturbations(body_);
    if constexpr (EnvironmentModel::has_contacts) {
      const float distance = body_.measures.contact_distance();
      if (contact_stiffness_ != 0 && distance != 0) {
        if (!body_.near_pairs.listed() || strayed(list_reach * distance)) list_near_pairs(body_);
        add_contacts(body_, contact_stiffness_);
      }
    }
    if constexpr (EnvironmentModel::has_faces) {
      const Skin<EnvironmentModel> skin(body_, model_);
      if (skin.add_forces()) return true;
      skin.for_each_bad_corner([&](std::size_t place) { note_bad(body_, place); });
      return false;
    }
    return true;
  }

  // Whether a mass went farther than this from where it was listed, seen from the first mass.
  bool strayed(float reach) const {
    const Arrays arrays(body_);
    const float *const x = body_.near_pairs.x().data(), *const y = body_.near_pairs.y().data(),
                       *const z = body_.near_pairs.z().data();
    const Lanes3 common{arrays.x.x[0] - x[0], arrays.x.y[0] - y[0], arrays.x.z[0] - z[0]};
    Lanes farthest_squared = 0.0f;
    for (std::size_t place = 0; place < arrays.places; place += lane_count) {
      const Lanes3 listed{load_aligned(x + place), load_aligned(y + place), load_aligned(z + place)};
      farthest_squared = larger(farthest_squared, squared_length(load_aligned(arrays.x, place) - listed - common));
    }
    return largest(farthest_squared) > reach * reach;
  }

  // Stand-ins rest where the first mass is, so that they are always within its robot.
  void settle_stand_ins() {
    const std::size_t first = body_.places.of_mass[0];
    for (const std::uint32_t place : body_.places.stand_ins) {
      body_.x.x[place] = body_.x.x[first];
      body_.x.y[place] = body_.x.y[first];
      body_.x.z[place] = body_.x.z[first];
      body_.v.x[place] = body_.v.y[place] = body_.v.z[place] = 0;
    }
  }

  Body& body_;
  const EnvironmentModel model_;
  const StepConstants constants_;
  const float contact_stiffness_;
};

template <class EnvironmentModel, bool spring_rows>
std::int64_t advance_body(Body& body, const EnvironmentModel& model, const StepSetting& setting, Factors factors,
                          std::int64_t steps) {
  Stepper<EnvironmentModel, spring_rows> stepper(body, model, setting);
  for (std::int64_t n = 0; n < steps; ++n)
    if (!stepper.step(setting.solver, factors.of_step(n))) return n;
  return steps;
}

// Kernel::advance.
inline std::int64_t advance(Body& body, const StepSetting& setting, Factors factors, std::int64_t steps) {
  return with_model(setting, [&](const auto& model) {
    using EnvironmentModel = std::decay_t<decltype(model)>;
    return body.springs.has_rows() ? advance_body<EnvironmentModel, true>(body, model, setting, factors, steps)
                                   : advance_body<EnvironmentModel, false>(body, model, setting, factors, steps);
  });
}

}  // namespace mercury::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
