// SPDX-License-Identifier: Apache-2.0
// Bodies made ready for the card, without OpenGL: on whatever thread, each once, however often it is drawn with others.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "render/scene.h"
#include "render/skin_topology.h"

namespace mercury::render {

// One body; indices count its own masses and faces.
struct PreparedBody {
  std::vector<float> rest_positions;                      // 3 a mass
  std::vector<std::uint32_t> faces, springs;              // 3 masses a face, 2 a spring
  std::vector<std::uint32_t> spring_materials;                // one a spring
  std::vector<FaceRecord> records;                        // one a face
  std::vector<std::uint32_t> mass_face_ends, mass_faces;  // the faces at each mass
  std::vector<float> lengths;                             // of some springs [m]
};

// Throws std::invalid_argument ("body 3: a face's mass is out of range") for an index out of range or a length that
// does not fit; `index` is for the message.
std::shared_ptr<const PreparedBody> prepare_body(const Body& body, std::size_t index = 0);

// Bodies one after the other, with indices counted over all of them.
struct BodyData {
  std::vector<std::uint32_t> mass_offsets{0};  // bodies + 1
  std::vector<float> rest_positions;
  std::vector<std::uint32_t> owners;  // body, one a mass
  std::vector<std::uint32_t> faces, springs, spring_materials;
  std::vector<FaceRecord> records;
  std::vector<std::uint32_t> mass_face_ends, mass_faces;
  float typical_spring = 0.1f;  // median rest length [m]
};
std::shared_ptr<const BodyData> assemble(std::span<const std::shared_ptr<const PreparedBody>> bodies);

}  // namespace mercury::render
