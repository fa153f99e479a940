// The step of one robot in vector code, for every pair of solver and environment.
#pragma once

#include "sim/cpu/kernel.h"
#include "sim/cpu/lanes.h"
#include "sim/cpu/rows.h"

HWY_BEFORE_NAMESPACE();
namespace mercury::cpu::HWY_NAMESPACE {

HWY_INLINE Lanes3 load_aligned(const Triples<float>& from, std::size_t place) {
  return {load_aligned(from.x.data() + place), load_aligned(from.y.data() + place), load_aligned(from.z.data() + place)};
}
HWY_INLINE Integers3 load_aligned(const Triples<std::int32_t>& from, std::size_t place) {
  return {load_aligned(from.x.data() + place), load_aligned(from.y.data() + place), load_aligned(from.z.data() + place)};
}
template <class Value, class T>
HWY_INLINE void store_aligned(Value a, Triples<T>& to, std::size_t place) {
  store_aligned(a.x, to.x.data() + place);
  store_aligned(a.y, to.y.data() + place);
  store_aligned(a.z, to.z.data() + place);
}

// The smallest box around the masses.
struct Box {
  Lanes3 low, high;

  HWY_INLINE Box() : low{3e38f, 3e38f, 3e38f}, high{-3e38f, -3e38f, -3e38f} {}  // a default would lack the instruction set
  HWY_INLINE void add(Lanes3 x) {
    low = {smaller(low.x, x.x), smaller(low.y, x.y), smaller(low.z, x.z)};
    high = {larger(high.x, x.x), larger(high.y, x.y), larger(high.z, x.z)};
  }
  // Rounded like the length of any spring in it, so that no spring can come out longer.
  HWY_INLINE float squared_diagonal() const {
    return squared_length(Vec3{largest(high.x) - smallest(low.x), largest(high.y) - smallest(low.y),
                               largest(high.z) - smallest(low.z)});
  }
};

// A slot's springs between owners and partners.
template <bool xpbd, bool checked>
struct SlotLaw {
  const float* factors;
  const float* rest_length;
  const float* hardness;
  const MaterialId* material;
  Lanes longest;

  // The contribution to the partners in units, plus rounding_magic_bits. `d` points from partner to owner.
  HWY_INLINE Integers3 operator()(Lanes3 d, Lanes splits) {
    const Lanes squared = squared_length(d);
    const Lanes rest = load_aligned(rest_length);
    if constexpr (checked) longest = select((squared > longest) & (rest > 0.0f), squared, longest);
    const Lanes length = rest * look_up(factors, material);
    Lanes per_distance;
    if constexpr (xpbd)
      per_distance = mercury::xpbd(squared, length, splits, load_aligned(hardness));
    else
      per_distance = hooke(squared, length, load_aligned(hardness));
    rest_length += lane_count;
    hardness += lane_count;
    material += lane_count;
    return {to_fixed_plus_magic(per_distance, d.x), to_fixed_plus_magic(per_distance, d.y),
            to_fixed_plus_magic(per_distance, d.z)};
  }
};

// All springs' contributions. False if one is beyond the stretch limit.
template <bool xpbd, bool checked>
bool add_springs(Body& body, const float* factors) {
  const SpringPlan& plan = body.springs;
  const float *const x = body.x.x.data(), *const y = body.x.y.data(), *const z = body.x.z.data();
  const float *const splits = body.splits.data(), *const rows = body.x_rows.data();
  std::int32_t *const reaction_x = body.sums.reaction.x.data(), *const reaction_y = body.sums.reaction.y.data(),
               *const reaction_z = body.sums.reaction.z.data();
  SlotLaw<xpbd, checked> law{factors, plan.rest_length.data(), plan.hardness.data(), plan.material.data(), 0.0f};
  const Run* run = plan.runs.data();
  const std::uint32_t* partners = plan.partners.data();
  std::size_t place = 0;
  for (const SpringPlan::Block& block : plan.blocks) {
    const Lanes3 own = load_aligned(body.x, place);
    const Lanes own_splits = xpbd ? load_aligned(splits + place) : Lanes(0.0f);
    Integers3 sum{no_integers(), no_integers(), no_integers()};
    for (const Run* const end = run + block.runs; run != end; ++run) {
      const std::size_t at = run->partner;
      const Lanes partner_splits = xpbd ? load(splits + at) : Lanes(0.0f);
      const Integers3 f = law(own - Lanes3{load(x + at), load(y + at), load(z + at)}, own_splits + partner_splits);
      sum = sum - f;
      store(load(reaction_x + run->reaction) + f.x, reaction_x + run->reaction);
      store(load(reaction_y + run->reaction) + f.y, reaction_y + run->reaction);
      store(load(reaction_z + run->reaction) + f.z, reaction_z + run->reaction);
    }
    for (const std::uint32_t* const end = partners + block.rows * lane_count; partners != end; partners += lane_count) {
      const Lanes4 partner = collect(rows, partners);
      const Integers3 f = law(own - Lanes3{partner.x, partner.y, partner.z}, own_splits + partner.w);
      sum = sum - f;
      add_to_rows(f, body.sums.rows.data(), partners);
    }
    store_aligned(sum, body.sums.own, place);
    place += lane_count;
  }
  if constexpr (checked) return largest(law.longest) <= body.measures.squared_stretch_limit();
  return true;
}

template <class Hooks>
class Stepper {
 public:
  Stepper(Body& body, const Hooks& hooks, const StepSetting& setting)
      : body_(body), hooks_(hooks), constants_(setting.constants), contact_(setting.contact), places_(body.places.mass_at.size()) {
    if ((Hooks::has_faces || body.springs.has_rows()) && !body.rows_are_current) {
      for (std::size_t place = 0; place < places_; place += lane_count) {
        store_x_rows(load_aligned(body.x, place), place);
        store_v_rows(load_aligned(body.v, place), place);
      }
    }
    body.rows_are_current = Hooks::has_faces;
  }

