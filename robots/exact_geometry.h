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

// The Delaunay triangulation of distinct points; empty if they all lie in one plane. Cospherical points are decided by
// a symbolic perturbation (Devillers and Teillaud 2011), so the tetrahedra depend on the points alone; their order does
// not matter to anybody.
struct Triangulation {
  std::vector<Tetrahedron> tetrahedra;
  std::vector<Neighbours> neighbours;
};
Triangulation triangulate(std::span<const Vec3> points);

}  // namespace mercury
