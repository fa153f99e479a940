// SPDX-License-Identifier: Apache-2.0
// The Delaunay triangulation of a cloud of points.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "mercury/vec3.h"
#include "robots/nn/tetrahedra.h"

namespace mercury {

struct Triangulation {
  std::vector<Tetrahedron> tetrahedra;
  std::vector<Neighbors> neighbors;  // neighbor i is opposite to point i; no_neighbor on the convex hull
};

// The Delaunay triangulation of points; empty if they all lie in one plane. Of equal points one is used.
// Decisions are exact, and ties between cospherical points are broken by their coordinates, so the set of tetrahedra
// depends on the points alone, not on their order. Fast where points that are near in space are near in the span.
Triangulation triangulate(std::span<const Vec3> points);
// The same into the memory of an earlier one.
void triangulate(std::span<const Vec3> points, Triangulation& result);

// Threads keep the memory of clouds of at most that many points for the next one.
inline constexpr std::size_t small_cloud = 4096;

}  // namespace mercury