  // Algorithm 1.
  bool step_force(const float* factors) {
    if (!add_environment()) return false;
    if (!(body_.compact ? add_springs<false, false>(body_, factors) : add_springs<false, true>(body_, factors))) return false;
    const float inverse_scale = 1 / body_.scale.force;
    Box box;
    bool finite = true;
    for (std::size_t place = 0; place < places_; place += lane_count) {
      const Lanes3 x0 = load_aligned(body_.x, place), v0 = load_aligned(body_.v, place);
      const Lanes3 force = Lanes(inverse_scale) * float_of(take<true>(place)) + hooks_.on_mass(v0);
      Lanes3 v = accelerated(v0, force, constants_);
      Lanes3 x = multiply_add(constants_.dt, v, x0);
      end_step(x, v, hooks_, constants_);
      finite &= keep(x, v, x0, v0, place);
      box.add(x);
      store_for_rows(x, v, place);
    }
    settle_stand_ins();
    body_.compact = box.squared_diagonal() <= body_.measures.squared_stretch_limit();
    return finite;
  }

  // Algorithm 2.
  bool step_xpbd(const float* factors) {
    if (!add_environment() || !predict()) return false;
    if (!(body_.compact ? add_springs<true, false>(body_, factors) : add_springs<true, true>(body_, factors))) return false;
    body_.compact = false;
    const float inverse_scale = 1 / body_.scale.correction;
    bool finite = true;
    for (std::size_t place = 0; place < places_; place += lane_count) {
      const Lanes3 x0 = load_aligned(body_.x, place), v0 = load_aligned(body_.v, place);
      const Lanes3 correction = Lanes(inverse_scale) * float_of(take<true>(place));
      Lanes3 x = x0 + correction;
      Lanes3 v = multiply_add(constants_.inverse_dt, correction, v0);
      end_step(x, v, hooks_, constants_);
      finite &= keep(x, v, x0, v0, place);
      store_for_rows(x, v, place);
    }
    settle_stand_ins();
    return finite;
  }

 private:
  // Forces that do not depend on one mass alone.
  bool add_environment() {
    if (!body_.pulls.empty()) add_pulls(body_);
    if constexpr (Hooks::has_contacts) {
      const float distance = body_.measures.contact_distance();
      if (contact_.stiffness != 0 && distance != 0) {
        if (!body_.near_pairs.listed() || strayed(list_reach * distance))
          body_.near_pairs.list(body_.x.x, body_.x.y, body_.x.z, distance);
        add_contacts(body_, contact_.stiffness);
      }
    }
    if constexpr (Hooks::has_faces) return add_faces();
    return true;
  }

