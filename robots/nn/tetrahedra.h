// SPDX-License-Identifier: Apache-2.0
// A body of tetrahedra: its edges and its skin.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "mercury/vec3.h"

namespace mercury {

// Four points, (b-a) x (c-a) . (d-a) > 0.
using Tetrahedron = std::array<std::uint32_t, 4>;
// Three points, counter-clockwise seen from outside.
using Triangle = std::array<std::uint32_t, 3>;

// Two points, the lower one first.
using Edge = std::pair<std::uint32_t, std::uint32_t>;

// The same starting with its lowest point, then the lowest of the others.
Tetrahedron lowest_first(const Tetrahedron& tetrahedron);

// Every edge once, sorted.
std::vector<Edge> edges_of(std::span<const Tetrahedron> tetrahedra);

// The triangles that bound only one tetrahedron, sorted, each starting with its lowest point. They bound a solid, so
// they form a closed oriented surface: at every edge as many triangles run one way as the other. Where the solid
// touches itself along an edge, that edge has four triangles.
std::vector<Triangle> skin_of(std::span<const Tetrahedron> tetrahedra);

// For each tetrahedron its neighbors across its sides, in no certain order; no_neighbor where there is none.
inline constexpr std::uint32_t no_neighbor = 0xffffffff;
using Neighbors = std::array<std::uint32_t, 4>;
std::vector<Neighbors> neighbors_of(std::span<const Tetrahedron> tetrahedra);

// The same, faster, where it is known that neighbor i is opposite to point i.
std::vector<Triangle> skin_of(std::span<const Tetrahedron> tetrahedra, std::span<const Neighbors> opposite);

// The first `count` tetrahedra form bodies, joined side to side. Returns the body that holds most points; of equal
// bodies, the one with the earliest tetrahedron.
struct SolidBody {
  std::vector<std::uint32_t> tetrahedra;  // indices, the earliest one first
  std::size_t points = 0;
  std::uint32_t rival = no_neighbor;  // earliest tetrahedron of the next body with as many points, if there is one
};
SolidBody largest_body(std::span<const Tetrahedron> tetrahedra, std::span<const Neighbors> neighbors,
                       std::size_t count);

// For each of `count` points, the lowest point of the connected part of the graph that it is in.
std::vector<std::uint32_t> components(std::size_t count, std::span<const Edge> edges);

// The Delaunay triangulation of a cloud of points.

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

// The solid body of a cloud of points: its alpha shape (Edelsbrunner and Muecke 1994), as tetrahedra.

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
