// SPDX-License-Identifier: Apache-2.0
#include "robots/tetrahedra.h"

#include <algorithm>
#include <numeric>

namespace mercury {
namespace {

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
    const auto& [a, b, c, d] = tetrahedra[i];
    for (const Triangle& outward : {Triangle{a, c, b}, Triangle{a, b, d}, Triangle{a, d, c}, Triangle{b, c, d}}) {
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

}  // namespace

std::vector<Edge> edges_of(std::span<const Tetrahedron> tetrahedra) {
  std::vector<Edge> edges;
  edges.reserve(6 * tetrahedra.size());
  for (const Tetrahedron& t : tetrahedra)
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = i + 1; j < 4; ++j) edges.push_back(std::minmax(t[i], t[j]));
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
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
    Triangle triangle = sides[i].outward;
    std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
    skin.push_back(triangle);
  }
  std::sort(skin.begin(), skin.end());
  return skin;
}

std::vector<Neighbours> neighbours_of(std::span<const Tetrahedron> tetrahedra) {
  const std::vector<Side> sides = sorted_sides(tetrahedra);
  std::vector<Neighbours> neighbours(tetrahedra.size());
  for (Neighbours& n : neighbours) n.fill(no_neighbour);
  const auto join = [&](std::uint32_t from, std::uint32_t to) {
    *std::find(neighbours[from].begin(), neighbours[from].end(), no_neighbour) = to;
  };
  for (std::size_t i = 0; i < sides.size(); ++i) {
    if (!is_shared(sides, i)) continue;
    join(sides[i].tetrahedron, sides[i + 1].tetrahedron);
    join(sides[i + 1].tetrahedron, sides[i].tetrahedron);
  }
  return neighbours;
}

SolidBody largest_body(std::span<const Tetrahedron> tetrahedra, std::span<const Neighbours> neighbours,
                       std::size_t count) {
  std::uint32_t highest = 0;
  for (const Tetrahedron& t : tetrahedra.first(count))
    highest = std::max(highest, *std::max_element(t.begin(), t.end()));
  std::vector<std::uint32_t> last_visit(highest + 1, no_neighbour);  // of a point, by the body's first tetrahedron
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
      for (const std::uint32_t other : neighbours[body.tetrahedra[next]]) {
        if (other >= count || reached[other]) continue;
        reached[other] = true;
        body.tetrahedra.push_back(other);
      }
    }
    if (body.points > best.points) best = std::move(body);
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
