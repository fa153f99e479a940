// SPDX-License-Identifier: Apache-2.0
#include "render/bodies.h"

#include <utility>

namespace mercury::render {

Bodies::Bodies() { set(std::make_shared<const BodyData>()); }

void Bodies::set(std::shared_ptr<const BodyData> data) {
  positions.write(data->rest_positions);
  mass_bodies.write(data->owners);
  first_masses.write(data->mass_offsets);
  faces.write(data->faces);
  face_records.write(data->records);
  mass_face_ends.write(data->mass_face_ends);
  mass_faces.write(data->mass_faces);
  mass_offsets_ = data->mass_offsets;
  face_offsets_ = data->face_offsets;
  spring_offsets_ = data->spring_offsets;
  face_count_ = data->records.size();
  spring_count_ = data->spring_materials.size();
  typical_spring_ = data->typical_spring;
  rest_to_write_ = data;
  springs_to_write_ = std::move(data);
}

void Bodies::write_springs() {
  if (!springs_to_write_) return;
  springs.write(springs_to_write_->springs);
  spring_materials.write(springs_to_write_->spring_materials);
  springs_to_write_.reset();
}

void Bodies::write_rest() {
  if (!rest_to_write_) return;
  rest_positions.write(rest_to_write_->rest_positions);
  rest_to_write_.reset();
}

void attach_corners(GLuint array, const Bodies& bodies) {
  glVertexArrayVertexBuffer(array, 0, bodies.positions.get(), 0, 12);
  glVertexArrayVertexBuffer(array, 1, bodies.mass_bodies.get(), 0, 4);
  glVertexArrayAttribFormat(array, 0, 3, GL_FLOAT, GL_FALSE, 0);
  glVertexArrayAttribIFormat(array, 1, 1, GL_UNSIGNED_INT, 0);
  for (GLuint i = 0; i < 2; ++i) {
    glVertexArrayAttribBinding(array, i, i);
    glEnableVertexArrayAttrib(array, i);
  }
}

}  // namespace mercury::render
