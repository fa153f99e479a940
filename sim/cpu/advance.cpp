// SPDX-License-Identifier: Apache-2.0
#include "sim/cpu/backend.h"

#include <algorithm>
#include <cmath>

#include "sim/cpu/grouping/cost_model.h"
#include "sim/cpu/layout/scalar_forces.h"

namespace mercury::cpu {
namespace {

// Factors of the bodies' materials. Bodies with the same table as the previous one share what is known of it.
class FactorCache {
 public:
  explicit FactorCache(Muscles& muscles) : muscles_(muscles) {}

  // The factors of the body's materials, perhaps of others, too. Driven ones have been added before.
  std::array<FactorId, max_materials> factors_of(const Body& body) {
    if (!is_table_of(body)) known_ = {};
    table_ = body.materials;
    std::array<bool, max_materials> wanted;
    for (std::size_t id = 0; id < max_materials; ++id) wanted[id] = body.measures.used[id] && !known_[id];
    for (const DrivenMaterial& driven : body.drives.materials) wanted[driven.id] = false;
    for (std::size_t id = 0; id < max_materials; ++id) known_[id] |= wanted[id];
    muscles_.add(table_, wanted, factors_);
    std::array<FactorId, max_materials> factors = factors_;
    for (const DrivenMaterial& driven : body.drives.materials) factors[driven.id] = driven.factor;
    return factors;
  }

 private:
  bool is_table_of(const Body& body) const {
    return body.materials.size() == table_.size() &&
           (body.materials.data() == table_.data() || std::ranges::equal(body.materials, table_));
  }

  Muscles& muscles_;
  std::span<const Material> table_;
  std::array<bool, max_materials> known_{};
  std::array<FactorId, max_materials> factors_{};
};

template <class Work>
void for_each_body(WorkBatch& batch, const Work& work) {
  for (LockstepGroup& group : batch.groups)
    for (Body* const body : group.bodies) work(*body);
  for (Body* const body : batch.bodies) work(*body);
}

void update_spring_parameters(WorkBatch& batch, const AnyEnvironmentModel& model) {
  batch.muscles = {};
  for_each_body(batch, [&](Body& body) { add_driven_factors(body, batch.muscles); });
  FactorCache factor_cache(batch.muscles);
  for (LockstepGroup& group : batch.groups) {
    std::vector<std::array<FactorId, max_materials>> factors;
    for (const Body* body : group.bodies) factors.push_back(factor_cache.factors_of(*body));
    if (!group.bodies.empty()) set_spring_parameters(group, model, factors);
  }
  for (Body* body : batch.bodies) set_factors(*body, factor_cache.factors_of(*body));
  batch.spring_parameters_are_stale = false;
}

// Whether a velocity is so large that one more step could overflow to infinity or NaN, or is not finite already.
bool could_overflow(const Body& body) {
  constexpr float max_speed = 1e30f;  // [m/s]
  for (std::size_t mass = 0; mass < body.slots.of_mass.size(); ++mass) {
    const Vec3 v = body.velocity(mass);
    if (!(std::abs(v.x) <= max_speed && std::abs(v.y) <= max_speed && std::abs(v.z) <= max_speed)) return true;
  }
  return false;
}

// Whether all members can be stepped in lockstep.
bool is_ready(const LockstepGroup& group) {
  return std::ranges::all_of(group.bodies, [](Body* body) {
    return body->status.exploded_step < 0 && (!body->written || (!could_overflow(*body) && accept_state(*body)));
  });
}

// The members' muscles are among those of the batch already.
void break_up(LockstepGroup& group, WorkBatch& batch) {
  store(group);
  FactorCache factor_cache(batch.muscles);
  for (Body* body : group.bodies) {
    prepare_to_step_alone(*body);
    set_factors(*body, factor_cache.factors_of(*body));
  }
  batch.bodies.insert(batch.bodies.end(), group.bodies.begin(), group.bodies.end());
  group = {};
}

void advance_alone(const Kernel& kernel, Body& body, const StepSetting& setting, Factors factors, StepRange steps) {
  if (body.status.exploded_step >= 0) return;
  const std::int64_t done = body.written && !accept_state(body) ? 0 : kernel.advance(body, setting, factors, steps);
  if (done < steps.count) explode(body, steps.first + done);
}

}  // namespace

std::size_t advance(const Kernel& kernel, WorkBatch& batch, const StepSetting& setting, const Clock& clock,
                    std::int64_t steps) {
  if (batch.spring_parameters_are_stale) update_spring_parameters(batch, setting.model);
  for_each_body(batch, [&](Body& body) {
    if (!read_drives(body, batch.muscles) && body.status.exploded_step < 0) body.status = {.exploded_step = clock.step};
  });
  std::size_t broken_up = 0;
  const auto break_up_counted = [&](LockstepGroup& group) {
    break_up(group, batch);
    ++broken_up;
  };
  for (LockstepGroup& group : batch.groups) {
    if (group.bodies.empty()) continue;
    if (!is_ready(group)) {
      break_up_counted(group);
      continue;
    }
    if (!group.holds_state()) load(group);
    set_perturbations(group);
  }
  batch.muscles.move_to(clock);
  const std::size_t muscles = batch.muscles.amplitude.size();
  const std::int64_t at_once =
      std::clamp(static_cast<std::int64_t>(limits.factors_at_once / muscles), std::int64_t{1}, limits.steps_at_once);
  batch.factors.resize(static_cast<std::size_t>(std::min(steps, at_once)) * muscles + Factors::readable);
  for (std::int64_t done = 0; done < steps; done += at_once) {
    const std::int64_t now = std::min(at_once, steps - done);
    const StepRange range{clock.step + done, now};
    kernel.fill_factors(batch.muscles, batch.factors.data(), now);
    const Factors factors{batch.factors.data(), muscles, kernel.looks_up_one_by_one()};
    for (LockstepGroup& group : batch.groups) {
      if (group.bodies.empty()) continue;
      reset_padding(group, now);
      make_checkpoint(group);
      if (kernel.advance_group(group, setting, factors, range)) continue;
      return_to_checkpoint(group);
      break_up_counted(group);
    }
    for (Body* body : batch.bodies)
      advance_alone(kernel, *body, body->own ? body->own->setting : setting, factors, range);
  }
  return broken_up;
}

void store(std::span<WorkBatch> batches) {
  for (WorkBatch& batch : batches)
    for (LockstepGroup& group : batch.groups) store(group);
}

}  // namespace mercury::cpu
