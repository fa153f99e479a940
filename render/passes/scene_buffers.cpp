// SPDX-License-Identifier: Apache-2.0
#include "render/passes/scene_buffers.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "render/passes/bindings.h"

namespace mercury::render {
namespace {

// The layout of shaders/bodies.glsl.
struct PlacementRecord {
  float x = 0, y = 0, z = 0;
  std::uint32_t flags = 0;
  Vector4 cut{0, 0, 0, 1};  // filled in by CutPass
};

constexpr std::uint32_t smooth_flag = 8;

std::uint32_t flags_of(const Placement& placement) {
  return (placement.hidden ? 1u : 0u) | (placement.selected ? 2u : 0u) | (placement.faulty ? 4u : 0u) |
         (placement.smooth ? smooth_flag : 0u) | placement.first_material << 8;
}

std::vector<PlacementRecord> placement_records(std::span<const Placement> placements, std::size_t bodies,
                                               bool rounded) {
  std::vector<PlacementRecord> records(std::max<std::size_t>(bodies, 1));
  for (std::size_t i = 0; i < placements.size(); ++i) {
    const Vector3& offset = placements[i].offset;
    records[i].x = offset.x;
    records[i].y = offset.y;
    records[i].z = offset.z;
    records[i].flags = flags_of(placements[i]);
  }
  if (rounded)
    for (PlacementRecord& record : records) record.flags |= smooth_flag;
  return records;
}

std::vector<Vector4> material_records(std::span<const RenderMaterial> materials) {
  std::vector<Vector4> records;
  for (const RenderMaterial& material : materials) {
    const auto linear = linear_of(material.color);
    records.push_back({linear[0], linear[1], linear[2], material.activation});
  }
  if (records.empty()) records.push_back({0.6f, 0.6f, 0.6f, 0});
  return records;
}

void require(std::size_t size, std::size_t wanted, const char* what) {
  if (size != 0 && size != wanted)
    throw std::invalid_argument(std::string("Scene::") + what + " has " + std::to_string(size) + " elements, not " +
                                std::to_string(wanted));
}

}  // namespace

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

Octave octave_of(float distance) {
  const float power = std::log2(std::max(distance, 1e-6f));
  const float whole = std::floor(power);
  const float t = std::clamp((power - whole - 0.35f) / 0.3f, 0.0f, 1.0f);
  // A share of 1 is the next power of two without a double.
  return t < 1 ? Octave{std::exp2(whole), t * t * (3 - 2 * t)} : Octave{std::exp2(whole + 1), 0};
}

FrameBlock frame_block(const Scene& scene, const Camera& camera, const Style& style, int width, int height,
                       float noise) {
  FrameBlock b;
  const float aspect = float(width) / float(height);
  b.view = camera.view();
  b.view_projection = camera.projection(aspect) * b.view;
  b.inverse_view_projection = inverse(b.view_projection);
  const float distance = (camera.eye - camera.target).norm();
  b.eye = Vector4(camera.eye, float(std::fmod(scene.time, 3600.0)));
  b.to_key = Vector4(style.to_key.normalized(), style.key_size);
  b.key_light = Vector4(style.key_light, style.glow);
  b.sky_light = Vector4(style.sky_light, scene.against_light ? 7.0f : 4.2f);
  b.ground_light = Vector4(style.ground_light, 0);
  b.backdrop_high = Vector4(style.backdrop_high, 0);
  b.backdrop_low = Vector4(style.backdrop_low, 0);
  b.floor_color = Vector4(style.floor_color, 0);
  b.line_color = Vector4(style.line_color, scene.patches.empty() && !scene.against_light ? 1 : 0);
  b.fog = Vector4(style.fog / distance, 0.55f * distance);
  b.screen = {float(width), float(height), 1 / float(width), 1 / float(height)};
  const float scale = 1 / std::tan(0.5f * camera.field_of_view);
  // Depth d in the buffer is the distance near far / (near + d (far - near)).
  b.depth = {camera.near, camera.far, aspect / scale, 1 / scale};
  b.ground = {0, 0, 1, scene.floor};
  b.water = {float(scene.surroundings), style.caustics, 0, distance};
  const Octave octave = octave_of(distance);
  b.octave = {octave.size, 2 * octave.size, octave.share_of_double, scene.catch_shadows ? 1.0f : 0.0f};
  b.lens = {camera.shift.x, camera.shift.y, noise, 0};
  return b;
}

void MixPass::mix(std::size_t count, float share) {
  if (!program_) program_ = make_program({"mix_positions.comp"});
  glUseProgram(program_.get());
  glUniform1ui(0, GLuint(count));
  glUniform1f(1, share);
  // The frame before has been drawn from them.
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
  dispatch(count);
}

void SceneBuffers::upload(const Scene& scene, const Bodies& bodies, bool rounded) {
  require(scene.positions.size(), 3 * bodies.mass_count(), "positions");
  require(scene.placements.size(), bodies.body_count(), "placements");
  require(scene.face_values.size(), bodies.face_count(), "face_values");
  require(scene.mass_values.size(), bodies.mass_count(), "mass_values");
  require(scene.spring_values.size(), bodies.spring_count(), "spring_values");
  if (!scene.positions.empty())
    positions_.write(bodies.positions, std::as_bytes(scene.positions));
  else
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT |
                    GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT);  // makes earlier writes to them visible
  placements_.write(placement_records(scene.placements, bodies.body_count(), rounded));
  materials_.write(material_records(scene.materials));
  face_values_.write(scene.face_values);
  mass_values_.write(scene.mass_values);
}

void SceneBuffers::bind(const Bodies& bodies) const {
  bodies.positions.bind_storage(binding::positions);
  placements_.bind_storage(binding::placements);
  bodies.mass_bodies.bind_storage(binding::mass_bodies);
  bodies.face_records.bind_storage(binding::face_records);
  materials_.bind_storage(binding::materials);
  face_values_.bind_storage(binding::face_values);
  mass_values_.bind_storage(binding::mass_values);
}

std::vector<Bounds> placed(std::vector<Bounds> bodies, std::span<const Placement> placements) {
  for (std::size_t i = 0; i < std::min(bodies.size(), placements.size()); ++i)
    bodies[i] = placements[i].hidden ? Bounds{} : bodies[i].moved(placements[i].offset);
  return bodies;
}

}  // namespace mercury::render
