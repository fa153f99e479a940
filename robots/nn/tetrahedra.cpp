// SPDX-License-Identifier: Apache-2.0
#include "robots/nn/tetrahedra.h"

#include <algorithm>
#include <numeric>

namespace mercury {
namespace {

// The sides of a tetrahedron seen from outside; side i is opposite to point i.
std::array<Triangle, 4> sides_of(const Tetrahedron& t) {
  const auto& [a, b, c, d] = t;
  return {Triangle{b, c, d}, Triangle{a, d, c}, Triangle{a, b, d}, Triangle{a, c, b}};
}

Triangle lowest_first(Triangle triangle) {
  std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
  return triangle;
}

// One above the highest point.
std::uint32_t end_of_points(std::span<const Tetrahedron> tetrahedra) {
  std::uint32_t end = 0;
  for (const Tetrahedron& t : tetrahedra)
    for (const std::uint32_t point : t) end = std::max(end, point + 1);
  return end;
}

struct Side {
  Triangle points;  // sorted
  Triangle outward;
  std::uint32_t tetrahedron;
};

// Every side of every tetrahedron, equal ones next to each other.
std::vector<Side> sorted_sides(std::span<const Tetrahedron> tetrahedra) {
  std::vector<Side> sides;
  sides.reserve(4 * tetrahedra.size());
  for (std::uint32_t i = 0; i < tetrahedra.size(); ++i) {
    for (const Triangle& outward : sides_of(tetrahedra[i])) {
      Triangle points = outward;
      std::sort(points.begin(), points.end());
      sides.push_back({points, outward, i});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.points < b.points; });
  return sides;
}

bool is_shared(const std::vector<Side>& sides, std::size_t i) {
  return i + 1 < sides.size() && sides[i].points == sides[i + 1].points;
}

// The edges from a point to points above it, which differ. As few as there mostly are, they are sorted by counting
// those below each, without a branch.
void append_sorted(std::vector<Edge>& edges, std::uint32_t low, std::span<std::uint32_t> highs) {
  constexpr std::size_t few = 64;
  if (highs.size() > few) {
    std::ranges::sort(highs);
    for (const std::uint32_t high : highs) edges.emplace_back(low, high);
    return;
  }
  const std::size_t first = edges.size();
  edges.resize(first + highs.size());
  for (const std::uint32_t high : highs) {
    std::size_t below = 0;
    for (const std::uint32_t other : highs) below += other < high ? 1 : 0;
    edges[first + below] = {low, high};
  }
}

}  // namespace

// Even permutations keep the volume positive.
Tetrahedron lowest_first(const Tetrahedron& tetrahedron) {
  Tetrahedron t = tetrahedron;
  const auto lowest = std::min_element(t.begin(), t.end()) - t.begin();
  if (lowest == 1) t = {t[1], t[0], t[3], t[2]};
  if (lowest == 2) t = {t[2], t[3], t[0], t[1]};
  if (lowest == 3) t = {t[3], t[2], t[1], t[0]};
  std::rotate(t.begin() + 1, std::min_element(t.begin() + 1, t.end()), t.end());
  return t;
}

// Collects the higher ends of each point's edges, about 40, of which 7 differ.
std::vector<Edge> edges_of(std::span<const Tetrahedron> tetrahedra) {
  const std::uint32_t points = end_of_points(tetrahedra);
  std::vector<std::uint32_t> ends_of(points + 1, 0), ends(6 * tetrahedra.size());
  const auto for_each = [&](auto visit) {
    for (const Tetrahedron& t : tetrahedra)
      for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = i + 1; j < 4; ++j) visit(std::min(t[i], t[j]), std::max(t[i], t[j]));
  };
  for_each([&](std::uint32_t low, std::uint32_t) { ++ends_of[low]; });
  std::exclusive_scan(ends_of.begin(), ends_of.end(), ends_of.begin(), 0u);
  for_each([&](std::uint32_t low, std::uint32_t high) { ends[ends_of[low]++] = high; });
  std::vector<Edge> edges;
  edges.reserve(tetrahedra.size() + 2 * points);  // Euler's formula, for a body that does not touch itself
  std::vector<std::uint32_t> last_seen_by(points, no_neighbor);
  auto next = ends.begin();
  for (std::uint32_t low = 0; low < points; ++low) {
    const auto begin = next, end = ends.begin() + ends_of[low];
    auto last = begin;
    for (; next != end; ++next) {
      *last = *next;
      last += std::exchange(last_seen_by[*next], low) != low ? 1 : 0;
    }
    append_sorted(edges, low, {begin, last});
  }
  return edges;
}

