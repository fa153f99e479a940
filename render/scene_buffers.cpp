// SPDX-License-Identifier: Apache-2.0
#include "render/scene_buffers.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "render/bindings.h"

namespace mercury::render {
namespace {

// The layout of shaders/bodies.glsl.
struct PlacementRecord {
  float x = 0, y = 0, z = 0;
  std::uint32_t flags = 0;
  Vector4 cut{0, 0, 0, 1};  // filled in by CutPass
};

std::uint32_t flags_of(const Placement& placement) {
  return (placement.hidden ? 1u : 0u) | (placement.selected ? 2u : 0u) | (placement.faulty ? 4u : 0u) |
         (placement.smooth ? 8u : 0u) | placement.first_material << 8;
}

std::vector<PlacementRecord> placement_records(std::span<const Placement> placements, std::size_t bodies) {
  std::vector<PlacementRecord> records(std::max<std::size_t>(bodies, 1));
  for (std::size_t i = 0; i < placements.size(); ++i) {
    const Vector3& offset = placements[i].offset;
    records[i].x = offset.x;
    records[i].y = offset.y;
    records[i].z = offset.z;
    records[i].flags = flags_of(placements[i]);
  }
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

void SceneBuffers::upload(const Scene& scene, const Bodies& bodies) {
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
  placements_.write(placement_records(scene.placements, bodies.body_count()));
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
