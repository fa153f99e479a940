// SPDX-License-Identifier: Apache-2.0
// A body of tetrahedra: its edges and its skin.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace mercury {

// Four points, (b-a) x (c-a) . (d-a) > 0.
using Tetrahedron = std::array<std::uint32_t, 4>;
// Three points, counter-clockwise seen from outside.
using Triangle = std::array<std::uint32_t, 3>;

// Two points, the lower one first.
using Edge = std::pair<std::uint32_t, std::uint32_t>;

// Every edge once, sorted.
std::vector<Edge> edges_of(std::span<const Tetrahedron> tetrahedra);

// The triangles that bound one tetrahedron only, sorted, each starting with its lowest point. As the boundary of a
// solid they form a closed oriented surface: at every edge as many triangles run one way as the other. Where the solid
// touches itself along an edge, that edge has four triangles.
std::vector<Triangle> skin_of(std::span<const Tetrahedron> tetrahedra);

// For each tetrahedron the ones that share its sides, no_neighbour where there is none.
inline constexpr std::uint32_t no_neighbour = 0xffffffff;
using Neighbours = std::array<std::uint32_t, 4>;
std::vector<Neighbours> neighbours_of(std::span<const Tetrahedron> tetrahedra);

// Of the first `count` tetrahedra, joined side to side, the body that holds most points; of equals, the one that the
// earliest tetrahedron is in.
struct SolidBody {
  std::vector<std::uint32_t> tetrahedra;  // indices
  std::size_t points = 0;
};
SolidBody largest_body(std::span<const Tetrahedron> tetrahedra, std::span<const Neighbours> neighbours,
                       std::size_t count);

// The part of a graph that each point is in, as the lowest point of that part; `count` points.
std::vector<std::uint32_t> components(std::size_t count, std::span<const Edge> edges);

}  // namespace mercury