  // Whether a mass went farther than this from where it was listed, seen from the first mass.
  bool strayed(float reach) const {
    const NearPairs& then = body_.near_pairs;
    const Lanes3 common{body_.x.x[0] - then.x()[0], body_.x.y[0] - then.y()[0], body_.x.z[0] - then.z()[0]};
    Lanes farthest_squared = 0.0f;
    for (std::size_t place = 0; place < places_; place += lane_count) {
      const Lanes3 listed{load_aligned(then.x().data() + place), load_aligned(then.y().data() + place),
                          load_aligned(then.z().data() + place)};
      farthest_squared = larger(farthest_squared, squared_length(load_aligned(body_.x, place) - listed - common));
    }
    return largest(farthest_squared) > reach * reach;
  }

  // A third of each face's force to each of its masses. False, and the lowest mass noted, if a force is out of range.
  bool add_faces() {
    constexpr float third = 1.0f / 3.0f;
    const Lanes scale = third * body_.scale.force;
    std::int32_t* const rows = body_.sums.rows.data();
    bool fit = true;
    for (std::size_t i = 0; i < body_.faces.size(); i += 4 * lane_count) {
      const std::uint32_t *const a = body_.faces.data() + i, *const b = a + lane_count, *const c = b + lane_count,
                          *const d = c + lane_count;
      const Lanes3 xa = position(a), to_c = position(c) - xa;
      const Lanes3 shared = velocity(a) + velocity(c);
      const Lanes3 first =
          scale * hooks_.on_face(Lanes(0.5f) * cross(position(b) - xa, to_c), Lanes(third) * (shared + velocity(b)));
      const Lanes3 second =
          scale * hooks_.on_face(Lanes(0.5f) * cross(to_c, position(d) - xa), Lanes(third) * (shared + velocity(d)));
      const Mask fits_both{hn::And(fits(first).m, fits(second).m)};
      if (!every(fits_both)) {
        note_bad_faces(a, ~bits_of(fits_both));
        fit = false;
        continue;
      }
      const Integers3 on_b = round_to_int(first), on_d = round_to_int(second), on_both = on_b + on_d;
      add_to_rows(on_both, rows, a);
      add_to_rows(on_b, rows, b);
      add_to_rows(on_both, rows, c);
      add_to_rows(on_d, rows, d);
    }
    return fit;
  }
  Lanes3 position(const std::uint32_t* corners) const {
    const Lanes4 rows = collect(body_.x_rows.data(), corners);
    return {rows.x, rows.y, rows.z};
  }
  Lanes3 velocity(const std::uint32_t* corners) const {
    const Lanes4 rows = collect(body_.v_rows.data(), corners);
    return {rows.x, rows.y, rows.z};
  }
  void note_bad_faces(const std::uint32_t* corners, std::uint32_t lanes) {
    for (std::size_t lane = 0; lane < lane_count; ++lane)
      for (std::size_t corner = 0; corner < 4 && (lanes >> lane & 1) != 0; ++corner)
        note_bad(corners[corner * lane_count + lane] / 4);
  }

  // XPBD: leaves the prediction in place of the position and v + dt F in place of the velocity.
  bool predict() {
    const float inverse_scale = 1 / body_.scale.force;
    Box box;
    bool finite = true;
    for (std::size_t place = 0; place < places_; place += lane_count) {
      const Lanes3 x0 = load_aligned(body_.x, place), v0 = load_aligned(body_.v, place);
      const Lanes3 force = Lanes(inverse_scale) * float_of(take<false>(place)) + hooks_.on_mass(v0);
      Lanes3 v = accelerated(v0, force, constants_);
      Lanes3 x = multiply_add(constants_.dt, v, x0);
      finite &= keep(x, v, x0, v0, place);
      box.add(x);
      if (body_.springs.has_rows()) store_x_rows(x, place);
    }
    body_.compact = box.squared_diagonal() <= body_.measures.squared_stretch_limit();
    return finite;
  }

  // The sums of a block, which start again thereafter.
  template <bool springs>
  Integers3 take(std::size_t place) {
    Triples<std::int32_t>& reaction = body_.sums.reaction;
    const Integers3 none{no_integers(), no_integers(), no_integers()};
    Integers3 sum = load_aligned(reaction, place);
    store_aligned(none, reaction, place);
    if constexpr (springs) {
      const std::size_t stride = body_.places.padded();
      for (std::size_t i = 1; i < reaction_arrays; ++i) {
        sum = sum + load_aligned(reaction, place + i * stride);
        store_aligned(none, reaction, place + i * stride);
      }
      const Integers bias{hn::BitCast(integers, load_aligned(body_.springs.bias.data() + place).v)};
      sum = sum + load_aligned(body_.sums.own, place) + Integers3{bias, bias, bias};
    }
    if (Hooks::has_faces || body_.springs.has_rows()) sum = sum + take_rows(body_.sums.rows.data() + 4 * place);
    return sum;
  }

