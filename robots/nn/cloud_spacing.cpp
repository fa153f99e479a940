// SPDX-License-Identifier: Apache-2.0
#include "robots/nn/cloud_spacing.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace mercury {
namespace {

constexpr double push_reach = 2;  // of the pushes, by the distance
constexpr int push_steps = 3;
constexpr double push_share = 0.3;  // of what is missing to that reach, per point and step

struct Offset {
  double x = 0, y = 0, z = 0;
};

Offset between(const Vec3& a, const Vec3& b) {
  return {static_cast<double>(a.x) - static_cast<double>(b.x), static_cast<double>(a.y) - static_cast<double>(b.y),
          static_cast<double>(a.z) - static_cast<double>(b.z)};
}

double squared(const Offset& v) { return v.x * v.x + v.y * v.y + v.z * v.z; }

// By Newton's method: those of libraries are not rounded alike everywhere.
double cube_root(double x) {
  if (!(x > 0)) return 0;
  int exponent = 0;
  std::frexp(x, &exponent);
  double root = std::ldexp(1, (exponent + 2) / 3);
  for (int i = 0; i < 8; ++i) root = (2 * root + x / (root * root)) / 3;
  return root;
}

// Points by the cell that they are in. Cells are at least as wide as a distance, so that all points nearer than it are
// in a point's own cell and those around it.
class Grid {
 public:
  Grid(double distance, std::size_t points) {
    const double most = std::cbrt(32 * static_cast<double>(points));  // for memory alone; the result is the same
    cells_ = std::max(1, static_cast<int>(std::min(1.999 / distance, most)));
    const auto n = static_cast<std::size_t>(cells_);
    first_.assign(n * n * n, none);
    next_.reserve(points);
    places_.reserve(points);
  }

  void add(const Vec3& place) {
    std::uint32_t& first = first_[index(cell(place.x), cell(place.y), cell(place.z))];
    next_.push_back(first);
    first = static_cast<std::uint32_t>(places_.size());
    places_.push_back(place);
  }
  // Visits the points in the cells around a place until visit(place) returns false.
  template <class Visit>
  bool visit_around(const Vec3& place, Visit visit) const {
    const int x = cell(place.x), y = cell(place.y), z = cell(place.z);
    for (int k = std::max(0, z - 1); k <= std::min(cells_ - 1, z + 1); ++k)
      for (int j = std::max(0, y - 1); j <= std::min(cells_ - 1, y + 1); ++j)
        for (int i = std::max(0, x - 1); i <= std::min(cells_ - 1, x + 1); ++i)
          for (std::uint32_t p = first_[index(i, j, k)]; p != none; p = next_[p])
            if (!visit(places_[p])) return false;
    return true;
  }

 private:
  static constexpr std::uint32_t none = 0xffffffff;
  int cell(float x) const {
    return std::clamp(static_cast<int>((static_cast<double>(x) + 1) / 2 * cells_), 0, cells_ - 1);
  }
  std::size_t index(int x, int y, int z) const {
    const auto n = static_cast<std::size_t>(cells_);
    return static_cast<std::size_t>(x) + n * (static_cast<std::size_t>(y) + n * static_cast<std::size_t>(z));
  }

  int cells_ = 1;  // along each axis
  std::vector<std::uint32_t> first_, next_;
  std::vector<Vec3> places_;
};

// A point, or a pair of them.
struct Unit {
  SpreadPoint first, twin;
  bool is_pair = false;
};

void thin(std::vector<Unit>& units, double distance) {
  const auto too_near = [&](const Vec3& a, const Vec3& b) { return squared(between(a, b)) < distance * distance; };
  for (Unit& unit : units) {
    if (!unit.is_pair || !too_near(unit.first.place, unit.twin.place)) continue;
    unit.first.place = 0.5f * (unit.first.place + unit.twin.place);
    unit.is_pair = false;
  }
  std::vector<std::pair<double, std::size_t>> outermost;
  for (std::size_t i = 0; i < units.size(); ++i) outermost.emplace_back(-squared(between(units[i].first.place, {})), i);
  std::ranges::sort(outermost);
  Grid kept(distance, 2 * units.size());
  std::vector<bool> stays(units.size(), false);
  const auto is_free = [&](const Vec3& place) {
    return kept.visit_around(place, [&](const Vec3& other) { return !too_near(place, other); });
  };
  for (const auto& [order, i] : outermost) {
    const Unit& unit = units[i];
    if (!is_free(unit.first.place) || (unit.is_pair && !is_free(unit.twin.place))) continue;
    stays[i] = true;
    kept.add(unit.first.place);
    if (unit.is_pair) kept.add(unit.twin.place);
  }
  std::size_t next = 0;
  for (std::size_t i = 0; i < units.size(); ++i)
    if (stays[i]) units[next++] = units[i];
  units.resize(next);
}

template <class Visit>
void for_each_point(std::vector<Unit>& units, Visit visit) {
  for (Unit& unit : units) {
    visit(unit.first);
    if (unit.is_pair) visit(unit.twin);
  }
}

void push_apart(std::vector<Unit>& units, double reach) {
  Grid grid(reach, 2 * units.size());
  for_each_point(units, [&](SpreadPoint& point) { grid.add(point.place); });
  for_each_point(units, [&](SpreadPoint& point) {
    Offset push;
    grid.visit_around(point.place, [&](const Vec3& other) {
      const Offset away = between(point.place, other);
      const double now = squared(away);
      if (now < reach * reach && now > 0) {
        const double share = push_share * (reach / std::sqrt(now) - 1);
        push = {push.x + share * away.x, push.y + share * away.y, push.z + share * away.z};
      }
      return true;
    });
    const auto moved = [](float x, double by) { return std::clamp(static_cast<float>(x + by), -1.f, 1.f); };
    point.place = {moved(point.place.x, push.x), moved(point.place.y, push.y), moved(point.place.z, push.z)};
  });
}

}  // namespace

double mean_spacing(std::span<const Vec3> places) {
  const auto n = static_cast<double>(places.size());
  Offset mean;
  for (const Vec3& p : places) mean = {mean.x + p.x, mean.y + p.y, mean.z + p.z};
  mean = {mean.x / n, mean.y / n, mean.z / n};
  double xx = 0, yy = 0, zz = 0, xy = 0, yz = 0, zx = 0;
  for (const Vec3& p : places) {
    const double x = p.x - mean.x, y = p.y - mean.y, z = p.z - mean.z;
    xx += x * x, yy += y * y, zz += z * z, xy += x * y, yz += y * z, zx += z * x;
  }
  const double determinant = xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * zx) + zx * (xy * yz - yy * zx);
  // A solid ellipsoid has the variance a^2 / 5 along its half axis a.
  const double product_of_half_axes = std::sqrt(std::max(0.0, 125 * determinant / (n * n * n)));
  return cube_root(4 * std::numbers::pi / 3 * product_of_half_axes / n);
}

std::vector<SpreadPoint> spread(std::span<const Vec3> places, bool in_pairs, double distance) {
  std::vector<Unit> units;
  units.reserve(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    units.push_back({.first = {i, places[i]}});
    if (!in_pairs || i + 1 == places.size()) continue;
    ++i;
    units.back().twin = {i, places[i]};
    units.back().is_pair = true;
  }
  thin(units, distance);
  for (int step = 0; step < push_steps; ++step) push_apart(units, push_reach * distance);
  thin(units, distance);
  std::vector<SpreadPoint> points;
  for_each_point(units, [&](const SpreadPoint& point) { points.push_back(point); });
  return points;
}

}  // namespace mercury
