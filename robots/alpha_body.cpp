// SPDX-License-Identifier: Apache-2.0
// The only file that includes CGAL: it compiles slowly, and its triangulations are under the GPL.
#include "robots/alpha_body.h"

#include <CGAL/Alpha_shape_3.h>
#include <CGAL/Alpha_shape_cell_base_3.h>
#include <CGAL/Alpha_shape_vertex_base_3.h>
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include <algorithm>
#include <cmath>

#include "mercury/error.h"

namespace mercury {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Exactly = CGAL::Tag_true;  // radii are compared exactly too
using IndexedVertex = CGAL::Triangulation_vertex_base_with_info_3<std::uint32_t, Kernel>;
using VertexBase = CGAL::Alpha_shape_vertex_base_3<Kernel, IndexedVertex, Exactly>;
using CellBase = CGAL::Alpha_shape_cell_base_3<Kernel, CGAL::Delaunay_triangulation_cell_base_3<Kernel>, Exactly>;
using Delaunay = CGAL::Delaunay_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<VertexBase, CellBase>>;
using AlphaShape = CGAL::Alpha_shape_3<Delaunay, Exactly>;
using SquaredRadius = AlphaShape::NT;

Delaunay triangulate(std::span<const Vec3> points) {
  std::vector<std::pair<Kernel::Point_3, std::uint32_t>> indexed;
  indexed.reserve(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i)
    indexed.emplace_back(Kernel::Point_3(points[i].x, points[i].y, points[i].z), i);
  return Delaunay(indexed.begin(), indexed.end());
}

// CGAL's cells have a positive volume. Even permutations keep it positive.
Tetrahedron lowest_first(AlphaShape::Cell_handle cell) {
  Tetrahedron t;
  for (int i = 0; i < 4; ++i) t[static_cast<std::size_t>(i)] = cell->vertex(i)->info();
  const auto lowest = std::min_element(t.begin(), t.end()) - t.begin();
  if (lowest == 1) t = {t[1], t[0], t[3], t[2]};
  if (lowest == 2) t = {t[2], t[3], t[0], t[1]};
  if (lowest == 3) t = {t[3], t[2], t[1], t[0]};
  std::rotate(t.begin() + 1, std::min_element(t.begin() + 1, t.end()), t.end());
  return t;
}

// The tetrahedra of a triangulation, from the smallest circumscribed sphere to the largest.
struct Filtration {
  std::vector<Tetrahedron> tetrahedra;
  std::vector<SquaredRadius> squared_radii;
  std::vector<Neighbours> neighbours;

  explicit Filtration(const AlphaShape& shape) {
    std::vector<std::pair<Tetrahedron, SquaredRadius>> cells;
    for (auto cell = shape.finite_cells_begin(); cell != shape.finite_cells_end(); ++cell)
      cells.emplace_back(lowest_first(cell), cell->get_alpha());
    std::sort(cells.begin(), cells.end(), [](const auto& a, const auto& b) {
      return a.second < b.second || (a.second == b.second && a.first < b.first);
    });
    for (const auto& [tetrahedron, squared_radius] : cells) {
      tetrahedra.push_back(tetrahedron);
      squared_radii.push_back(squared_radius);
    }
    neighbours = neighbours_of(tetrahedra);
  }

  // Number of tetrahedra inside the alpha shape.
  std::size_t inside(const SquaredRadius& squared_alpha) const {
    return static_cast<std::size_t>(std::upper_bound(squared_radii.begin(), squared_radii.end(), squared_alpha) -
                                    squared_radii.begin());
  }

  SolidBody body(std::size_t count) const { return largest_body(tetrahedra, neighbours, count); }

  // The smallest alpha at which a body holds that many points. Such a body only grows with alpha, so bisection finds
  // it.
  SquaredRadius smallest_alpha(std::size_t points) const {
    std::size_t first = 0, last = squared_radii.size() - 1;
    while (first < last) {
      const std::size_t middle = (first + last) / 2;
      if (body(inside(squared_radii[middle])).points >= points)
        last = middle;
      else
        first = middle + 1;
    }
    return squared_radii[first];
  }
};

}  // namespace

AlphaBody alpha_body(std::span<const Vec3> points, double alpha) {
  Delaunay triangulation = triangulate(points);
  if (triangulation.dimension() < 3) throw InputError("cloud", "its points lie in one plane, they span no body");
  const AlphaShape shape(triangulation, 0, AlphaShape::REGULARIZED);
  const Filtration filtration(shape);
  const SquaredRadius squared = alpha > 0 ? SquaredRadius(alpha * alpha) : filtration.smallest_alpha(points.size());
  const SolidBody body = filtration.body(filtration.inside(squared));
  if (body.tetrahedra.empty()) throw InputError("alpha", "no tetrahedron of the cloud is as small as the given radius");
  AlphaBody result{std::sqrt(CGAL::to_double(squared)), {}};
  for (const std::uint32_t index : body.tetrahedra) result.tetrahedra.push_back(filtration.tetrahedra[index]);
  std::sort(result.tetrahedra.begin(), result.tetrahedra.end());
  return result;
}

}  // namespace mercury