  // Stores the new state of those masses that are within reach. The others stay, and if one is a mass, false: the robot
  // has exploded.
  HWY_INLINE bool keep(Lanes3& x, Lanes3& v, Lanes3 x0, Lanes3 v0, std::size_t place) {
    const Mask good = within_reach(x);
    bool all = true;
    if (HWY_UNLIKELY(!every(good))) {
      x = select(good, x, x0);
      v = select(good, v, v0);
      for (std::size_t lane = 0; lane < lane_count; ++lane)
        if ((bits_of(good) >> lane & 1) == 0) all &= !note_bad(place + lane);
    }
    store_aligned(x, body_.x, place);
    store_aligned(v, body_.v, place);
    return all;
  }
  // False for a stand-in.
  bool note_bad(std::size_t place) {
    const std::uint32_t mass = body_.places.mass_at[place];
    body_.status.bad_mass = std::min(body_.status.bad_mass, mass);
    return mass != no_mass;
  }

  HWY_INLINE void store_for_rows(Lanes3 x, Lanes3 v, std::size_t place) {
    if (Hooks::has_faces || body_.springs.has_rows()) store_x_rows(x, place);
    if constexpr (Hooks::has_faces) store_v_rows(v, place);
  }
  HWY_INLINE void store_x_rows(Lanes3 x, std::size_t place) {
    store_rows({x.x, x.y, x.z, load_aligned(body_.splits.data() + place)}, body_.x_rows.data() + 4 * place);
  }
  HWY_INLINE void store_v_rows(Lanes3 v, std::size_t place) {
    store_rows({v.x, v.y, v.z, v.z}, body_.v_rows.data() + 4 * place);
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
  const Hooks hooks_;
  const StepConstants constants_;
  const ContactLaw contact_;
  const std::size_t places_;
};

inline void fill_factors(Muscles& muscles, float* factors, std::int64_t steps) {
  constexpr hn::RepartitionToWide<decltype(words)> phases;
  for (std::size_t id = 0; id < max_materials; id += lane_count) {
    const Lanes amplitude = load_aligned(muscles.amplitude.data() + id);
    std::uint64_t *const lower_phase = muscles.phase.data() + id, *const upper_phase = lower_phase + lane_count / 2;
    const std::uint64_t *const lower_step = muscles.per_step.data() + id, *const upper_step = lower_step + lane_count / 2;
    auto lower = hn::Load(phases, lower_phase), upper = hn::Load(phases, upper_phase);
    for (std::int64_t step = 0; step < steps; ++step) {
      const Words turns = hn::ConcatOdd(words, hn::BitCast(words, upper), hn::BitCast(words, lower));
      hn::Store(multiply_add(amplitude, sine_of_turns(turns), 1.0f).v, floats,
                factors + static_cast<std::size_t>(step) * max_materials + id);
      lower = hn::Add(lower, hn::Load(phases, lower_step));
      upper = hn::Add(upper, hn::Load(phases, upper_step));
    }
    hn::Store(lower, phases, lower_phase);
    hn::Store(upper, phases, upper_phase);
  }
}

template <class Hooks>
std::int64_t advance_with(const Hooks& hooks, Body& body, const StepSetting& setting, const float* factors, std::int64_t steps) {
  Stepper<Hooks> stepper(body, hooks, setting);
  for (std::int64_t n = 0; n < steps; ++n, factors += max_materials) {
    const bool finite = setting.solver == Solver::force ? stepper.step_force(factors) : stepper.step_xpbd(factors);
    if (!finite) return n;
  }
  return steps;
}

inline std::int64_t advance(Body& body, const StepSetting& setting, const float* factors, std::int64_t steps) {
  if (const auto* ocean = std::get_if<OceanHooks>(&setting.hooks)) return advance_with(*ocean, body, setting, factors, steps);
  if (const auto* simple = std::get_if<OceanSimpleHooks>(&setting.hooks))
    return advance_with(*simple, body, setting, factors, steps);
  return advance_with(std::get<LandHooks>(setting.hooks), body, setting, factors, steps);
}

}  // namespace mercury::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
