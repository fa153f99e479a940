// SPDX-License-Identifier: Apache-2.0
// How the tetrahedra of an alpha shape are found without computing a single radius exactly, as a rule:
//
//   squared radii, each between two bounds      --[-]-[--]----[-]---[-----]---[-]---->
//   classes: bounds that overlap                  [    1 ]    [2]   [  3        ]
//
// All radii of a class are smaller than those of the next one, so a class is either inside or outside of an alpha shape
// as long as alpha does not fall into it. Only the class that decides is split exactly. In a mirrored body it holds a
// tetrahedron and its mirror image, whose radii are equal.

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "mercury/error.h"
#include "robots/nn/exact_geometry.h"
#include "robots/nn/tetrahedra.h"

namespace mercury {
namespace {

struct SortEntry {
  double number;  // at least 0
  std::uint32_t index;
};

// The number rounded down to 44 bits, 32 of them after the leading one: what radix_sort() looks at.
double rounded_down(double number) {
  return std::bit_cast<double>(std::bit_cast<std::uint64_t>(number) & ~std::uint64_t{0xfffff});
}

// Sorts by rounded_down(number), by counting digits: no branch depends on the numbers. Equals keep their order. `spare`
// is memory.
void radix_sort(std::vector<SortEntry>& entries, std::vector<SortEntry>& spare) {
  constexpr int digit_bits = 11, digits = 4, lowest_bit = 64 - digits * digit_bits;
  constexpr std::size_t values = 1 << digit_bits;
  // Positive floating-point numbers are in the order of their bits.
  const auto digit_of = [](const SortEntry& e, int digit) {
    return std::bit_cast<std::uint64_t>(e.number) >> (lowest_bit + digit * digit_bits) & (values - 1);
  };
  std::array<std::array<std::uint32_t, values>, digits> begins{};
  for (const SortEntry& e : entries)
    for (int digit = 0; digit < digits; ++digit) ++begins[static_cast<std::size_t>(digit)][digit_of(e, digit)];
  spare.resize(entries.size());
  for (int digit = 0; digit < digits; ++digit) {
    auto& begin = begins[static_cast<std::size_t>(digit)];
    std::exclusive_scan(begin.begin(), begin.end(), begin.begin(), 0u);
    for (const SortEntry& e : entries) spare[begin[digit_of(e, digit)]++] = e;
    entries.swap(spare);
  }
}

// The tetrahedra of a triangulation, from the smallest circumscribed sphere to the largest.
class Filtration {
 public:
  // Returns false if all points lie in one plane.
  bool start(std::span<const Vec3> points) {
    points_ = points;
    triangulate(points, all_);
    if (all_.tetrahedra.empty()) return false;
    sort();
    return true;
  }

  // Number of tetrahedra with a squared radius of at most that.
  std::uint32_t count_within(double squared_alpha) {
    for (std::size_t k = 0; k < classes_.size(); ++k) {
      if (classes_[k].bounds.high <= squared_alpha) continue;
      if (classes_[k].bounds.low > squared_alpha) return begin_of(k);
      split(k);
      if (exact(begin_of(k)).compare(squared_alpha) > 0) return begin_of(k);
    }
    return classes_.back().end;
  }

  // Number of tetrahedra in the smallest alpha shape of which a body holds all points. Such a body only grows with
  // alpha, so a search that halves finds it. It is mostly near the first alpha shape that has all points in it.
  std::uint32_t count_for_all_points() {
    const auto [last_point, its_first] = last_to_come();
    std::size_t first = class_of(its_first), last = classes_.size() - 1;
    const std::uint32_t begin = begin_of(first);
    UnionFind before;  // the bodies of the classes before `first`
    before.parent.reserve(all_.tetrahedra.size());
    const auto search = [&, last_point = last_point] {
      for (std::size_t stride = 1; first < last; stride *= 2) {
        const std::size_t probe = std::min(first + stride - 1, first + (last - first) / 2);
        UnionFind bodies = before;
        join(bodies, classes_[probe].end);
        if (has_body_of_all(bodies, last_point, begin)) {
          last = probe;
        } else {
          first = probe + 1;
          before = std::move(bodies);
        }
      }
    };
    search();
    last += split(first) - 1;
    search();
    return classes_[first].end;
  }

  // The body with most points that the first `count` tetrahedra form; of equal ones the one with the smallest sphere.
  SolidBody largest_body(std::uint32_t count) {
    for (;;) {
      SolidBody body = mercury::largest_body(all_.tetrahedra, all_.neighbors, count);
      if (body.rival == no_neighbor) return body;
      const std::size_t k = class_of(body.tetrahedra.front());
      if (classes_[k].is_exact || class_of(body.rival) != k) return body;
      split(k);  // it holds the smallest spheres of both
    }
  }

