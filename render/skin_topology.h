// SPDX-License-Identifier: Apache-2.0
// How a skin's triangles are connected: which pairs form a quadrilateral, and which face lies across each edge.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace mercury::render {

// The layout of shaders/bodies.glsl.
struct FaceRecord {
  // The faces across the edges. Of a triangle: the edges opposite to corner 0, 1, 2. Of half a quadrilateral: the edges
  // u = 0, u = 1, v = 0, v = 1 of the quadrilateral. no_face at an open border.
  std::array<std::uint32_t, 4> neighbors;
  std::uint32_t material;
  // 3 = a triangle; 0, 1, 2 = half a quadrilateral, and the corner opposite to its diagonal.
  std::uint32_t shape;
  std::uint32_t padding[2] = {0, 0};
};

inline constexpr std::uint32_t no_face = 0xffffffffu;

// `positions`: 3 floats per mass, at rest. `faces`: 3 masses per face. Two faces form a quadrilateral when they share
// an edge, lie within 2 degrees of one plane there and make a convex, roughly rectangular outline. Materials are left
// 0.
std::vector<FaceRecord> skin_topology(std::span<const float> positions, std::span<const std::uint32_t> faces);

}  // namespace mercury::render
