// SPDX-License-Identifier: Apache-2.0
// The two questions of a Delaunay triangulation. Floating point answers where its error cannot change the sign, exact
// arithmetic elsewhere.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>

#include "mercury/vec3.h"
#include "robots/nn/exact_geometry.h"

namespace mercury {

// A point of single precision, whose differences and products are computed in double precision.
struct ExactPoint {
  double x, y, z;
  ExactPoint(const Vec3& p) : x(p.x), y(p.y), z(p.z) {}
  Vec3 as_floats() const { return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)}; }
  friend bool operator==(const ExactPoint&, const ExactPoint&) = default;
  friend auto operator<=>(const ExactPoint&, const ExactPoint&) = default;
  friend ExactPoint operator-(const ExactPoint& a, const ExactPoint& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }

 private:
  ExactPoint(double dx, double dy, double dz) : x(dx), y(dy), z(dz) {}
};

// Bounds of the errors of the determinants below, absolute, for points in a box of the given sides [m]: the number of
// terms times the longest chain of roundings times 2^-53 times the largest term. There are 6 terms with 8 roundings,
// and 72 with 16. Floats are multiples of 2^-149, so no product of five of them underflows.
struct RoundingErrors {
  double orientation, sphere;
  RoundingErrors(double x, double y, double z)
      : orientation(6e-15 * x * y * z), sphere(1.5e-13 * x * y * z * std::max({x * x, y * y, z * z})) {}
};

// For the points themselves, where the bounds for the whole cloud do not decide.
template <class... Differences>
RoundingErrors errors_of(const Differences&... d) {
  return {std::max({std::abs(d.x)...}), std::max({std::abs(d.y)...}), std::max({std::abs(d.z)...})};
}

// The sign of (b-a) x (c-a) . (d-a): 1 if d is on the side from which a, b, c run counter-clockwise, 0 if all four lie
// in one plane.
inline int orientation(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c, const ExactPoint& d,
                       const RoundingErrors& of_cloud) {
  const ExactPoint u = b - a, v = c - a, w = d - a;
  const double det = u.x * (v.y * w.z - v.z * w.y) + u.y * (v.z * w.x - v.x * w.z) + u.z * (v.x * w.y - v.y * w.x);
  if (std::abs(det) > of_cloud.orientation || std::abs(det) > errors_of(u, v, w).orientation) return det > 0 ? 1 : -1;
  return exact_orientation(a.as_floats(), b.as_floats(), c.as_floats(), d.as_floats());
}

// 1 if p is inside of the sphere through the corners of a tetrahedron of positive orientation, -1 if it is outside, 0
// if it is on the sphere.
inline int side_of_sphere(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c, const ExactPoint& d,
                          const ExactPoint& p, const RoundingErrors& of_cloud) {
  const ExactPoint q = a - p, r = b - p, s = c - p, t = d - p;
  const double qr = q.x * r.y - r.x * q.y, rs = r.x * s.y - s.x * r.y, st = s.x * t.y - t.x * s.y,
               tq = t.x * q.y - q.x * t.y, qs = q.x * s.y - s.x * q.y, rt = r.x * t.y - t.x * r.y;
  const double qrs = q.z * rs - r.z * qs + s.z * qr, rst = r.z * st - s.z * rt + t.z * rs,
               stq = s.z * tq + t.z * qs + q.z * st, tqr = t.z * qr + q.z * rt + r.z * tq;
  const auto squared = [](const ExactPoint& e) { return e.x * e.x + e.y * e.y + e.z * e.z; };
  const double det = (squared(q) * rst - squared(r) * stq) + (squared(s) * tqr - squared(t) * qrs);
  if (std::abs(det) > of_cloud.sphere || std::abs(det) > errors_of(q, r, s, t).sphere) return det > 0 ? 1 : -1;
  return exact_side_of_sphere(a.as_floats(), b.as_floats(), c.as_floats(), d.as_floats(), p.as_floats());
}

// The same without ties, by the symbolic perturbation of Devillers and Teillaud (2011): points move by infinitely
// little into the fourth dimension of the lifted paraboloid, the lexicographically highest by most. So the sign is that
// of the first nonzero minor.
inline bool is_in_sphere(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c, const ExactPoint& d,
                         const ExactPoint& p, const RoundingErrors& of_cloud) {
  if (const int side = side_of_sphere(a, b, c, d, p, of_cloud); side != 0) return side > 0;
  std::array<const ExactPoint*, 5> points = {&a, &b, &c, &d, &p};
  std::sort(points.begin(), points.end(), [](const ExactPoint* u, const ExactPoint* v) { return *u > *v; });
  for (const ExactPoint* highest : {points[0], points[1]}) {
    if (highest == &p) return false;
    const auto without = [&](const ExactPoint& corner) -> const ExactPoint& { return highest == &corner ? p : corner; };
    const int side = orientation(without(a), without(b), without(c), without(d), of_cloud);
    if (side != 0) return side > 0;
  }
  return false;
}

}  // namespace mercury