  // Largest radius of the first `count` tetrahedra, rounded.
  double radius(std::uint32_t count) const {
    const Bounds squared = classes_[class_of(count - 1)].bounds;
    return std::sqrt((squared.low + squared.high) / 2);
  }

  // The tetrahedra of a body, and their neighbors in it.
  void copy(const SolidBody& body, std::vector<Tetrahedron>& tetrahedra, std::vector<Neighbors>& neighbors) const {
    std::vector<std::uint32_t> index_of(all_.tetrahedra.size(), no_neighbor);
    for (std::uint32_t i = 0; i < body.tetrahedra.size(); ++i) index_of[body.tetrahedra[i]] = i;
    tetrahedra.reserve(body.tetrahedra.size());
    neighbors.reserve(body.tetrahedra.size());
    for (const std::uint32_t i : body.tetrahedra) {
      tetrahedra.push_back(all_.tetrahedra[i]);
      Neighbors n = all_.neighbors[i];
      for (std::uint32_t& other : n)
        if (other != no_neighbor) other = index_of[other];
      neighbors.push_back(n);
    }
  }

 private:
  struct Class {
    std::uint32_t end = 0;  // of its tetrahedra; they begin where those of the class before end
    Bounds bounds;          // of the squared radii
    bool is_exact = false;  // all radii are equal, the tetrahedra are sorted by their points
  };

  std::uint32_t begin_of(std::size_t k) const { return k == 0 ? 0 : classes_[k - 1].end; }
  std::size_t class_of(std::uint32_t tetrahedron) const {
    return static_cast<std::size_t>(
        std::ranges::upper_bound(classes_, tetrahedron, {}, [](const Class& c) { return c.end; }) - classes_.begin());
  }
  ExactSquaredRadius exact(std::uint32_t i) const { return {points_, all_.tetrahedra[i]}; }

  void sort() {
    bounds_.clear();
    by_low_bound_.clear();
    for (std::uint32_t i = 0; i < all_.tetrahedra.size(); ++i) {
      const auto& [a, b, c, d] = all_.tetrahedra[i];
      Bounds squared = squared_circumradius(points_[a], points_[b], points_[c], points_[d]);
      if (!std::isfinite(squared.high)) squared = exact(i).bounds();
      squared.low = rounded_down(squared.low);
      bounds_.push_back(squared);
      by_low_bound_.push_back({squared.low, i});
    }
    radix_sort(by_low_bound_, spare_);
    classes_.clear();
    order_.clear();
    for (const auto& [low, index] : by_low_bound_) {
      const Bounds& next = bounds_[index];
      if (classes_.empty() || next.low > classes_.back().bounds.high)
        classes_.push_back({.bounds = next});
      else
        classes_.back().bounds.high = std::max(classes_.back().bounds.high, next.high);
      order_.push_back(index);
      classes_.back().end = static_cast<std::uint32_t>(order_.size());
    }
    reorder(order_, 0);
  }

  // Puts tetrahedron order[i] at first + i.
  void reorder(std::span<const std::uint32_t> order, std::uint32_t first) {
    moved_to_.resize(order.size());
    reordered_.tetrahedra.clear();
    reordered_.neighbors.clear();
    for (std::uint32_t i = 0; i < order.size(); ++i) {
      moved_to_[order[i] - first] = first + i;
      reordered_.tetrahedra.push_back(all_.tetrahedra[order[i]]);
      reordered_.neighbors.push_back(all_.neighbors[order[i]]);
    }
    if (order.size() == all_.tetrahedra.size()) {
      std::swap(all_, reordered_);
    } else {
      std::ranges::copy(reordered_.tetrahedra, all_.tetrahedra.begin() + first);
      std::ranges::copy(reordered_.neighbors, all_.neighbors.begin() + first);
    }
    for (Neighbors& n : all_.neighbors)
      for (std::uint32_t& other : n)
        if (other - first < order.size()) other = moved_to_[other - first];
  }

