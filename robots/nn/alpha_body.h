// SPDX-License-Identifier: Apache-2.0
// The solid body of a cloud of points: its alpha shape (Edelsbrunner and Muecke 1994), as tetrahedra.
#pragma once

#include <span>
#include <vector>

#include "mercury/vec3.h"
#include "robots/nn/tetrahedra.h"

namespace mercury {

struct AlphaBody {
  double alpha = 0;                     // radius of the ball that carves the shape [m]
  std::vector<Tetrahedron> tetrahedra;  // joined face to face
  std::vector<Neighbors> neighbors;     // of each tetrahedron; neighbor i is opposite to its point i
};

// The interior tetrahedra of the regularized alpha shape of distinct points: those of the Delaunay triangulation whose
// circumscribed sphere has a radius of at most alpha [m]. They form bodies, joined face to face; the one that holds
// most points is returned. alpha = 0 stands for the smallest alpha at which one body holds all points. Decisions are
// exact (CGAL's exact predicates and fractions), so the set of tetrahedra depends on the points alone. Throws
// InputError if there are fewer than four points, if all lie in one plane, or if no tetrahedron is as small as alpha.
AlphaBody alpha_body(std::span<const Vec3> points, double alpha = 0);

}  // namespace mercury
