#include <algorithm>
#include <array>
#include <bit>

#include "sim/cuda/schedule.h"

namespace mercury::cuda {
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

std::vector<FacePair> match(const Robot& robot) {
  std::vector<HalfEdge> edges;
  edges.reserve(3 * robot.faces.size());
  for (std::uint32_t f = 0; f < robot.faces.size(); ++f) {
    const Face& face = robot.faces[f];
    edges.push_back({edge_key(face.a, face.b), f});
    edges.push_back({edge_key(face.b, face.c), f});
    edges.push_back({edge_key(face.c, face.a), f});
  }
  // By distance of the faces in the file first: a square's two triangles stand side by side there.
  std::ranges::sort(edges, {}, [](const HalfEdge& e) { return std::uint64_t{e.key} << 32 | e.face; });
  std::vector<std::array<std::uint32_t, 3>> candidates;  // how far apart, face, edge
  for (std::size_t i = 0; i + 1 < edges.size(); ++i)
    if (edges[i].key == edges[i + 1].key && edges[i].face != edges[i + 1].face)
      candidates.push_back({edges[i + 1].face - edges[i].face, edges[i].face, edges[i].key});
  std::ranges::sort(candidates);
  std::vector<FacePair> pairs;
  std::vector<std::uint8_t> matched(robot.faces.size());
  for (const auto& [apart, face, key] : candidates) {
    if (matched[face] || matched[face + apart]) continue;
    matched[face] = matched[face + apart] = 1;
    pairs.push_back(pair_of(robot.faces[face], robot.faces[face + apart], key));
  }
  for (std::size_t f = 0; f < robot.faces.size(); ++f)
    if (!matched[f]) pairs.push_back({robot.faces[f].a, robot.faces[f].b, robot.faces[f].c, robot.faces[f].a});
  return pairs;
}

// Up to 32 pairs, and the banks that their four columns of masses take.
struct Bundle {
  std::array<std::uint32_t, 4> banks{};
  std::vector<FacePair> pairs;

  static std::array<std::uint32_t, 4> banks_of(const FacePair& p) {
    return {1u << p.a % lanes, 1u << p.b % lanes, 1u << p.c % lanes, 1u << p.d % lanes};
  }
  bool has_room(const FacePair& p) const {
    if (pairs.size() == lanes) return false;
    const auto wanted = banks_of(p);
    return !(banks[0] & wanted[0] || banks[1] & wanted[1] || banks[2] & wanted[2] || banks[3] & wanted[3]);
  }
  void add(const FacePair& p) {
    const auto wanted = banks_of(p);
    for (std::size_t column = 0; column < 4; ++column) banks[column] |= wanted[column];
    pairs.push_back(p);
  }
};

// The same two triangles, told in another order; a face's force does not depend on its orientation.
std::array<FacePair, 4> tellings(const FacePair& p) {
  return {p, FacePair{p.c, p.d, p.a, p.b}, FacePair{p.a, p.d, p.c, p.b}, FacePair{p.c, p.b, p.a, p.d}};
}

// The fullest bundle that takes a pair in one of its tellings, or a new one.
void place(std::vector<Bundle>& bundles, const FacePair& pair) {
  Bundle* best = nullptr;
  FacePair best_telling;
  for (Bundle& bundle : bundles) {
    if (best && bundle.pairs.size() <= best->pairs.size()) continue;
    for (const FacePair& telling : tellings(pair))
      if (bundle.has_room(telling)) {
        best = &bundle;
        best_telling = telling;
        break;
      }
  }
  if (best) return best->add(best_telling);
  bundles.emplace_back().add(pair);
}

std::vector<FacePair> spread_over_banks(const std::vector<FacePair>& pairs) {
  std::vector<Bundle> bundles;
  for (const FacePair& pair : pairs) place(bundles, pair);
  std::vector<FacePair> ordered;
  for (Bundle& bundle : bundles) {
    bundle.pairs.resize(lanes, no_faces);
    ordered.insert(ordered.end(), bundle.pairs.begin(), bundle.pairs.end());
  }
  return ordered;
}

}  // namespace

std::vector<FacePair> pair_faces(const Robot& robot) { return spread_over_banks(match(robot)); }

}  // namespace mercury::cuda
