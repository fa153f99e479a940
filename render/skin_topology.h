// SPDX-License-Identifier: Apache-2.0
// What a skin's triangles have to do with each other: which pairs form a quadrilateral, and who lies across an edge.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace mercury::render {

// As shaders/faces.glsl reads it.
struct FaceRecord {
  // Neighbours across the edges of the triangle or, for half a quadrilateral, of the whole: triangle edges opposite to
  // corner 0, 1, 2; quadrilateral edges u = 0, u = 1, v = 0, v = 1. no_face at an open border.
  std::array<std::uint32_t, 4> neighbours;
  std::uint32_t material;
  // 3 = a triangle of its own; 0, 1, 2 = half a quadrilateral, and this corner is opposite to the diagonal.
  std::uint32_t shape;
  std::uint32_t padding[2] = {0, 0};
};

inline constexpr std::uint32_t no_face = 0xffffffffu;

// `positions` has 3 floats a mass at rest, `faces` 3 masses a face. Two faces form a quadrilateral when they share an
// edge, lie within 2 degrees of one plane there and make a convex, roughly rectangular outline. Looks are left 0.
std::vector<FaceRecord> skin_topology(std::span<const float> positions, std::span<const std::uint32_t> faces);

}  // namespace mercury::render
