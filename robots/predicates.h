// SPDX-License-Identifier: Apache-2.0
// The two questions of a Delaunay triangulation. Floating point answers where its error cannot change the sign, exact
// arithmetic elsewhere.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "mercury/vec3.h"
#include "robots/exact_geometry.h"

namespace mercury {

// A point minus another. The differences of floats are rounded once.
struct Difference {
  double x, y, z;
  Difference(const Vec3& to, const Vec3& from)
      : x(static_cast<double>(to.x) - static_cast<double>(from.x)),
        y(static_cast<double>(to.y) - static_cast<double>(from.y)),
        z(static_cast<double>(to.z) - static_cast<double>(from.z)) {}
};

// Largest differences along each axis.
template <class... Differences>
std::array<double, 3> largest(const Differences&... d) {
  return {std::max({std::abs(d.x)...}), std::max({std::abs(d.y)...}), std::max({std::abs(d.z)...})};
}

// Errors of the determinants below, relative to the product of the largest differences: terms times the longest chain
// of roundings times 2^-53, rounded up. There are 6 terms with 8 roundings, and 72 with 16. Floats are multiples of
// 2^-149, so no product of five of them underflows.
inline constexpr double orientation_error = 6e-15, sphere_error = 1.5e-13;

// The sign of (b-a) x (c-a) . (d-a): 1 if d is on the side from which a, b, c run counter-clockwise, 0 if all four lie
// in one plane.
inline int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Difference u(b, a), v(c, a), w(d, a);
  const double det = u.x * (v.y * w.z - v.z * w.y) + u.y * (v.z * w.x - v.x * w.z) + u.z * (v.x * w.y - v.y * w.x);
  const auto [x, y, z] = largest(u, v, w);
  const double error = orientation_error * x * y * z;
  if (det > error) return 1;
  if (det < -error) return -1;
  return exact_orientation(a, b, c, d);
}

// 1 if p is inside of the sphere through the corners of a tetrahedron of positive orientation, -1 if it is outside, 0
// if it is on the sphere.
inline int side_of_sphere(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& p) {
  const Difference q(a, p), r(b, p), s(c, p), t(d, p);
  const double qr = q.x * r.y - r.x * q.y, rs = r.x * s.y - s.x * r.y, st = s.x * t.y - t.x * s.y,
               tq = t.x * q.y - q.x * t.y, qs = q.x * s.y - s.x * q.y, rt = r.x * t.y - t.x * r.y;
  const double qrs = q.z * rs - r.z * qs + s.z * qr, rst = r.z * st - s.z * rt + t.z * rs,
               stq = s.z * tq + t.z * qs + q.z * st, tqr = t.z * qr + q.z * rt + r.z * tq;
  const auto squared = [](const Difference& e) { return e.x * e.x + e.y * e.y + e.z * e.z; };
  const double det = (squared(q) * rst - squared(r) * stq) + (squared(s) * tqr - squared(t) * qrs);
  const auto [x, y, z] = largest(q, r, s, t);
  const double longest = std::max({x, y, z});
  const double error = sphere_error * x * y * z * (longest * longest);
  if (det > error) return 1;
  if (det < -error) return -1;
  return exact_side_of_sphere(a, b, c, d, p);
}

// The same without ties, by the symbolic perturbation of Devillers and Teillaud (2011): points move by infinitely
// little into the fourth dimension of the lifted paraboloid, the lexicographically highest by most. So the sign is that
// of the first nonzero minor.
inline bool is_in_sphere(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& p) {
  if (const int side = side_of_sphere(a, b, c, d, p); side != 0) return side > 0;
  std::array<const Vec3*, 5> points = {&a, &b, &c, &d, &p};
  std::sort(points.begin(), points.end(), [](const Vec3* u, const Vec3* v) {
    return u->x != v->x ? u->x > v->x : u->y != v->y ? u->y > v->y : u->z > v->z;
  });
  for (const Vec3* highest : {points[0], points[1]}) {
    if (highest == &p) return false;
    const auto without = [&](const Vec3& corner) -> const Vec3& { return highest == &corner ? p : corner; };
    if (const int side = orientation(without(a), without(b), without(c), without(d)); side != 0) return side > 0;
  }
  return false;
}

}  // namespace mercury
