// SPDX-License-Identifier: Apache-2.0
#include "mercury/inspect.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "mercury/fnv.h"

namespace mercury {
namespace {

void inspect_materials(const Robot& robot, Inspection& found) {
  std::array<std::size_t, max_materials> springs{};
  for (const Spring& spring : robot.springs) ++springs[spring.material];
  for (std::size_t i = 0; i < springs.size(); ++i) {
    if (springs[i] == 0) continue;
    const auto id = static_cast<MaterialId>(i);
    const Material& material = materials_of(robot)[id];
    found.materials.push_back({id, name_of_material(robot, id), material, springs[i]});
    if (material.amplitude != 0) found.muscles += springs[i];
  }
  for (Actuator& actuator : actuators_of(robot)) {
    std::size_t driven = 0;
    for (const MaterialId id : actuator.materials) driven += springs[id];
    found.actuators.push_back({std::move(actuator), driven});
  }
}

void inspect_box(const Robot& robot, Inspection& found) {
  found.lowest = found.highest = robot.masses.front();
  for (const Vec3& x : robot.masses) {
    found.lowest = {std::min(found.lowest.x, x.x), std::min(found.lowest.y, x.y), std::min(found.lowest.z, x.z)};
    found.highest = {std::max(found.highest.x, x.x), std::max(found.highest.y, x.y), std::max(found.highest.z, x.z)};
  }
  found.extent = found.highest - found.lowest;
  found.length = std::max({found.extent.x, found.extent.y, found.extent.z});
}

void inspect_springs(const Robot& robot, Inspection& found) {
  std::vector<std::size_t> root(robot.masses.size());
  std::iota(root.begin(), root.end(), std::size_t{0});
  const auto root_of = [&](std::size_t i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  std::vector<bool> joined(robot.masses.size(), false);
  found.components = robot.masses.size();
  for (const Spring& spring : robot.springs) {
    joined[spring.a] = joined[spring.b] = true;
    const std::size_t a = root_of(spring.a), b = root_of(spring.b);
    if (a == b) continue;
    root[a] = b;
    --found.components;
  }
  found.loose_masses = static_cast<std::size_t>(std::count(joined.begin(), joined.end(), false));
  found.springs_a_mass = 2 * static_cast<double>(robot.springs.size()) / static_cast<double>(robot.masses.size());
  if (robot.springs.empty()) return;
  const auto [shortest, longest] =
      std::minmax_element(robot.springs.begin(), robot.springs.end(),
                          [](const Spring& a, const Spring& b) { return a.rest_length < b.rest_length; });
  found.shortest_spring = shortest->rest_length;
  found.longest_spring = longest->rest_length;
}

// An edge of a face. `way` is 1 if it runs from the lower mass to the higher, else -1.
struct HalfEdge {
  std::uint16_t low, high;
  int way;
  bool same_edge(const HalfEdge& other) const { return low == other.low && high == other.high; }
};

std::vector<HalfEdge> sorted_half_edges(const Robot& robot) {
  std::vector<HalfEdge> half_edges;
  half_edges.reserve(3 * robot.faces.size());
  const auto add = [&](std::uint16_t from, std::uint16_t to) {
    half_edges.push_back({std::min(from, to), std::max(from, to), from < to ? 1 : -1});
  };
  for (const Face& face : robot.faces) {
    add(face.a, face.b);
    add(face.b, face.c);
    add(face.c, face.a);
  }
  std::sort(half_edges.begin(), half_edges.end(),
            [](const HalfEdge& a, const HalfEdge& b) { return a.low != b.low ? a.low < b.low : a.high < b.high; });
  return half_edges;
}

void inspect_skin(const Robot& robot, Inspection& found) {
  const std::vector<HalfEdge> half_edges = sorted_half_edges(robot);
  long edges = 0;
  for (std::size_t i = 0; i < half_edges.size(); ++edges) {
    int faces = 0, balance = 0;
    const HalfEdge& edge = half_edges[i];
    for (; i < half_edges.size() && half_edges[i].same_edge(edge); ++i, ++faces) balance += half_edges[i].way;
    if (balance != 0) ++found.open_edges;
    if (faces > 2) ++found.crowded_edges;
  }
  found.closed = !robot.faces.empty() && found.open_edges == 0;

  std::vector<bool> on_skin(robot.masses.size(), false);
  for (const Face& face : robot.faces) {
    on_skin[face.a] = on_skin[face.b] = on_skin[face.c] = true;
    // Relative to a corner of the box: small numbers round less if the robot is far from the origin.
    const Vec3 a = robot.masses[face.a] - found.lowest, b = robot.masses[face.b] - found.lowest,
               c = robot.masses[face.c] - found.lowest;
    found.volume += static_cast<double>(dot(a, cross(b, c))) / 6;
    found.area += static_cast<double>(length(cross(b - a, c - a))) / 2;
  }
  const auto corners = std::count(on_skin.begin(), on_skin.end(), true);
  found.euler_characteristic = static_cast<long>(corners) - edges + static_cast<long>(robot.faces.size());
}

}  // namespace

Inspection inspect(const Robot& robot) {
  Inspection found{.masses = robot.masses.size(), .springs = robot.springs.size(), .faces = robot.faces.size()};
  inspect_materials(robot, found);
  inspect_box(robot, found);
  inspect_springs(robot, found);
  inspect_skin(robot, found);
  return found;
}

std::uint64_t body_hash(const Robot& robot) {
  Fnv1a hash;
  const auto add = [&](std::uint32_t value) { hash.add(value); };
  const auto add_size = [&](std::size_t size) { add(static_cast<std::uint32_t>(size)); };
  add_size(robot.masses.size());
  for (const Vec3& place : robot.masses) hash.add(place);
  add_size(robot.springs.size());
  for (const Spring& spring : robot.springs)
    add(spring.a), add(spring.b), add(spring.material), hash.add(spring.rest_length);
  add_size(robot.faces.size());
  for (const Face& face : robot.faces) add(face.a), add(face.b), add(face.c);
  for (const Material& material : materials_of(robot)) {
    hash.add(material.stiffness).add(material.amplitude).add(material.frequency).add(material.phase);
    // Robots without these keep the hash that they had before there were any.
    if (material.half_wave) add(1);
    if (material.relaxation_time != 0) add(2), hash.add(material.relaxation_time);
  }
  const auto add_list = [&](std::uint32_t kind, const auto& list) {
    if (list.empty()) return;
    add(kind);
    for (const auto& value : list) hash.add(value);
  };
  add_list(3, robot.mass);
  add_list(4, robot.velocity);
  add_list(5, robot.fixed);
  return hash.value();
}

}  // namespace mercury
