// SPDX-License-Identifier: Apache-2.0
// The only file that includes CGAL: it compiles slowly, and its triangulations are under the GPL.
#include "robots/exact_geometry.h"

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Delaunay_triangulation_cell_base_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Exact_rational.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Triangulation_cell_base_with_info_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

namespace mercury {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Vertex = CGAL::Triangulation_vertex_base_with_info_3<std::uint32_t, Kernel>;
using Cell =
    CGAL::Triangulation_cell_base_with_info_3<std::uint32_t, Kernel, CGAL::Delaunay_triangulation_cell_base_3<Kernel>>;
using Delaunay = CGAL::Delaunay_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<Vertex, Cell>>;
using Exact = CGAL::Simple_cartesian<CGAL::Exact_rational>;

std::strong_ordering ordering(CGAL::Comparison_result result) { return static_cast<int>(result) <=> 0; }

}  // namespace

struct ExactSquaredRadius::Fraction {
  CGAL::Exact_rational value;
};

ExactSquaredRadius::ExactSquaredRadius(std::span<const Vec3> points, const Tetrahedron& t) {
  const auto exact = [&](std::uint32_t i) { return Exact::Point_3(points[i].x, points[i].y, points[i].z); };
  value_ = std::make_shared<const Fraction>(
      Fraction{CGAL::squared_radius(exact(t[0]), exact(t[1]), exact(t[2]), exact(t[3]))});
}

Bounds ExactSquaredRadius::bounds() const {
  const auto [low, high] = CGAL::to_interval(value_->value);
  return {low, high};
}

std::strong_ordering ExactSquaredRadius::compare(const ExactSquaredRadius& other) const {
  return ordering(CGAL::compare(value_->value, other.value_->value));
}

std::strong_ordering ExactSquaredRadius::compare(double other) const {
  return ordering(CGAL::compare(value_->value, CGAL::Exact_rational(other)));
}

Triangulation triangulate(std::span<const Vec3> points) {
  std::vector<std::pair<Kernel::Point_3, std::uint32_t>> indexed;
  indexed.reserve(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i)
    indexed.emplace_back(Kernel::Point_3(points[i].x, points[i].y, points[i].z), i);
  Delaunay delaunay(indexed.begin(), indexed.end());
  Triangulation result;
  if (delaunay.dimension() < 3) return result;
  std::uint32_t count = 0;
  for (auto cell = delaunay.all_cells_begin(); cell != delaunay.all_cells_end(); ++cell)
    cell->info() = delaunay.is_infinite(cell) ? no_neighbour : count++;
  result.tetrahedra.reserve(count);
  result.neighbours.reserve(count);
  for (auto cell = delaunay.all_cells_begin(); cell != delaunay.all_cells_end(); ++cell) {
    if (cell->info() == no_neighbour) continue;
    Tetrahedron t;
    Neighbours n;
    for (int i = 0; i < 4; ++i) {
      t[static_cast<std::size_t>(i)] = cell->vertex(i)->info();
      n[static_cast<std::size_t>(i)] = cell->neighbor(i)->info();
    }
    result.tetrahedra.push_back(t);
    result.neighbours.push_back(n);
  }
  return result;
}

}  // namespace mercury
