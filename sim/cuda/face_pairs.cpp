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

// 32 pairs and the banks that their four columns of masses take.
struct Bundle {
  std::array<std::uint32_t, 4> banks{};
  std::vector<FacePair> pairs;

  int conflicts(const FacePair& p) const {
    const std::array<std::uint16_t, 4> mass{p.a, p.b, p.c, p.d};
    int count = 0;
    for (std::size_t column = 0; column < 4; ++column) count += banks[column] >> (mass[column] % lanes) & 1;
    return count;
  }
  void add(const FacePair& p) {
    const std::array<std::uint16_t, 4> mass{p.a, p.b, p.c, p.d};
    for (std::size_t column = 0; column < 4; ++column) banks[column] |= 1u << (mass[column] % lanes);
    pairs.push_back(p);
  }
};

// (a, b, c, d) and (c, d, a, b) are the same two triangles.
FacePair turned(const FacePair& p) { return {p.c, p.d, p.a, p.b}; }

std::vector<FacePair> spread_over_banks(std::vector<FacePair> pairs) {
  constexpr std::size_t open_at_once = 8;
  std::vector<Bundle> open;
  std::vector<FacePair> ordered;
  ordered.reserve(pairs.size());
  const auto close = [&](std::size_t which) {
    ordered.insert(ordered.end(), open[which].pairs.begin(), open[which].pairs.end());
    open.erase(open.begin() + static_cast<std::ptrdiff_t>(which));
  };
  std::size_t started = 0;
  const std::size_t needed = (pairs.size() + lanes - 1) / lanes;
  for (const FacePair& pair : pairs) {
    if (open.size() < open_at_once && started < needed) {
      open.emplace_back();
      ++started;
    }
    std::size_t best = 0;
    bool turn = false;
    int fewest = 99;
    for (std::size_t i = 0; i < open.size(); ++i)
      for (const bool t : {false, true})
        if (const int count = open[i].conflicts(t ? turned(pair) : pair); count < fewest) {
          fewest = count;
          best = i;
          turn = t;
        }
    open[best].add(turn ? turned(pair) : pair);
    if (open[best].pairs.size() == lanes) close(best);
  }
  while (!open.empty()) close(0);
  return ordered;
}

}  // namespace

std::vector<FacePair> pair_faces(const Robot& robot) { return spread_over_banks(match(robot)); }

}  // namespace mercury::cuda
