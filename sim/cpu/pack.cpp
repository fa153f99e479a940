// SPDX-License-Identifier: Apache-2.0
#include "sim/cpu/pack.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "sim/cpu/party.h"

namespace mercury::cpu {
namespace {

constexpr std::int64_t most_steps_at_once = 32;
constexpr std::size_t most_factors = 16384;  // of the steps at hand, in a core's cache
constexpr std::size_t most_muscles = 4096;

// Fills packs one after the other.
class Packer {
 public:
  explicit Packer(std::size_t most_bodies) : most_bodies_(most_bodies) {}

  // The pack that takes so many more bodies, which may move so many muscles and touch so many bytes.
  Pack& pack_for(std::size_t bodies, std::size_t muscles, std::size_t bytes) {
    if (packs_.empty() || bodies_ + bodies > most_bodies_ || muscles_ + muscles > most_muscles ||
        bytes_ + bytes > cache_share) {
      packs_.emplace_back();
      bodies_ = muscles_ = bytes_ = 0;
    }
    bodies_ += bodies;
    muscles_ += muscles;
    bytes_ += bytes;
    return packs_.back();
  }
  std::vector<Pack> take() { return std::move(packs_); }

 private:
  std::size_t most_bodies_, bodies_ = 0, muscles_ = 0, bytes_ = 0;
  std::vector<Pack> packs_;
};

std::size_t muscles_of(const Body& body) {
  return static_cast<std::size_t>(std::ranges::count(body.measures.used, true));
}

// The factors of bodies' materials; a body with the table of the one before has the same.
class Casting {
 public:
  explicit Casting(Muscles& muscles) : muscles_(muscles) {}

  const std::array<FactorId, max_materials>& factors_of(const Body& body) {
    if (before_ == nullptr || before_->measures.used != body.measures.used ||
        std::memcmp(before_->materials.data(), body.materials.data(), max_materials * sizeof(Material)) != 0)
      factors_ = muscles_.add(body.materials, body.measures.used);
    before_ = &body;
    return factors_;
  }

 private:
  Muscles& muscles_;
  const Body* before_ = nullptr;
  std::array<FactorId, max_materials> factors_{};
};

void take_laws(Pack& pack, std::span<Body> bodies, const AnyEnvironmentModel& model) {
  pack.muscles = {};
  Casting casting(pack.muscles);
  for (Lockstep& group : pack.groups) {
    std::vector<std::array<FactorId, max_materials>> factors;
    for (const std::size_t i : group.bodies) {
      factors.push_back(casting.factors_of(bodies[i]));
      set_factors(bodies[i], factors.back());  // if it has to be stepped alone
    }
    if (!group.bodies.empty()) take_laws(group, bodies, model, factors);
  }
  for (const std::size_t i : pack.bodies) set_factors(bodies[i], casting.factors_of(bodies[i]));
  pack.laws_are_stale = false;
}

// Whether no velocity is so large that one more step could make a number of it that is none (or is none already).
bool velocities_are_tame(const Body& body) {
  constexpr float most = 1e30f;  // [m/s]
  for (std::size_t mass = 0; mass < body.places.of_mass.size(); ++mass) {
    const Vec3 v = body.velocity(mass);
    if (!(std::abs(v.x) <= most && std::abs(v.y) <= most && std::abs(v.z) <= most)) return false;
  }
  return true;
}

// Whether all of a group can be stepped in lockstep now.
bool ready(const Lockstep& group, std::span<Body> bodies) {
  return std::ranges::all_of(group.bodies, [&](std::size_t i) {
    Body& body = bodies[i];
    return body.status.exploded_step < 0 && (!body.written || (velocities_are_tame(body) && accept_state(body)));
  });
}

void break_up(Lockstep& group, Pack& pack) {
  store(group);
  pack.bodies.insert(pack.bodies.end(), group.bodies.begin(), group.bodies.end());
  group = {};
}

void advance_alone(const Kernel& kernel, Body& body, const StepSetting& setting, Factors factors, std::int64_t step,
                   std::int64_t steps) {
  if (body.status.exploded_step >= 0) return;
  const std::int64_t made = body.written && !accept_state(body) ? 0 : kernel.advance(body, setting, factors, steps);
  if (made < steps) explode(body, step + made);
}

}  // namespace

std::vector<Pack> pack(std::span<const Body> bodies, std::size_t threads, const Configuration& configuration) {
  std::vector<Party> parties = find_parties(bodies, threads, configuration);
  std::vector<bool> together(bodies.size());
  Packer packer(std::max<std::size_t>(1, bodies.size() / (packs_a_thread * threads)));
  for (Party& party : parties) {
    std::size_t muscles = 0;
    for (const std::size_t i : party.bodies) {
      together[i] = true;
      muscles += muscles_of(bodies[i]);
    }
    const std::size_t bytes = footprint(*party.assembly.build, bodies[party.bodies.front()].places.lanes);
    Pack& pack = packer.pack_for(party.bodies.size(), muscles, bytes);
    pack.groups.push_back(make_lockstep(bodies, std::move(party.bodies), std::move(party.assembly),
                                        std::holds_alternative<Land>(configuration.environment)));
  }
  for (std::size_t i = 0; i < bodies.size(); ++i)
    if (!together[i]) packer.pack_for(1, muscles_of(bodies[i]), footprint(bodies[i])).bodies.push_back(i);
  return packer.take();
}

std::size_t advance(const Kernel& kernel, Pack& pack, std::span<Body> bodies, const StepSetting& setting,
                    const Clock& clock, std::int64_t steps) {
  if (pack.laws_are_stale) take_laws(pack, bodies, setting.model);
  std::size_t broken = 0;
  const auto break_up_counted = [&](Lockstep& group) {
    break_up(group, pack);
    ++broken;
  };
  for (Lockstep& group : pack.groups) {
    if (group.bodies.empty()) continue;
    if (!ready(group, bodies)) {
      break_up_counted(group);
      continue;
    }
    if (!group.resident()) load(group, bodies);
    take_perturbations(group);
  }
  pack.muscles.move_to(clock);
  const std::size_t muscles = pack.muscles.amplitude.size();
  const std::int64_t at_once =
      std::clamp(static_cast<std::int64_t>(most_factors / muscles), std::int64_t{1}, most_steps_at_once);
  pack.factors.resize(static_cast<std::size_t>(std::min(steps, at_once)) * muscles);
  for (std::int64_t done = 0; done < steps; done += at_once) {
    const std::int64_t now = std::min(at_once, steps - done);
    kernel.fill_factors(pack.muscles, pack.factors.data(), now);
    const Factors factors{pack.factors.data(), muscles};
    for (Lockstep& group : pack.groups) {
      if (group.bodies.empty()) continue;
      settle_stand_ins(group, now);
      make_checkpoint(group);
      if (kernel.advance_together(group, setting, factors, now)) continue;
      return_to_checkpoint(group);
      break_up_counted(group);
    }
    for (const std::size_t i : pack.bodies) advance_alone(kernel, bodies[i], setting, factors, clock.step + done, now);
  }
  return broken;
}

void store(std::span<Pack> packs) {
  for (Pack& pack : packs)
    for (Lockstep& group : pack.groups) store(group);
}

}  // namespace mercury::cpu
