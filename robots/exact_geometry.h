// SPDX-License-Identifier: Apache-2.0
// Decisions about points that floating point cannot make: exact, and slow.
#pragma once

#include <compare>
#include <memory>
#include <span>

#include "mercury/vec3.h"
#include "robots/circumradius.h"
#include "robots/tetrahedra.h"

namespace mercury {

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