std::vector<Triangle> skin_of(std::span<const Tetrahedron> tetrahedra) {
  const std::vector<Side> sides = sorted_sides(tetrahedra);
  std::vector<Triangle> skin;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    if (is_shared(sides, i)) {
      ++i;
      continue;
    }
    skin.push_back(lowest_first(sides[i].outward));
  }
  std::sort(skin.begin(), skin.end());
  return skin;
}

std::vector<Triangle> skin_of(std::span<const Tetrahedron> tetrahedra, std::span<const Neighbors> opposite) {
  std::vector<Triangle> skin;
  for (std::size_t t = 0; t < tetrahedra.size(); ++t)
    for (std::size_t i = 0; i < 4; ++i)
      if (opposite[t][i] == no_neighbor) skin.push_back(lowest_first(sides_of(tetrahedra[t])[i]));
  std::sort(skin.begin(), skin.end());
  return skin;
}

std::vector<Neighbors> neighbors_of(std::span<const Tetrahedron> tetrahedra) {
  const std::vector<Side> sides = sorted_sides(tetrahedra);
  std::vector<Neighbors> neighbors(tetrahedra.size());
  for (Neighbors& n : neighbors) n.fill(no_neighbor);
  const auto join = [&](std::uint32_t from, std::uint32_t to) {
    *std::find(neighbors[from].begin(), neighbors[from].end(), no_neighbor) = to;
  };
  for (std::size_t i = 0; i < sides.size(); ++i) {
    if (!is_shared(sides, i)) continue;
    join(sides[i].tetrahedron, sides[i + 1].tetrahedron);
    join(sides[i + 1].tetrahedron, sides[i].tetrahedron);
  }
  return neighbors;
}

SolidBody largest_body(std::span<const Tetrahedron> tetrahedra, std::span<const Neighbors> neighbors,
                       std::size_t count) {
  std::vector<std::uint32_t> last_visit(end_of_points(tetrahedra.first(count)),
                                        no_neighbor);  // of a point, by the body's first tetrahedron
  std::vector<bool> reached(count, false);
  SolidBody best;
  for (std::uint32_t first = 0; first < count; ++first) {
    if (reached[first]) continue;
    SolidBody body{{first}, 0};
    reached[first] = true;
    for (std::size_t next = 0; next < body.tetrahedra.size(); ++next) {
      for (const std::uint32_t point : tetrahedra[body.tetrahedra[next]]) {
        body.points += last_visit[point] != first;
        last_visit[point] = first;
      }
      for (const std::uint32_t other : neighbors[body.tetrahedra[next]]) {
        if (other >= count || reached[other]) continue;
        reached[other] = true;
        body.tetrahedra.push_back(other);
      }
    }
    if (body.points > best.points)
      best = std::move(body);
    else if (body.points == best.points && best.rival == no_neighbor)
      best.rival = first;
  }
  return best;
}

std::vector<std::uint32_t> components(std::size_t count, std::span<const Edge> edges) {
  std::vector<std::uint32_t> parent(count);
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t point) {
    while (parent[point] != point) point = parent[point] = parent[parent[point]];
    return point;
  };
  for (const auto& [a, b] : edges) {
    const auto [low, high] = std::minmax({root(a), root(b)});
    parent[high] = low;
  }
  for (std::uint32_t point = 0; point < count; ++point) parent[point] = root(point);
  return parent;
}

}  // namespace mercury
