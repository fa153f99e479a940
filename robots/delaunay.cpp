// SPDX-License-Identifier: Apache-2.0
// Points are inserted one after the other (Bowyer 1981, Watson 1981):
//
//   1. Walk to the tetrahedron that holds the new point.
//   2. From there, collect all tetrahedra in whose circumscribed sphere the point lies. They form a cavity.
//   3. Replace them by tetrahedra that join the point to the sides of the cavity.
//
// A vertex at infinity closes the triangulation: its cells stand behind the sides of the convex hull, so that every
// cell has four neighbours and a point outside of the hull is no special case. The "sphere" of such a cell is the half
// space beyond its side.
//
// Each thread keeps its arrays for the next cloud: a triangulation of 500 points makes 13,000 cells.
#include "robots/delaunay.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "robots/predicates.h"

namespace mercury {
namespace {

constexpr std::uint32_t infinite = 0xffffffff;  // the vertex at infinity
constexpr std::uint32_t none = 0xffffffff;      // no cell

class Builder {
 public:
  // Returns false if all points lie in one plane.
  bool build(std::span<const Vec3> points) {
    points_ = points;
    cells_.clear();
    marks_.clear();
    free_.clear();
    open_edges_.clear();
    const std::array<std::uint32_t, 4> first = spanning_points();
    if (first[3] == none) return false;
    begin(first);
    // Sparse points first, dense ones last, so that no cavity becomes large. Each round runs through space once.
    std::vector<bool>& inserted = inserted_;
    inserted.assign(points.size(), false);
    for (const std::uint32_t point : first) inserted[point] = true;
    const auto count = static_cast<std::uint32_t>(points.size());
    std::uint32_t stride = 1;
    while (stride < count / 16) stride *= 4;
    for (;; stride /= 4) {
      for (std::uint32_t point = 0; point < count; point += stride) {
        if (inserted[point]) continue;
        inserted[point] = true;
        insert(point);
      }
      if (stride == 1) return true;
    }
  }

  Triangulation result() const {
    std::vector<std::uint32_t> index_of(cells_.size(), no_neighbour);
    std::uint32_t count = 0;
    for (std::uint32_t c = 0; c < cells_.size(); ++c)
      if (marks_[c] != unused && corner_at_infinity(cells_[c]) == 4) index_of[c] = count++;
    Triangulation result;
    result.tetrahedra.reserve(count);
    result.neighbours.reserve(count);
    for (std::uint32_t c = 0; c < cells_.size(); ++c) {
      if (index_of[c] == no_neighbour) continue;
      result.tetrahedra.push_back(cells_[c].corners);
      Neighbours& neighbours = result.neighbours.emplace_back();
      for (std::size_t i = 0; i < 4; ++i) neighbours[i] = index_of[cells_[c].neighbours[i]];
    }
    return result;
  }

 private:
  struct Cell {
    Tetrahedron corners;  // of positive orientation; one may be infinite
    std::array<std::uint32_t, 4> neighbours;
  };
  struct Side {
    std::uint32_t cell;  // in the cavity
    std::uint32_t corner;
  };
  struct OpenEdge {
    std::uint64_t corners = 0;
    std::uint32_t mark = 0;
    std::uint32_t cell_and_corner = 0;
  };
  static constexpr std::uint32_t unused = 0;  // mark of a cell

  // Four points that lie in no plane, of positive orientation; the last one is `none` if there are no such points.
  std::array<std::uint32_t, 4> spanning_points() const {
    std::array<std::uint32_t, 4> found = {0, none, none, none};
    const auto at = [&](std::uint32_t i) -> const Vec3& { return points_[i]; };
    for (std::uint32_t i = 1; i < points_.size(); ++i) {
      if (found[1] == none) {
        if (at(i) != at(0)) found[1] = i;
      } else if (found[2] == none) {
        if (!are_exactly_collinear(at(0), at(found[1]), at(i))) found[2] = i;
      } else if (const int side = orientation(at(0), at(found[1]), at(found[2]), at(i)); side != 0) {
        found[3] = i;
        if (side < 0) std::swap(found[1], found[2]);
        break;
      }
    }
    return found;
  }

  // The tetrahedron of four points, and a cell behind each of its sides.
  void begin(const Tetrahedron& corners) {
    for (std::size_t i = 0; i < 5; ++i) new_cell();
    cells_[0] = {corners, {1, 2, 3, 4}};
    for (std::uint32_t i = 0; i < 4; ++i) {
      Cell& outer = cells_[i + 1];
      outer = {corners, {}};
      outer.corners[i] = infinite;
      // A mirror image has the opposite orientation.
      const std::uint32_t j = (i + 1) % 4, k = (i + 2) % 4;
      for (std::uint32_t m = 0; m < 4; ++m) outer.neighbours[m] = m == i ? 0 : m + 1;
      std::swap(outer.corners[j], outer.corners[k]);
      std::swap(outer.neighbours[j], outer.neighbours[k]);
    }
    hint_ = 0;
    mark_ = 1;
    for (std::uint32_t& mark : marks_) mark = 2 * mark_;
  }

  std::uint32_t new_cell() {
    if (!free_.empty()) {
      const std::uint32_t cell = free_.back();
      free_.pop_back();
      return cell;
    }
    cells_.emplace_back();
    marks_.push_back(unused);
    return static_cast<std::uint32_t>(cells_.size() - 1);
  }

  // 4 = none of them
  static std::size_t corner_at_infinity(const Cell& cell) {
    std::size_t i = 0;
    while (i < 4 && cell.corners[i] != infinite) ++i;
    return i;
  }

