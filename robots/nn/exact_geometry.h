// SPDX-License-Identifier: Apache-2.0
// Decisions about points that floating point cannot make: exact, and slow.
#pragma once

#include <cmath>
#include <compare>
#include <limits>
#include <memory>
#include <span>

#include "mercury/vec3.h"
#include "robots/nn/tetrahedra.h"

namespace mercury {

// The radius of the sphere through four points, between two bounds.

struct Bounds {
  double low = 0, high = std::numeric_limits<double>::infinity();
};

// With the sides a, b, c from p to the other points, the center is at
//
//   p + n / (2 det),   n = |a|^2 b x c + |b|^2 c x a + |c|^2 a x b,   det = a . (b x c)
//
// so the squared radius is |n|^2 / (2 det)^2. A computed sum of products is wrong by at most some units of rounding of
// the same sum with all its terms made positive (Higham 2002, chapter 3): the longest chain of roundings here has 12,
// we allow for 20. Returns 0 and infinity where that leaves less than three digits.
inline Bounds squared_circumradius(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) {
  struct Vector {
    double x, y, z;
  };
  constexpr double rounding = 20 * 0x1p-53;
  const auto side = [&](const Vec3& to) {
    return Vector{static_cast<double>(to.x) - static_cast<double>(p.x),
                  static_cast<double>(to.y) - static_cast<double>(p.y),
                  static_cast<double>(to.z) - static_cast<double>(p.z)};
  };
  const auto squared = [](const Vector& v) { return v.x * v.x + v.y * v.y + v.z * v.z; };
  const auto cross = [](const Vector& u, const Vector& v) {
    return Vector{u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
  };
  const auto positive_cross = [](const Vector& u, const Vector& v) {
    return Vector{std::abs(u.y * v.z) + std::abs(u.z * v.y), std::abs(u.z * v.x) + std::abs(u.x * v.z),
                  std::abs(u.x * v.y) + std::abs(u.y * v.x)};
  };
  const Vector a = side(q), b = side(r), c = side(s);
  const double aa = squared(a), bb = squared(b), cc = squared(c);
  const Vector bc = cross(b, c), ca = cross(c, a), ab = cross(a, b);
  const Vector bc_all = positive_cross(b, c), ca_all = positive_cross(c, a), ab_all = positive_cross(a, b);
  const Vector n = {aa * bc.x + bb * ca.x + cc * ab.x, aa * bc.y + bb * ca.y + cc * ab.y,
                    aa * bc.z + bb * ca.z + cc * ab.z};
  const double n_all = aa * (bc_all.x + bc_all.y + bc_all.z) + bb * (ca_all.x + ca_all.y + ca_all.z) +
                       cc * (ab_all.x + ab_all.y + ab_all.z);
  const double det = std::abs(a.x * bc.x + a.y * bc.y + a.z * bc.z);
  const double det_all = std::abs(a.x) * bc_all.x + std::abs(a.y) * bc_all.y + std::abs(a.z) * bc_all.z;
  const double nn = squared(n);
  const double wrong_by = rounding * (n_all / std::sqrt(nn) + det_all / det + 1);  // relative, of the radius
  const double estimate = nn / (4 * det * det);
  // Sides of less than 1e-36 m could underflow.
  if (!(wrong_by < 1e-3 && nn > 1e-290 && estimate < 1e290)) return {};
  return {estimate * (1 - 3 * wrong_by), estimate * (1 + 3 * wrong_by)};
}

// The sign of the determinant (b-a) x (c-a) . (d-a): 1 if d is on the side from which a, b, c run counter-clockwise,
// 0 if all four lie in one plane.
int exact_orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

// For a tetrahedron of positive orientation: 1 if p is inside of the sphere through its corners, 0 if it is on the
// sphere, -1 if it is outside.
int exact_side_of_sphere(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& p);

bool are_exactly_collinear(const Vec3& a, const Vec3& b, const Vec3& c);

// The squared radius of the sphere through the corners of a tetrahedron that is not flat, as a fraction.
class ExactSquaredRadius {
 public:
  ExactSquaredRadius(std::span<const Vec3> points, const Tetrahedron& tetrahedron);
  Bounds bounds() const;  // as tight as two doubles can be
  std::strong_ordering compare(const ExactSquaredRadius& other) const;
  std::strong_ordering compare(double other) const;

 private:
  struct Fraction;
  std::shared_ptr<const Fraction> value_;
};

}  // namespace mercury
