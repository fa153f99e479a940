// SPDX-License-Identifier: Apache-2.0
#include "sim/cpu/lockstep.h"

#include <algorithm>
#include <limits>

#include "sim/physics/fixed_point.h"

namespace mercury::cpu {
namespace {

Vec3 at(const Lockstep& group, const Aligned<float>& values, std::size_t first) {
  return {values[first], values[first + group.lanes], values[first + 2 * group.lanes]};
}
void put(const Lockstep& group, Aligned<float>& values, std::size_t first, Vec3 value) {
  values[first] = value.x;
  values[first + group.lanes] = value.y;
  values[first + 2 * group.lanes] = value.z;
}
void push(Lockstep& group, std::size_t first, Vec3 units) {
  add_units(group.sums[first], units.x);
  add_units(group.sums[first + group.lanes], units.y);
  add_units(group.sums[first + 2 * group.lanes], units.z);
}

std::size_t member_of(const Lockstep& group, std::size_t lane) { return lane < group.bodies.size() ? lane : 0; }

std::vector<std::uint64_t> present_lists(const Lockstep& group) {
  std::vector<std::uint64_t> lists;
  for (const Body* body : group.members) lists.push_back(body->near_pairs.times_listed());
  return lists;
}

// A slot for each of the build's pairs of faces; two share one where only lanes of the lower half have the one and only
// lanes of the upper half the other.
void share_slots_of_faces(Lockstep& group) {
  const std::vector<FacePair>& pairs = group.build->faces;
  const auto corners = [&](std::uint32_t pair) {
    const auto& [a, b, c, d] = pairs[pair];
    return Lockstep::Corners<std::uint32_t>{group.start_of(a), group.start_of(b), group.start_of(c), group.start_of(d)};
  };
  const FaceHalves halves = halves_of(group.build->faces.size(), group.seatings);
  const std::size_t shared =
      group.lanes < least_lanes_to_split ? 0 : std::min(halves.lower.size(), halves.upper.size());
  std::vector<bool> is_split(pairs.size());
  for (const std::vector<std::uint32_t>* half : {&halves.lower, &halves.upper})
    for (std::size_t i = 0; i < shared; ++i) is_split[(*half)[i]] = true;
  group.face_slots.resize(pairs.size());
  for (std::uint32_t pair = 0; pair < pairs.size(); ++pair)
    if (!is_split[pair]) {
      group.face_slots[pair] = static_cast<std::uint32_t>(group.faces.size());
      group.faces.push_back(corners(pair));
    }
  for (std::size_t i = 0; i < shared; ++i) {
    group.face_slots[halves.lower[i]] = group.face_slots[halves.upper[i]] =
        static_cast<std::uint32_t>(group.faces.size() + i);
    const auto lower = corners(halves.lower[i]), upper = corners(halves.upper[i]);
    group.split_faces.push_back({{lower.a, upper.a}, {lower.b, upper.b}, {lower.c, upper.c}, {lower.d, upper.d}});
  }
}

}  // namespace

Lockstep make_lockstep(std::span<const Body> bodies, std::vector<std::size_t> members, Assembly assembly,
                       bool contacts) {
  Lockstep group;
  group.lanes = bodies[members.front()].places.lanes;
  group.build = std::move(assembly.build);
  group.bodies = std::move(members);
  // A sum holds rounding_magic_bits once for each slot that the seat is partner in, less those that it owns.
  for (const auto& [owned, slots] : group.build->joints)
    group.joints.push_back(
        {owned, static_cast<std::int32_t>((2 * owned - slots) * std::uint32_t{rounding_magic_bits})});
  for (const std::uint32_t partner : group.build->partners) group.partners.push_back(group.start_of(partner));
  for (std::size_t lane = 0; lane < group.lanes; ++lane)
    group.seatings.push_back(assembly.seatings[member_of(group, lane)]);
  const std::size_t slots = group.build->partners.size() * group.lanes,
                    seats = group.build->joints.size() * group.lanes;
  group.rest_length.resize(slots);
  group.hardness.resize(slots);
  group.factor.resize(slots);
  share_slots_of_faces(group);
  for (Aligned<float>* coefficients : {&group.face_drag, &group.face_lift})
    coefficients->resize((group.faces.size() + group.split_faces.size()) * group.lanes);
  for (Aligned<float>* state : {&group.x, &group.v, &group.checkpoint_x, &group.checkpoint_v}) state->resize(3 * seats);
  group.sums.resize(3 * seats);
  for (Aligned<float>* of_lanes : {&group.force_scale, &group.correction_scale, &group.squared_stretch_limit,
                                   &group.contact_distance, &group.most_force, &group.squared_diagonal})
    of_lanes->resize(group.lanes);
  std::vector<bool> taken(seats);
  for (std::size_t lane = 0; lane < group.lanes; ++lane)
    for (const std::uint32_t seat : group.seatings[lane]->seats) taken[seat * group.lanes + lane] = true;
  for (std::uint32_t i = 0; i < seats; ++i)
    if (!taken[i])
      group.stand_ins.push_back(
          {i / static_cast<std::uint32_t>(group.lanes), i % static_cast<std::uint32_t>(group.lanes)});
  if (contacts) {
    group.listed_x.resize(3 * seats);
    group.is_mass.assign(seats, 1.0f);
    for (const auto [seat, lane] : group.stand_ins) group.is_mass[seat * group.lanes + lane] = 0;
  }
  return group;
}

void take_laws(Lockstep& group, std::span<const Body> bodies, const AnyEnvironmentModel& model,
               std::span<const std::array<FactorId, max_materials>> factors) {
  const OceanModel* const ocean = std::get_if<OceanModel>(&model);
  std::ranges::fill(group.rest_length, 0.0f);
  std::ranges::fill(group.factor, FactorId{0});
  std::ranges::fill(group.hardness, 0.0f);
  std::ranges::fill(group.face_drag, 0.0f);
  std::ranges::fill(group.face_lift, 0.0f);
  for (std::size_t lane = 0; lane < group.lanes; ++lane) {
    const std::size_t member = member_of(group, lane);
    const Body& body = bodies[group.bodies[member]];
    const Seating& seating = *group.seatings[lane];
    for (std::size_t s = 0; s < seating.slots.size(); ++s) {
      const Spring& spring = body.robot->springs[s];
      const std::size_t slot = seating.slots[s] * group.lanes + lane;
      group.rest_length[slot] = spring.rest_length;
      group.hardness[slot] = body.hardness[s];
      group.factor[slot] = factors[member][spring.material];
    }
    if (ocean != nullptr) {
      const OceanModel::Coefficients coefficients = ocean->of_sums(body.scale.force);
      group.most_force[lane] = coefficients.most();
      for (const std::uint32_t pair : seating.faces) {
        group.face_drag[group.face_slots[pair] * group.lanes + lane] = coefficients.drag;
        group.face_lift[group.face_slots[pair] * group.lanes + lane] = coefficients.lift;
      }
    }
    group.force_scale[lane] = body.scale.force;
    group.correction_scale[lane] = body.scale.correction;
    group.squared_stretch_limit[lane] = body.measures.squared_stretch_limit();
    group.contact_distance[lane] = body.measures.contact_distance();
  }
}

void load(Lockstep& group, std::span<Body> bodies) {
  group.members.clear();
  for (std::size_t lane = 0; lane < group.lanes; ++lane) {
    Body& body = bodies[group.bodies[member_of(group, lane)]];
    group.members.push_back(&body);
    const std::vector<std::uint32_t>& seats = group.seatings[lane]->seats;
    for (std::size_t mass = 0; mass < seats.size(); ++mass) {
      const std::size_t first = group.first_of(seats[mass], lane);
      put(group, group.x, first, body.position(mass));
      put(group, group.v, first, body.velocity(mass));
    }
  }
  for (std::size_t lane = 0; lane < group.bodies.size(); ++lane)
    group.members[lane]->residence = {&group, group.x.data() + lane, group.v.data() + lane,
                                      group.seatings[lane]->seats.data(), group.lanes};
  std::ranges::fill(group.squared_diagonal, std::numeric_limits<float>::infinity());
  group.steps_since_settled = std::numeric_limits<std::int64_t>::max() / 2;
  if (group.lists != present_lists(group)) group.lists.clear();
}

void store(Lockstep& group) {
  if (!group.resident()) return;
  std::vector<Vec3> positions, velocities;
  for (std::size_t lane = 0; lane < group.bodies.size(); ++lane) {
    Body& body = *group.members[lane];
    const std::size_t masses = body.robot->masses.size();
    positions.resize(masses);
    velocities.resize(masses);
    for (std::size_t mass = 0; mass < masses; ++mass) {
      positions[mass] = body.position(mass);
      velocities[mass] = body.velocity(mass);
    }
    body.residence = {};
    set_state(body, positions, velocities);
    body.written = false;
  }
}

void settle_stand_ins(Lockstep& group, std::int64_t steps_ahead) {
  constexpr std::int64_t most_steps = 64;
  group.steps_since_settled += steps_ahead;
  if (group.steps_since_settled <= most_steps) return;
  group.steps_since_settled = steps_ahead;
  for (const auto [seat, lane] : group.stand_ins) {
    put(group, group.x, group.first_of(seat, lane),
        at(group, group.x, group.first_of(group.seatings[lane]->seats[0], lane)));
    put(group, group.v, group.first_of(seat, lane), {});
  }
}

void take_perturbations(Lockstep& group) {
  group.perturbations.clear();
  for (std::size_t lane = 0; lane < group.lanes; ++lane)
    for (const Perturbation& perturbation : group.members[lane]->perturbations)
      group.perturbations.push_back({group.first_of(group.seatings[lane]->seats[perturbation.mass], lane),
                                     perturbation.target, perturbation.stiffness * group.members[lane]->scale.force});
}

void add_perturbations(Lockstep& group) {
  for (const auto& [first, target, stiffness] : group.perturbations) {
    const Vec3 units = stiffness * (target - at(group, group.x, first));
    if (fits(units)) push(group, first, units);
  }
}

void list_near_pairs(Lockstep& group, std::uint32_t lanes, void (*list)(Body&)) {
  for (std::size_t lane = 0; lane < group.lanes; ++lane) {
    if ((lanes >> lane & 1) == 0) continue;
    Body& body = *group.members[lane];
    for (std::size_t mass = 0; mass < body.robot->masses.size(); ++mass) {
      const std::size_t place = body.places.of_mass[mass],
                        first = group.first_of(group.seatings[lane]->seats[mass], lane);
      const Vec3 x = at(group, group.x, first);
      put(group, group.listed_x, first, x);
      body.x.x[place] = x.x;
      body.x.y[place] = x.y;
      body.x.z[place] = x.z;
    }
    list(body);
  }
  group.lists = present_lists(group);
}

void add_contacts(Lockstep& group, float stiffness) {
  for (std::size_t lane = 0; lane < group.lanes; ++lane) {
    const Body& body = *group.members[lane];
    const std::vector<std::uint32_t>& seats = group.seatings[lane]->seats;
    const auto first = [&](std::uint32_t place) { return group.first_of(seats[body.places.mass_at[place]], lane); };
    for_each_contact(
        body, stiffness, [&](std::uint32_t place) { return at(group, group.x, first(place)); },
        [&](std::uint32_t place, Vec3 units) { push(group, first(place), units); });
  }
}

void make_checkpoint(Lockstep& group) {
  std::ranges::copy(group.x, group.checkpoint_x.begin());
  std::ranges::copy(group.v, group.checkpoint_v.begin());
}

void return_to_checkpoint(Lockstep& group) {
  std::ranges::copy(group.checkpoint_x, group.x.begin());
  std::ranges::copy(group.checkpoint_v, group.v.begin());
  std::ranges::fill(group.sums, 0);
}

}  // namespace mercury::cpu
