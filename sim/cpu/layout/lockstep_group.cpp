// SPDX-License-Identifier: Apache-2.0
#include "sim/cpu/layout/lockstep_group.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <type_traits>

#include "sim/cpu/layout/scalar_forces.h"
#include "sim/physics/fixed_point.h"

namespace mercury::cpu {
namespace {

Vec3 at(const LockstepGroup& group, const Aligned<float>& values, std::size_t offset) {
  return {values[offset], values[offset + group.lanes], values[offset + 2 * group.lanes]};
}
void set(const LockstepGroup& group, Aligned<float>& values, std::size_t offset, Vec3 value) {
  values[offset] = value.x;
  values[offset + group.lanes] = value.y;
  values[offset + 2 * group.lanes] = value.z;
}
void add_to_sums(LockstepGroup& group, std::size_t offset, Vec3 units) {
  add_units(group.sums[offset], units.x);
  add_units(group.sums[offset + group.lanes], units.y);
  add_units(group.sums[offset + 2 * group.lanes], units.z);
}

std::size_t member_of(const LockstepGroup& group, std::size_t lane) { return lane < group.bodies.size() ? lane : 0; }

std::vector<std::uint64_t> current_searches(const LockstepGroup& group) {
  std::vector<std::uint64_t> searches;
  for (std::size_t lane = 0; lane < group.lanes; ++lane) searches.push_back(group.body_in(lane).near_pairs.searches());
  return searches;
}

void set_topology(LockstepGroup& group, MergedTopology merged) {
  group.topology = std::move(merged.topology);
  // A sum receives rounding_magic_bits from each entry that the slot is partner in, and loses it for each that it owns.
  for (const auto& [owned, valence] : group.topology->slots)
    group.slots.push_back(
        {owned, static_cast<std::int32_t>((2 * owned - valence) * std::uint32_t{rounding_magic_bits})});
  for (const std::uint32_t partner : group.topology->partners) group.partners.push_back(group.offset_of(partner));
  for (std::size_t lane = 0; lane < group.lanes; ++lane)
    group.index_maps.push_back(merged.index_maps[member_of(group, lane)]);
}

// One face tile per face pair of the topology; two pairs share a split one where they can.
void make_face_tiles(LockstepGroup& group) {
  const std::vector<FacePair>& pairs = group.topology->face_pairs;
  const auto corners = [&](std::uint32_t pair) {
    const auto& [a, b, c, d] = pairs[pair];
    return LockstepGroup::FaceTile{group.offset_of(a), group.offset_of(b), group.offset_of(c), group.offset_of(d)};
  };
  const HalfFacePairs halves = half_face_pairs(pairs.size(), group.index_maps);
  const std::size_t split = group.lanes < min_lanes_to_split ? 0 : std::min(halves.lower.size(), halves.upper.size());
  std::vector<bool> is_split(pairs.size());
  for (const std::vector<std::uint32_t>* half : {&halves.lower, &halves.upper})
    for (std::size_t i = 0; i < split; ++i) is_split[(*half)[i]] = true;
  group.face_tile_of_pair.resize(pairs.size());
  for (std::uint32_t pair = 0; pair < pairs.size(); ++pair)
    if (!is_split[pair]) {
      group.face_tile_of_pair[pair] = static_cast<std::uint32_t>(group.face_tiles.size());
      group.face_tiles.push_back(corners(pair));
    }
  for (std::size_t i = 0; i < split; ++i) {
    group.face_tile_of_pair[halves.lower[i]] = group.face_tile_of_pair[halves.upper[i]] =
        static_cast<std::uint32_t>(group.face_tiles.size() + i);
    const auto lower = corners(halves.lower[i]), upper = corners(halves.upper[i]);
    group.split_face_tiles.push_back({{lower.a, upper.a}, {lower.b, upper.b}, {lower.c, upper.c}, {lower.d, upper.d}});
  }
}

void resize_arrays(LockstepGroup& group) {
  const std::size_t entries = group.partners.size() * group.lanes, slots = group.slots.size() * group.lanes;
  group.rest_length.resize(entries);
  group.stiffness.resize(entries);
  group.relaxation_time.resize(entries);
  group.factor.resize(entries);
  const std::size_t face_entries = (group.face_tiles.size() + group.split_face_tiles.size()) * group.lanes;
  for (Aligned<float>* coefficients : {&group.face_drag, &group.face_lift, &group.face_tangential, &group.face_normal})
    coefficients->resize(face_entries);
  group.face_dither.resize(face_entries);
  group.inverse_inertia.assign(slots, 0);
  group.weight.assign(slots, 0);
  for (Aligned<float>* state : {&group.x, &group.v, &group.checkpoint_x, &group.checkpoint_v}) state->resize(3 * slots);
  group.sums.resize(3 * slots);
  for (Aligned<float>* by_lane :
       {&group.force_scale, &group.correction_scale, &group.environment_scale, &group.squared_stretch_limit,
        &group.contact_distance, &group.highest_length_rate, &group.face_force_bound, &group.squared_diagonal})
    by_lane->resize(group.lanes);
}

void find_padding(LockstepGroup& group) {
  const std::size_t slots = group.slots.size() * group.lanes;
  std::vector<bool> taken(slots);
  for (std::size_t lane = 0; lane < group.lanes; ++lane)
    for (const std::uint32_t slot : group.index_maps[lane]->slots) taken[slot * group.lanes + lane] = true;
  const auto lanes = static_cast<std::uint32_t>(group.lanes);
  for (std::uint32_t i = 0; i < slots; ++i)
    if (!taken[i]) group.padding.push_back({i / lanes, i % lanes});
}

// of_sums() of an environment that acts on faces.
std::optional<FaceCoefficients<float>> face_coefficients_of(const AnyEnvironmentModel& model, float scale) {
  return std::visit(
      [&](const auto& kind) -> std::optional<FaceCoefficients<float>> {
        if constexpr (std::decay_t<decltype(kind)>::has_faces) return kind.of_sums(scale);
        return std::nullopt;
      },
      model);
}

}  // namespace

LockstepGroup make_lockstep_group(std::vector<Body*> members, MergedTopology merged, bool contacts) {
  LockstepGroup group;
  group.lanes = members.front()->slots.lanes;
  group.bodies = std::move(members);
  set_topology(group, std::move(merged));
  make_face_tiles(group);
  resize_arrays(group);
  find_padding(group);
  if (contacts) {
    group.searched_x.resize(group.x.size());
    group.is_mass.assign(group.slots.size() * group.lanes, 1.0f);
    for (const auto [slot, lane] : group.padding) group.is_mass[slot * group.lanes + lane] = 0;
  }
  return group;
}

void set_spring_parameters(LockstepGroup& group, const AnyEnvironmentModel& model,
                           std::span<const std::array<FactorId, max_materials>> factors) {
  std::ranges::fill(group.rest_length, 0.0f);
  std::ranges::fill(group.factor, FactorId{0});
  std::ranges::fill(group.stiffness, 0.0f);
  std::ranges::fill(group.relaxation_time, 0.0f);
  group.viscous = false;
  std::ranges::fill(group.face_drag, 0.0f);
  std::ranges::fill(group.face_lift, 0.0f);
  std::ranges::fill(group.face_tangential, 0.0f);
  std::ranges::fill(group.face_normal, 0.0f);
  for (std::size_t lane = 0; lane < group.lanes; ++lane) {
    const std::size_t member = member_of(group, lane);
    const Body& body = *group.bodies[member];
    const IndexMap& index_map = *group.index_maps[lane];
    for (std::size_t s = 0; s < index_map.entries.size(); ++s) {
      const Spring& spring = body.robot->springs[s];
      const std::size_t entry = index_map.entries[s] * group.lanes + lane;
      group.rest_length[entry] = spring.rest_length;
      group.stiffness[entry] = body.stiffness[s];
      group.factor[entry] = factors[member][spring.material];
      group.relaxation_time[entry] = body.materials[spring.material].relaxation_time;
    }
    group.viscous = group.viscous || body.viscous;
    for (std::size_t mass = 0; mass < index_map.slots.size(); ++mass) {
      const PointProperties point = body.point(mass);
      group.inverse_inertia[index_map.slots[mass] * group.lanes + lane] = point.inverse_inertia;
      group.weight[index_map.slots[mass] * group.lanes + lane] = point.weight;
    }
    if (const auto coefficients = face_coefficients_of(model, body.scale.environment)) {
      group.face_force_bound[lane] = coefficients->bound();
      for (std::uint32_t own = 0; own < index_map.face_pairs.size(); ++own) {
        const std::size_t i = group.face_tile_of_pair[index_map.face_pairs[own]] * group.lanes + lane;
        group.face_dither[i] = dither_of_pair(own);
        group.face_drag[i] = coefficients->drag;
        group.face_lift[i] = coefficients->lift;
        group.face_tangential[i] = coefficients->tangential;
        group.face_normal[i] = coefficients->normal;
        if (body.backs.empty()) continue;
        const std::size_t first = 2 * (i - lane) + lane;
        group.face_backs.resize(2 * group.face_dither.size());
        group.face_backs[first] =
            static_cast<std::uint32_t>(group.offset_of(index_map.slots[body.backs[own].first], lane));
        group.face_backs[first + group.lanes] =
            static_cast<std::uint32_t>(group.offset_of(index_map.slots[body.backs[own].second], lane));
      }
    }
    group.force_scale[lane] = body.scale.force;
    group.correction_scale[lane] = body.scale.correction;
    group.environment_scale[lane] = body.scale.environment;
    group.squared_stretch_limit[lane] = body.measures.squared_stretch_limit();
    group.contact_distance[lane] = body.contact_distance;
    group.highest_length_rate[lane] = highest_length_rate(body.measures, body.materials);
  }
}

void load(LockstepGroup& group) {
  for (std::size_t lane = 0; lane < group.lanes; ++lane) {
    const Body& body = group.body_in(lane);
    const std::vector<std::uint32_t>& slots = group.index_maps[lane]->slots;
    for (std::size_t mass = 0; mass < slots.size(); ++mass) {
      const std::size_t offset = group.offset_of(slots[mass], lane);
      set(group, group.x, offset, body.position(mass));
      set(group, group.v, offset, body.velocity(mass));
    }
  }
  for (std::size_t lane = 0; lane < group.bodies.size(); ++lane)
    group.bodies[lane]->location = {&group, group.x.data() + lane, group.v.data() + lane,
                                    group.index_maps[lane]->slots.data(), group.lanes};
  std::ranges::fill(group.squared_diagonal, std::numeric_limits<float>::infinity());
  group.steps_since_padding_reset = std::numeric_limits<std::int64_t>::max() / 2;
  if (group.searches != current_searches(group)) group.searches.clear();
}

void store(LockstepGroup& group) {
  if (!group.holds_state()) return;
  std::vector<Vec3> positions, velocities;
  for (Body* const member : group.bodies) {
    Body& body = *member;
    const std::size_t masses = body.robot->masses.size();
    positions.resize(masses);
    velocities.resize(masses);
    for (std::size_t mass = 0; mass < masses; ++mass) {
      positions[mass] = body.position(mass);
      velocities[mass] = body.velocity(mass);
    }
    body.location = {};
    set_state(body, positions, velocities);
    body.written = false;
  }
}

void reset_padding(LockstepGroup& group, std::int64_t steps_ahead) {
  constexpr std::int64_t max_steps = 64;
  group.steps_since_padding_reset += steps_ahead;
  if (group.steps_since_padding_reset <= max_steps) return;
  group.steps_since_padding_reset = steps_ahead;
  for (const auto [slot, lane] : group.padding) {
    const std::uint32_t first = group.index_maps[lane]->slots[0];
    set(group, group.x, group.offset_of(slot, lane), at(group, group.x, group.offset_of(first, lane)));
    set(group, group.v, group.offset_of(slot, lane), {});
  }
}

void set_perturbations(LockstepGroup& group) {
  group.perturbations.clear();
  for (std::size_t lane = 0; lane < group.lanes; ++lane)
    for (const Perturbation& perturbation : group.body_in(lane).perturbations)
      group.perturbations.push_back({group.offset_of(group.index_maps[lane]->slots[perturbation.mass], lane),
                                     perturbation.target,
                                     perturbation.stiffness * group.body_in(lane).scale.environment});
}

void add_perturbations(LockstepGroup& group) {
  for (const auto& [offset, target, stiffness] : group.perturbations) {
    const Vec3 units = stiffness * (target - at(group, group.x, offset));
    if (fits(units)) add_to_sums(group, offset, units);
  }
}

void search_near_pairs(LockstepGroup& group, std::uint32_t lanes, void (*search)(Body&)) {
  for (std::size_t lane = 0; lane < group.lanes; ++lane) {
    if ((lanes >> lane & 1) == 0) continue;
    Body& body = group.body_in(lane);
    for (std::size_t mass = 0; mass < body.robot->masses.size(); ++mass) {
      const std::size_t slot = body.slots.of_mass[mass],
                        offset = group.offset_of(group.index_maps[lane]->slots[mass], lane);
      const Vec3 x = at(group, group.x, offset);
      set(group, group.searched_x, offset, x);
      body.x.x[slot] = x.x;
      body.x.y[slot] = x.y;
      body.x.z[slot] = x.z;
    }
    search(body);
  }
  group.searches = current_searches(group);
}

void add_contacts(LockstepGroup& group) {
  for (std::size_t lane = 0; lane < group.lanes; ++lane) {
    const Body& body = group.body_in(lane);
    const std::vector<std::uint32_t>& slots = group.index_maps[lane]->slots;
    const auto offset = [&](std::uint32_t slot) { return group.offset_of(slots[body.slots.mass_at[slot]], lane); };
    for_each_contact(
        body, [&](std::uint32_t slot) { return at(group, group.x, offset(slot)); },
        [&](std::uint32_t slot, Vec3 units) { add_to_sums(group, offset(slot), units); });
  }
}

void make_checkpoint(LockstepGroup& group) {
  std::ranges::copy(group.x, group.checkpoint_x.begin());
  std::ranges::copy(group.v, group.checkpoint_v.begin());
}

void return_to_checkpoint(LockstepGroup& group) {
  std::ranges::copy(group.checkpoint_x, group.x.begin());
  std::ranges::copy(group.checkpoint_v, group.v.begin());
  std::ranges::fill(group.sums, 0);
}

}  // namespace mercury::cpu
