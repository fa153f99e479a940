// SPDX-License-Identifier: Apache-2.0
// Points are inserted one after another (Bowyer 1981, Watson 1981):
//
//   1. Walk to the tetrahedron that holds the new point.
//   2. From there, collect all tetrahedra in whose circumscribed sphere the point lies. They form a cavity.
//   3. Replace them by tetrahedra that join the point to the sides of the cavity.
//
// A vertex at infinity closes the triangulation: its cells stand behind the sides of the convex hull, so that every
// cell has four neighbors and a point outside of the hull is no special case. The "sphere" of such a cell is the half
// space beyond its side.
//
// Each thread keeps its arrays for the next cloud: a triangulation of 500 points makes 13,000 cells.
#include "robots/nn/tetrahedra.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "robots/nn/predicates.h"

namespace mercury {
namespace {

constexpr std::uint32_t infinite = 0xffffffff;  // the vertex at infinity
constexpr std::uint32_t none = 0xffffffff;      // no cell

struct Cell {
  Tetrahedron corners;                     // of positive orientation; one may be infinite
  std::array<std::uint32_t, 4> neighbors;  // neighbor i is opposite to corner i
};

// 4 = no corner
std::size_t corner_at_infinity(const Cell& cell) {
  std::size_t i = 0;
  while (i < 4 && cell.corners[i] != infinite) ++i;
  return i;
}

// Position of a value that is in the list, without a branch.
std::uint32_t position_of(std::uint32_t value, const std::array<std::uint32_t, 4>& in) {
  const std::uint32_t is_1 = in[1] == value, is_2 = in[2] == value, is_3 = in[3] == value;
  return (is_1 | is_3) + 2 * (is_2 | is_3);
}

// The edges of the side opposite to a corner, all in the same sense of rotation, each with the third corner of the
// side.
struct EdgeOfSide {
  std::uint32_t opposite, from, to;
};
constexpr EdgeOfSide edges_of_side[4][3] = {{{1, 2, 3}, {2, 3, 1}, {3, 1, 2}},
                                            {{0, 3, 2}, {3, 2, 0}, {2, 0, 3}},
                                            {{0, 1, 3}, {1, 3, 0}, {3, 0, 1}},
                                            {{0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};

class Builder {
 public:
  // Returns false if all points lie in one plane.
  [[gnu::noinline]] bool build(std::span<const Vec3> points) {
    points_.assign(points.begin(), points.end());
    errors_ = errors_in_box();
    cells_.clear();
    marks_.clear();
    free_.clear();
    number_of_.assign(points.size() + 1, 0);
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

  void copy_to(Triangulation& result) {
    index_of_.assign(cells_.size(), no_neighbor);
    std::uint32_t count = 0;
    for (std::uint32_t c = 0; c < cells_.size(); ++c)
      if (marks_[c] != unused && corner_at_infinity(cells_[c]) == 4) index_of_[c] = count++;
    for (std::uint32_t c = 0; c < cells_.size(); ++c) {
      if (index_of_[c] == no_neighbor) continue;
      result.tetrahedra.push_back(cells_[c].corners);
      Neighbors& neighbors = result.neighbors.emplace_back();
      for (std::size_t i = 0; i < 4; ++i) neighbors[i] = index_of_[cells_[c].neighbors[i]];
    }
  }

 private:
  struct Side {
    std::uint32_t cell;  // in the cavity; its neighbor there is the outer cell, then the new cell
    std::uint32_t corner;
  };
  static constexpr std::uint32_t unused = 0;  // mark of a cell

  RoundingErrors errors_in_box() const {
    if (points_.empty()) return {0, 0, 0};
    ExactPoint low = points_[0], high = points_[0];
    for (const ExactPoint& p : points_) {
      low.x = std::min(low.x, p.x), low.y = std::min(low.y, p.y), low.z = std::min(low.z, p.z);
      high.x = std::max(high.x, p.x), high.y = std::max(high.y, p.y), high.z = std::max(high.z, p.z);
    }
    return errors_of(high - low);
  }

  // Four points that lie in no plane, of positive orientation; the last one is `none` if there are no such points.
  std::array<std::uint32_t, 4> spanning_points() const {
    std::array<std::uint32_t, 4> found = {0, none, none, none};
    const auto at = [&](std::uint32_t i) -> const ExactPoint& { return points_[i]; };
    for (std::uint32_t i = 1; i < points_.size(); ++i) {
      if (found[1] == none) {
        if (at(i) != at(0)) found[1] = i;
      } else if (found[2] == none) {
        if (!are_exactly_collinear(at(0).as_floats(), at(found[1]).as_floats(), at(i).as_floats())) found[2] = i;
      } else if (const int side = orientation(at(0), at(found[1]), at(found[2]), at(i), errors_); side != 0) {
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
      for (std::uint32_t m = 0; m < 4; ++m) outer.neighbors[m] = m == i ? 0 : m + 1;
      std::swap(outer.corners[j], outer.corners[k]);
      std::swap(outer.neighbors[j], outer.neighbors[k]);
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

  int orientation_with(const Cell& cell, std::size_t corner, const ExactPoint& point) const {
    const auto at = [&](std::size_t i) -> const ExactPoint& { return i == corner ? point : points_[cell.corners[i]]; };
    return orientation(at(0), at(1), at(2), at(3), errors_);
  }

  // A cell that holds the point or has it beyond its side of the hull. The walk steps toward the point through any
  // side that has it on the other side; in a Delaunay triangulation it ends.
  std::uint32_t locate(const ExactPoint& point) const {
    std::uint32_t cell = hint_, last = none;
    for (;;) {
      const Cell& here = cells_[cell];
      if (corner_at_infinity(here) < 4) return cell;
      std::uint32_t next = none;
      for (std::size_t i = 0; i < 4 && next == none; ++i)
        if (here.neighbors[i] != last && orientation_with(here, i, point) < 0) next = here.neighbors[i];
      if (next == none) return cell;
      last = std::exchange(cell, next);
    }
  }

  // Not inline: that would push the loop of find_cavity() out of the registers.
  [[gnu::noinline]] bool in_conflict(std::uint32_t index, const ExactPoint& point) const {
    const Cell& cell = cells_[index];
    const std::size_t outer = corner_at_infinity(cell);
    if (outer == 4) {
      const auto& [a, b, c, d] = cell.corners;
      return is_in_sphere(points_[a], points_[b], points_[c], points_[d], point, errors_);
    }
    if (const int side = orientation_with(cell, outer, point); side != 0) return side > 0;
    // In the plane of the side, the sphere of the cell before it cuts out the circle through the side.
    return in_conflict(cell.neighbors[outer], point);
  }

  void insert(std::uint32_t index) {
    const ExactPoint point = points_[index];
    const std::uint32_t start = locate(point);
    for (const std::uint32_t corner : cells_[start].corners)
      if (corner != infinite && points_[corner] == point) return;
    find_cavity(start, point);
    fill_cavity(index);
  }

  // What a cell turns out to be decides no branch here, since no processor could predict it.
  void find_cavity(std::uint32_t start, const ExactPoint& point) {
    ++mark_;
    const std::uint32_t outside = 2 * mark_, inside = outside + 1;
    marks_[start] = inside;
    std::size_t cells = 1, sides = 0;
    cavity_.resize(std::max<std::size_t>(cavity_.size(), 64));
    sides_.resize(std::max<std::size_t>(sides_.size(), 64));
    cavity_[0] = start;
    const Cell* const all = cells_.data();
    std::uint32_t* const marks = marks_.data();
    for (std::size_t k = 0; k < cells; ++k) {
      if (cavity_.size() < cells + 4) cavity_.resize(2 * cavity_.size());
      if (sides_.size() < sides + 4) sides_.resize(2 * sides_.size());
      const std::uint32_t cell = cavity_[k];
      for (std::uint32_t i = 0; i < 4; ++i) {
        const std::uint32_t other = all[cell].neighbors[i];
        if (marks[other] < outside) {
          const auto joins = static_cast<std::uint32_t>(in_conflict(other, point));
          marks[other] = outside + joins;
          cavity_[cells] = other;
          cells += joins;
        }
        sides_[sides] = {cell, i};
        sides += marks[other] == outside ? 1 : 0;
      }
    }
    cavity_size_ = cells;
    sides_size_ = sides;
  }

  // Each new cell is a cell of the cavity with the point in place of one corner, so its orientation is positive.
  void fill_cavity(std::uint32_t point) {
    const std::span sides = std::span(sides_).first(sides_size_);
    for (const Side& side : sides) {
      const std::uint32_t cell = new_cell();
      Cell& old = cells_[side.cell];
      Cell& outer = cells_[old.neighbors[side.corner]];
      outer.neighbors[position_of(side.cell, outer.neighbors)] = cell;
      Cell& here = cells_[cell];
      here = {old.corners, {none, none, none, none}};
      here.corners[side.corner] = point;
      here.neighbors[side.corner] = std::exchange(old.neighbors[side.corner], cell);
      marks_[cell] = 2 * mark_;
      if (corner_at_infinity(here) == 4) hint_ = cell;
    }
    if (sides_size_ / 2 + 2 <= max_local)
      join_by_table(sides);
    else
      for (const Side& side : sides)
        for (const auto& [opposite, from, to] : edges_of_side[side.corner]) join_around_edge(side, opposite);
    const std::span cavity = std::span(cavity_).first(cavity_size_);
    for (const std::uint32_t cell : cavity) marks_[cell] = unused;
    free_.insert(free_.end(), cavity.begin(), cavity.end());
  }

  // Two new cells are neighbors where their sides of the cavity share an edge, which they run through in opposite
  // directions. The corners of a small cavity have numbers below max_local, which find the edges in a table.
  void join_by_table(std::span<const Side> sides) {
    std::uint32_t next = 0;
    numbers_.resize(sides.size());
    Cell* const cells = cells_.data();
    std::uint32_t* const number_of = number_of_.data();
    const auto outer_number = static_cast<std::uint32_t>(points_.size());
    const std::uint32_t first_number = mark_ * max_local;
    for (std::size_t k = 0; k < sides.size(); ++k) {
      const auto& [old_cell, corner] = sides[k];
      const Cell& old = cells[old_cell];
      const std::uint32_t cell = old.neighbors[corner];
      auto& numbers = numbers_[k];
      for (const auto& [opposite, from, to] : edges_of_side[corner]) {
        const std::uint32_t point = old.corners[opposite];
        std::uint32_t& known = number_of[point == infinite ? outer_number : point];
        const std::uint32_t is_new = known < first_number ? 1 : 0;
        known += is_new * (first_number + next - known);
        next += is_new;
        numbers[opposite] = known % max_local;
      }
      for (const auto& [opposite, from, to] : edges_of_side[corner])
        cell_at_edge_[numbers[from] * max_local + numbers[to]] = cell;
    }
    for (std::size_t k = 0; k < sides.size(); ++k) {
      const auto& [old_cell, corner] = sides[k];
      Cell& here = cells[cells[old_cell].neighbors[corner]];
      for (const auto& [opposite, from, to] : edges_of_side[corner])
        here.neighbors[opposite] = cell_at_edge_[numbers_[k][to] * max_local + numbers_[k][from]];
    }
  }

  // The same for any cavity. Turns around the edge of a side that
  // lacks corner `opposite`, through the cells of the cavity, until it comes to the other side.
  void join_around_edge(const Side& side, std::uint32_t opposite) {
    std::uint32_t cell = side.cell, behind = side.corner, ahead = opposite;  // the corners off the edge
    const std::uint32_t joined = cells_[cell].neighbors[behind];
    if (cells_[joined].neighbors[opposite] != none) return;
    for (;;) {
      const std::uint32_t next = cells_[cell].neighbors[ahead];
      if (marks_[next] != 2 * mark_ + 1) {  // new
        cells_[joined].neighbors[opposite] = next;
        cells_[next].neighbors[behind] = joined;
        return;
      }
      ahead = position_of(cells_[cell].corners[behind], cells_[next].corners);
      behind = position_of(cell, cells_[next].neighbors);
      cell = next;
    }
  }

  std::vector<ExactPoint> points_;
  RoundingErrors errors_{0, 0, 0};
  std::vector<Cell> cells_;
  std::vector<std::uint32_t>
      marks_;  // of cells: unused; 2 * number of the last insertion that looked at it, + 1 = cavity
  std::vector<std::uint32_t> free_;
  std::vector<std::uint32_t> cavity_;  // the first cavity_size_ elements
  std::vector<Side> sides_;            // of the cavity; the first sides_size_ elements
  std::size_t cavity_size_ = 0, sides_size_ = 0;
  std::vector<bool> inserted_;
  std::vector<std::uint32_t> index_of_;  // of a cell in the result
  static constexpr std::uint32_t max_local = 64;
  std::vector<std::array<std::uint32_t, 4>> numbers_;                // of the corners of the sides
  std::vector<std::uint32_t> number_of_;                             // of a point: mark_ * max_local + number
  std::array<std::uint32_t, max_local * max_local> cell_at_edge_{};  // by the numbers of its ends
  std::uint32_t mark_ = 0;                                           // number of the insertion
  std::uint32_t hint_ = 0;                                           // a finite cell near the last point
};

}  // namespace

void triangulate(std::span<const Vec3> points, Triangulation& result) {
  static thread_local Builder kept;
  Builder own;
  Builder& builder = points.size() > small_cloud ? own : kept;
  result.tetrahedra.clear();
  result.neighbors.clear();
  if (builder.build(points)) builder.copy_to(result);
}

Triangulation triangulate(std::span<const Vec3> points) {
  Triangulation result;
  triangulate(points, result);
  return result;
}

}  // namespace mercury
