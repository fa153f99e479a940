#include "sim/cpu/lockstep.h"

#include <algorithm>
#include <numeric>

#include "sim/cpu/step.h"

namespace mercury::cpu {
namespace {

bool same_ends(const Spring& a, const Spring& b) { return a.a == b.a && a.b == b.b; }

std::size_t member_of(const Lockstep& group, std::size_t lane) {
  return group.bodies[lane < group.bodies.size() ? lane : 0];
}

Vec3 at(const Lockstep& group, const Aligned<float>& values, std::size_t mass, std::size_t lane) {
  const float* const first = values.data() + 3 * mass * group.lanes + lane;
  return {first[0], first[group.lanes], first[2 * group.lanes]};
}

std::vector<std::uint64_t> present_lists(const Lockstep& group) {
  std::vector<std::uint64_t> lists;
  for (const Body* body : group.members) lists.push_back(body->near_pairs.times_listed());
  return lists;
}

void fill_springs(Lockstep& group, std::span<const Body> bodies, const Configuration& configuration) {
  for (std::size_t lane = 0; lane < group.lanes; ++lane) {
    const Body& body = bodies[member_of(group, lane)];
    const std::array<float, max_materials> hardness = hardness_of(body, configuration);
    std::size_t slot = lane;
    for (const std::uint32_t s : group.build->springs) {
      const Spring& spring = body.robot->springs[s];
      group.rest_length[slot] = spring.rest_length;
      group.material[slot] = spring.material;
      group.hardness[slot] = hardness[spring.material];
      slot += group.lanes;
    }
  }
}

}  // namespace

Build build_of(const Robot& robot) {
  Build build;
  build.joints.resize(robot.masses.size());
  build.springs.resize(robot.springs.size());
  std::iota(build.springs.begin(), build.springs.end(), 0u);
  const auto ends = [&](std::uint32_t s) { return std::minmax(robot.springs[s].a, robot.springs[s].b); };
  std::ranges::stable_sort(build.springs, [&](std::uint32_t s, std::uint32_t t) { return ends(s) < ends(t); });
  for (const std::uint32_t s : build.springs) {
    const auto [owner, partner] = std::pair<std::uint32_t, std::uint32_t>(ends(s));
    build.partners.push_back(partner);
    ++build.joints[owner].owned;
    ++build.joints[owner].springs;
    ++build.joints[partner].springs;
  }
  build.faces = pair_faces(robot);
  return build;
}

std::uint64_t build_key(const Robot& robot) {
  std::uint64_t key = 0xcbf29ce484222325u ^ robot.masses.size();
  const auto take = [&](std::uint64_t value) { key = (key ^ value) * 0x100000001b3u; };  // as FNV-1a takes bytes
  for (const Spring& spring : robot.springs) take(std::uint64_t{spring.a} << 16 | spring.b);
  for (const Face& face : robot.faces) take(std::uint64_t{face.a} << 32 | std::uint64_t{face.b} << 16 | face.c);
  return key;
}

bool same_build(const Robot& a, const Robot& b) {
  return a.masses.size() == b.masses.size() && std::ranges::equal(a.springs, b.springs, same_ends) && a.faces == b.faces;
}

std::size_t footprint_in_lockstep(const Robot& robot, std::size_t lanes) {
  return lanes * (robot.springs.size() * (2 * sizeof(float) + sizeof(MaterialId)) + robot.masses.size() * 9 * sizeof(float));
}

Lockstep make_lockstep(std::shared_ptr<const Build> build, std::span<const Body> bodies, std::vector<std::size_t> members,
                       const Configuration& configuration) {
  Lockstep group;
  group.lanes = bodies[members.front()].places.lanes;
  group.build = std::move(build);
  group.bodies = std::move(members);
  const std::size_t springs = group.build->springs.size() * group.lanes, masses = group.build->joints.size() * 3 * group.lanes;
  group.rest_length.resize(springs);
  group.hardness.resize(springs);
  group.material.resize(springs);
  fill_springs(group, bodies, configuration);
  for (Aligned<float>* state : {&group.x, &group.v, &group.checkpoint_x, &group.checkpoint_v}) state->resize(masses);
  group.sums.resize(masses);
  if (std::holds_alternative<Land>(configuration.environment)) group.listed_x.resize(masses);
  for (std::size_t lane = 0; lane < group.lanes; ++lane) {
    const Body& body = bodies[member_of(group, lane)];
    group.force_scale.push_back(body.scale.force);
    group.correction_scale.push_back(body.scale.correction);
    group.squared_stretch_limit.push_back(body.measures.squared_stretch_limit());
    group.contact_distance.push_back(body.measures.contact_distance());
  }
  return group;
}

void load(Lockstep& group, std::span<Body> bodies) {
  group.members.resize(group.lanes);
  for (std::size_t lane = 0; lane < group.lanes; ++lane) {
    Body& body = bodies[member_of(group, lane)];
    group.members[lane] = &body;
    std::size_t at = lane;
    for (std::size_t mass = 0; mass < group.build->joints.size(); ++mass) {
      const Vec3 x = body.position(mass), v = body.velocity(mass);
      for (const auto& [position, velocity] : {std::pair(x.x, v.x), std::pair(x.y, v.y), std::pair(x.z, v.z)}) {
        group.x[at] = position;
        group.v[at] = velocity;
        at += group.lanes;
      }
    }
  }
  group.compact = false;
  if (group.lists != present_lists(group)) group.lists.clear();
}

void store(const Lockstep& group, std::span<Body> bodies) {
  const std::size_t masses = group.build->joints.size();
  std::vector<Vec3> positions(masses), velocities(masses);
  for (std::size_t lane = 0; lane < group.bodies.size(); ++lane) {
    for (std::size_t mass = 0; mass < masses; ++mass) {
      positions[mass] = at(group, group.x, mass, lane);
      velocities[mass] = at(group, group.v, mass, lane);
    }
    Body& body = bodies[group.bodies[lane]];
    set_state(body, positions, velocities);
    body.written = false;
  }
}

void list_near_pairs(Lockstep& group, std::uint32_t lanes) {
  for (std::size_t lane = 0; lane < group.lanes; ++lane) {
    if ((lanes >> lane & 1) == 0) continue;
    Body& body = *group.members[lane];
    for (std::size_t mass = 0; mass < group.build->joints.size(); ++mass) {
      const std::size_t place = body.places.of_mass[mass];
      const std::size_t first = 3 * mass * group.lanes + lane;
      body.x.x[place] = group.listed_x[first] = group.x[first];
      body.x.y[place] = group.listed_x[first + group.lanes] = group.x[first + group.lanes];
      body.x.z[place] = group.listed_x[first + 2 * group.lanes] = group.x[first + 2 * group.lanes];
    }
    body.near_pairs.list(body.x.x, body.x.y, body.x.z, body.measures.contact_distance());
  }
  group.lists = present_lists(group);
}

void add_contacts(Lockstep& group, float stiffness) {
  for (std::size_t lane = 0; lane < group.lanes; ++lane) {
    const Body& body = *group.members[lane];
    for_each_contact(
        body, stiffness, [&](std::uint32_t place) { return at(group, group.x, body.places.mass_at[place], lane); },
        [&](std::uint32_t place, Vec3 units) {
          std::int32_t* const first = group.sums.data() + 3 * body.places.mass_at[place] * group.lanes + lane;
          add_units(first[0], units.x);
          add_units(first[group.lanes], units.y);
          add_units(first[2 * group.lanes], units.z);
        });
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
  group.compact = false;
}

}  // namespace mercury::cpu