  // Splits a class into classes of equal radii. Returns their number.
  std::size_t split(std::size_t k) {
    const std::uint32_t begin = begin_of(k), end = classes_[k].end;
    if (classes_[k].is_exact || end - begin == 1) return 1;
    struct Entry {
      ExactSquaredRadius radius;
      Tetrahedron points;
      std::uint32_t index;
    };
    std::vector<Entry> entries;
    for (std::uint32_t i = begin; i < end; ++i) entries.push_back({exact(i), lowest_first(all_.tetrahedra[i]), i});
    std::ranges::sort(entries, [](const Entry& a, const Entry& b) {
      const auto order = a.radius.compare(b.radius);
      return order != 0 ? order < 0 : a.points < b.points;
    });
    std::vector<Class> parts;
    std::vector<std::uint32_t> order;
    for (std::size_t i = 0; i < entries.size(); ++i) {
      if (i == 0 || entries[i].radius.compare(entries[i - 1].radius) != 0)
        parts.push_back({.bounds = entries[i].radius.bounds(), .is_exact = true});
      order.push_back(entries[i].index);
      parts.back().end = begin + static_cast<std::uint32_t>(order.size());
    }
    reorder(order, begin);
    const auto place = classes_.erase(classes_.begin() + static_cast<std::ptrdiff_t>(k));
    classes_.insert(place, parts.begin(), parts.end());
    return parts.size();
  }

  // The points come in one after another, each with its first tetrahedron: the last point, and a tetrahedron of the
  // class that has its first one.
  std::pair<std::uint32_t, std::uint32_t> last_to_come() const {
    std::vector<bool> seen(points_.size(), false);
    std::pair<std::uint32_t, std::uint32_t> last;
    for (std::uint32_t i = 0; i < all_.tetrahedra.size(); ++i)
      for (const std::uint32_t point : all_.tetrahedra[i]) {
        if (!seen[point]) last = {point, i};
        seen[point] = true;
      }
    return last;
  }

  // The bodies of the first tetrahedra, joined side to side.
  struct UnionFind {
    std::vector<std::uint32_t> parent;
    std::uint32_t root(std::uint32_t i) {
      while (parent[i] != i) i = parent[i] = parent[parent[i]];
      return i;
    }
  };

  void join(UnionFind& bodies, std::uint32_t end) const {
    for (auto i = static_cast<std::uint32_t>(bodies.parent.size()); i < end; ++i) {
      bodies.parent.push_back(i);
      std::uint32_t root = i;
      for (const std::uint32_t other : all_.neighbors[i]) {
        if (other >= i) continue;
        const std::uint32_t others_root = bodies.root(other);
        bodies.parent[std::max(root, others_root)] = std::min(root, others_root);
        root = std::min(root, others_root);
      }
    }
  }

  // A body of all points has the last point in it, so only the bodies around that point can be one. Its tetrahedra do
  // not come before `begin`.
  bool has_body_of_all(UnionFind& bodies, std::uint32_t last_point, std::uint32_t begin) const {
    const auto count = static_cast<std::uint32_t>(bodies.parent.size());
    for (std::uint32_t& parent : bodies.parent) parent = bodies.parent[parent];  // now all are roots: they come first
    std::vector<std::uint32_t> tried;
    for (std::uint32_t i = begin; i < count; ++i) {
      if (std::ranges::find(all_.tetrahedra[i], last_point) == all_.tetrahedra[i].end()) continue;
      const std::uint32_t body = bodies.parent[i];
      if (std::ranges::find(tried, body) != tried.end()) continue;
      tried.push_back(body);
      std::vector<char> held(points_.size(), 0);
      for (std::uint32_t k = 0; k < count; ++k)
        if (bodies.parent[k] == body)
          for (const std::uint32_t point : all_.tetrahedra[k]) held[point] = 1;
      if (std::ranges::find(held, 0) == held.end()) return true;
    }
    return false;
  }

  std::span<const Vec3> points_;
  Triangulation all_, reordered_;
  std::vector<Class> classes_;
  std::vector<Bounds> bounds_;  // while sorting
  std::vector<SortEntry> by_low_bound_, spare_;
  std::vector<std::uint32_t> order_, moved_to_;
};

}  // namespace

AlphaBody alpha_body(std::span<const Vec3> points, double alpha) {
  static thread_local Filtration kept;  // its memory
  Filtration own;
  Filtration& filtration = points.size() > small_cloud ? own : kept;
  if (!filtration.start(points)) throw InputError("cloud", "its points lie in one plane, they span no body");
  const std::uint32_t count = alpha > 0 ? filtration.count_within(alpha * alpha) : filtration.count_for_all_points();
  if (count == 0) throw InputError("alpha", "no tetrahedron of the cloud is as small as the given radius");
  AlphaBody result{alpha > 0 ? alpha : filtration.radius(count), {}, {}};
  filtration.copy(filtration.largest_body(count), result.tetrahedra, result.neighbors);
  return result;
}

}  // namespace mercury
