// SPDX-License-Identifier: Apache-2.0
#include "sim/physics/face_pairs.h"

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

namespace mercury {
namespace {

struct HalfEdge {
  std::uint32_t key = 0;  // both masses, the lower one first
  std::uint32_t face = 0;
};

std::uint32_t edge_key(std::uint32_t a, std::uint32_t b) { return std::min(a, b) << 16 | std::max(a, b); }

std::array<std::uint16_t, 3> corners(const Face& face) { return {face.a, face.b, face.c}; }

// The pair of two faces that share exactly the edge `key`, each with its own orientation.
FacePair pair_of(const Face& first, const Face& second, std::uint32_t key) {
  const auto on_edge = [&](std::uint16_t mass) { return mass == key >> 16 || mass == (key & 0xffff); };
  auto corner = corners(first);
  while (on_edge(corner[1])) std::ranges::rotate(corner, corner.begin() + 1);
  // The first face is now (a, b, c) with the edge c -> a; a consistent neighbour runs a -> c -> d.
  const auto [a, b, c] = corner;
  for (const std::uint16_t d : corners(second))
    if (!on_edge(d)) return {a, b, c, d};
  return {a, b, c, a};
}

// Chooses the vertex order by rest positions (face_pairs.h).
FacePair ordered_by_position(FacePair pair, const Robot& robot) {
  const auto key = [&](std::uint16_t mass) {
    const Vec3 x = robot.masses[mass];
    return std::tuple(x.z, x.y, x.x, mass);
  };
  if (pair.d == pair.a) return pair;
  if (key(pair.c) < key(pair.a)) std::swap(pair.a, pair.c);
  if (key(pair.d) < key(pair.b)) std::swap(pair.b, pair.d);
  return pair;
}

struct Candidate {
  std::uint32_t apart, face, key;  // apart: index of the second face minus index of the first
  friend auto operator<=>(const Candidate&, const Candidate&) = default;
};

// Pairs of faces with a common edge. Pairs whose faces are close in the file come first: they are often the two
// triangles of a square.
std::vector<Candidate> candidates_of(const Robot& robot) {
  std::vector<HalfEdge> edges;
  edges.reserve(3 * robot.faces.size());
  for (std::uint32_t f = 0; f < robot.faces.size(); ++f) {
    const Face& face = robot.faces[f];
    edges.push_back({edge_key(face.a, face.b), f});
    edges.push_back({edge_key(face.b, face.c), f});
    edges.push_back({edge_key(face.c, face.a), f});
  }
  std::ranges::sort(edges, {}, [](const HalfEdge& e) { return std::uint64_t{e.key} << 32 | e.face; });
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i + 1 < edges.size(); ++i)
    if (edges[i].key == edges[i + 1].key && edges[i].face != edges[i + 1].face)
      candidates.push_back({edges[i + 1].face - edges[i].face, edges[i].face, edges[i].key});
  std::ranges::sort(candidates);
  return candidates;
}

}  // namespace

std::vector<FacePair> pair_faces(const Robot& robot) {
  std::vector<FacePair> pairs;
  std::vector<std::uint8_t> matched(robot.faces.size());
  for (const auto& [apart, face, key] : candidates_of(robot)) {
    if (matched[face] || matched[face + apart]) continue;
    matched[face] = matched[face + apart] = 1;
    pairs.push_back(ordered_by_position(pair_of(robot.faces[face], robot.faces[face + apart], key), robot));
  }
  for (std::size_t f = 0; f < robot.faces.size(); ++f)
    if (!matched[f]) pairs.push_back({robot.faces[f].a, robot.faces[f].b, robot.faces[f].c, robot.faces[f].a});
  return pairs;
}

}  // namespace mercury
