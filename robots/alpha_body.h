// SPDX-License-Identifier: Apache-2.0
// The solid body that a cloud of points stands for: its alpha shape (Edelsbrunner and Muecke 1994), as tetrahedra.
#pragma once

#include <span>
#include <vector>

#include "mercury/vec3.h"
#include "robots/tetrahedra.h"

namespace mercury {

struct AlphaBody {
  double alpha = 0;                     // radius of the ball that carves the shape [m]
  std::vector<Tetrahedron> tetrahedra;  // joined face to face; sorted, each starting with its lowest point
};

// The interior tetrahedra of the regularized alpha shape of distinct points: those of the Delaunay triangulation whose
// circumscribed sphere has a radius of at most alpha [m]; of the bodies that they form, joined face to face, the one
// that holds most points. With alpha = 0 the smallest alpha is taken at which one body holds all points. Decisions are
// exact (CGAL's exact predicates), so that the answer depends on the points alone. Throws InputError if there are fewer
// than four points, if all lie in one plane, or if no tetrahedron is as small as alpha.
AlphaBody alpha_body(std::span<const Vec3> points, double alpha = 0);

}  // namespace mercury