  int orientation_with(const Cell& cell, std::size_t corner, const Vec3& point) const {
    const auto at = [&](std::size_t i) -> const Vec3& { return i == corner ? point : points_[cell.corners[i]]; };
    return orientation(at(0), at(1), at(2), at(3));
  }

  // A cell that holds the point or has it beyond its side of the hull. The walk steps towards the point through any
  // side that has it on the other side; in a Delaunay triangulation it ends.
  std::uint32_t locate(const Vec3& point) const {
    std::uint32_t cell = hint_, last = none;
    for (;;) {
      const Cell& here = cells_[cell];
      if (corner_at_infinity(here) < 4) return cell;
      std::uint32_t next = none;
      for (std::size_t i = 0; i < 4 && next == none; ++i)
        if (here.neighbours[i] != last && orientation_with(here, i, point) < 0) next = here.neighbours[i];
      if (next == none) return cell;
      last = std::exchange(cell, next);
    }
  }

  bool in_conflict(std::uint32_t index, const Vec3& point) const {
    const Cell& cell = cells_[index];
    const std::size_t outer = corner_at_infinity(cell);
    if (outer == 4) {
      const auto& [a, b, c, d] = cell.corners;
      return is_in_sphere(points_[a], points_[b], points_[c], points_[d], point);
    }
    if (const int side = orientation_with(cell, outer, point); side != 0) return side > 0;
    // In the plane of the side, the sphere of the cell before it cuts out the circle through the side.
    return in_conflict(cell.neighbours[outer], point);
  }

  void insert(std::uint32_t index) {
    const Vec3 point = points_[index];
    const std::uint32_t start = locate(point);
    for (const std::uint32_t corner : cells_[start].corners)
      if (corner != infinite && points_[corner] == point) return;
    find_cavity(start, point);
    fill_cavity(index);
  }

  void find_cavity(std::uint32_t start, const Vec3& point) {
    ++mark_;
    const std::uint32_t outside = 2 * mark_, inside = outside + 1;
    cavity_.assign(1, start);
    marks_[start] = inside;
    sides_.clear();
    for (std::size_t k = 0; k < cavity_.size(); ++k) {
      const std::uint32_t cell = cavity_[k];
      for (std::uint32_t i = 0; i < 4; ++i) {
        const std::uint32_t other = cells_[cell].neighbours[i];
        if (marks_[other] == inside) continue;
        if (marks_[other] != outside) {
          const bool joins = in_conflict(other, point);
          marks_[other] = joins ? inside : outside;
          if (joins) cavity_.push_back(other);
          if (joins) continue;
        }
        sides_.push_back({cell, i});
      }
    }
  }

  // Each new cell is a cell of the cavity with the point in place of one corner, so its orientation is positive. Two of
  // them are neighbours where their sides of the cavity share an edge.
  void fill_cavity(std::uint32_t point) {
    std::size_t room = 64;
    while (room < 4 * sides_.size()) room *= 2;
    if (open_edges_.size() < room) open_edges_.assign(room, {});
    for (const auto& [old_cell, corner] : sides_) {
      const std::uint32_t cell = new_cell();
      Cell& here = cells_[cell];
      here = cells_[old_cell];
      marks_[cell] = 2 * mark_;
      here.corners[corner] = point;
      Cell& outer = cells_[here.neighbours[corner]];
      *std::find(outer.neighbours.begin(), outer.neighbours.end(), old_cell) = cell;
      for (std::uint32_t i = 0; i < 4; ++i)
        if (i != corner) join_at_edge(cell, i, corner, room);
      if (corner_at_infinity(here) == 4) hint_ = cell;
    }
    for (const std::uint32_t cell : cavity_) marks_[cell] = unused;
    free_.insert(free_.end(), cavity_.begin(), cavity_.end());
  }

  // The side opposite to corner i, which holds the new point and an edge of the cavity's surface.
  void join_at_edge(std::uint32_t cell, std::uint32_t i, std::uint32_t point_corner, std::size_t room) {
    std::uint64_t low = infinite, high = 0;
    for (std::uint32_t k = 0; k < 4; ++k) {
      if (k == i || k == point_corner) continue;
      low = std::min<std::uint64_t>(low, cells_[cell].corners[k]);
      high = std::max<std::uint64_t>(high, cells_[cell].corners[k]);
    }
    const std::uint64_t key = low << 32 | high;
    for (std::size_t at = (key * 0x9e3779b97f4a7c15u) >> 40;; ++at) {
      OpenEdge& edge = open_edges_[at & (room - 1)];
      if (edge.mark != mark_) {
        edge = {key, mark_, cell * 4 + i};
        return;
      }
      if (edge.corners != key) continue;
      const std::uint32_t other = edge.cell_and_corner / 4;
      cells_[cell].neighbours[i] = other;
      cells_[other].neighbours[edge.cell_and_corner % 4] = cell;
      return;
    }
  }

  std::span<const Vec3> points_;
  std::vector<Cell> cells_;
  std::vector<std::uint32_t>
      marks_;  // of cells: unused; 2 * number of the last insertion that looked at it, + 1 = cavity
  std::vector<std::uint32_t> free_;
  std::vector<std::uint32_t> cavity_;
  std::vector<Side> sides_;  // of the cavity
  std::vector<OpenEdge> open_edges_;
  std::vector<bool> inserted_;
  std::uint32_t mark_ = 0;  // number of the insertion
  std::uint32_t hint_ = 0;  // a finite cell near the last point
};

}  // namespace

Triangulation triangulate(std::span<const Vec3> points) {
  constexpr std::size_t kept_for = 4096;  // points
  if (points.size() > kept_for) {
    Builder builder;
    return builder.build(points) ? builder.result() : Triangulation{};
  }
  static thread_local Builder builder;
  return builder.build(points) ? builder.result() : Triangulation{};
}

}  // namespace mercury
