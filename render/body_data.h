// SPDX-License-Identifier: Apache-2.0
// Bodies prepared for the GPU, without OpenGL: on any thread, and once per body, however many groups it is drawn in.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "render/scene.h"

namespace mercury::render {

// How a skin's triangles are connected: which pairs form a quadrilateral, and which face lies across each edge. The
// layout of shaders/bodies.glsl.
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

// One body; indices count its own masses and faces.
struct PreparedBody {
  std::vector<float> rest_positions;                      // 3 per mass
  std::vector<std::uint32_t> faces, springs;              // 3 masses per face, all the same for a copy of an earlier
                                                          // face; 2 per spring
  std::vector<std::uint32_t> spring_materials;            // one per spring
  std::vector<FaceRecord> records;                        // one per face
  std::vector<std::uint32_t> mass_face_ends, mass_faces;  // the faces at each mass
  std::vector<float> lengths;                             // of a sample of the springs [m]
};

// Throws std::invalid_argument ("body 3: a face's mass is out of range") for an index out of range or a length that
// does not fit; `index` is for the message.
std::shared_ptr<const PreparedBody> prepare_body(const Body& body, std::size_t index = 0);

// All bodies of a group, one after another; indices count over all of them.
struct BodyData {
  std::vector<std::uint32_t> mass_offsets{0}, face_offsets{0}, spring_offsets{0};  // one per body, and one more
  std::vector<float> rest_positions;
  std::vector<std::uint32_t> owners;  // the body of each mass
  std::vector<std::uint32_t> faces, springs, spring_materials;
  std::vector<FaceRecord> records;
  std::vector<std::uint32_t> mass_face_ends, mass_faces;
  float typical_spring = 0.1f;  // median rest length [m]
};
std::shared_ptr<const BodyData> assemble(std::span<const std::shared_ptr<const PreparedBody>> bodies);

}  // namespace mercury::render
