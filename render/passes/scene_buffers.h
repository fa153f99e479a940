// SPDX-License-Identifier: Apache-2.0
// The scene's data on the GPU: per body, mass, face and material, and what all shaders of one picture share.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "render/body_data.h"
#include "render/camera.h"
#include "render/context/buffers.h"
#include "render/context/gl_objects.h"
#include "render/scene.h"
#include "render/style.h"
#include "render/vector.h"

namespace mercury::render {

// All bodies on the GPU: one buffer per kind of data for all of them, so that a pass draws every body with one call.
class Bodies {
 public:
  Bodies();
  // See Renderer::set_bodies.
  void set(std::shared_ptr<const BodyData> data);
  // Uploads the springs before they are first drawn: they are most of the data and seldom visible.
  void write_springs();
  // Uploads the positions at rest before they are first needed.
  void write_rest();

  std::size_t body_count() const { return mass_offsets_.size() - 1; }
  std::size_t mass_count() const { return mass_offsets_.back(); }
  std::size_t face_count() const { return face_count_; }
  std::size_t spring_count() const { return spring_count_; }
  // Body i has the elements from offsets[i] to offsets[i + 1].
  std::span<const std::uint32_t> mass_offsets() const { return mass_offsets_; }
  std::span<const std::uint32_t> face_offsets() const { return face_offsets_; }
  std::span<const std::uint32_t> spring_offsets() const { return spring_offsets_; }
  float typical_spring() const { return typical_spring_; }  // median rest length of the springs [m]

  // One body after the other; indices count over all bodies.
  Buffer positions;         // float[3] per mass
  Buffer rest_positions;    // the same
  Buffer mass_bodies;       // uint per mass
  Buffer first_masses;      // uint per body, and one more: its first mass
  Buffer faces;             // uint[3] per face
  Buffer face_records;      // FaceRecord per face
  Buffer springs;           // uint[2] per spring
  Buffer spring_materials;  // uint per spring
  Buffer mass_face_ends;    // uint per mass: the end of its part of mass_faces
  Buffer mass_faces;        // the faces at each mass

 private:
  std::vector<std::uint32_t> mass_offsets_{0}, face_offsets_{0}, spring_offsets_{0};
  std::shared_ptr<const BodyData> springs_to_write_, rest_to_write_;  // nullptr = they are on the GPU
  std::size_t face_count_ = 0, spring_count_ = 0;
  float typical_spring_ = 0.1f;
};

// Makes a vertex array read the corners of skins: attribute 0 is the position of a mass, attribute 1 its body.
void attach_corners(GLuint array, const Bodies& bodies);

// The uniform block that all shaders of one picture share; shaders/frame.glsl explains the members, in the same order.
struct FrameBlock {
  Matrix4 view_projection, inverse_view_projection, view, shadow = Matrix4::identity();
  Vector4 eye, to_key, key_light, sky_light, ground_light, backdrop_high, backdrop_low, floor_color, line_color, fog,
      screen, depth, shadow_size{1, 1, 0, 0}, ground, water, octave, lens;
};

// The size of a pattern that is fixed in the world and suits any viewing distance: a power of two, which fades into its
// double as the distance grows.
struct Octave {
  float size = 1, share_of_double = 0;
};
Octave octave_of(float distance);

// Everything except what FitPass fills in, and how far light shines into bodies. `noise`: see pixel_noise() of the
// shaders.
FrameBlock frame_block(const Scene& scene, const Camera& camera, const Style& style, int width, int height,
                       float noise = 0);

// Fills Bodies::positions with positions between those of two other buffers.
class MixPass {
 public:
  // The buffers are bound as storage: the bodies' positions, and from first_free on the two others. `count` of numbers.
  void mix(std::size_t count, float share);

 private:
  Program program_;  // made when it is first needed
};

class SceneBuffers {
 public:
  // Includes the bodies' positions, if the scene has them. Throws std::invalid_argument for spans of the wrong length.
  // `rounded`: all bodies are placed with Placement::smooth.
  void upload(const Scene& scene, const Bodies& bodies, bool rounded = false);
  // Binds all that shaders/bodies.glsl declares, and the values to color by.
  void bind(const Bodies& bodies) const;

 private:
  UploadRing positions_;
  StreamBuffer placements_, materials_, face_values_, mass_values_;
};

// Moves the boxes of bodies by their placements; empty for hidden bodies.
std::vector<Bounds> placed(std::vector<Bounds> bodies, std::span<const Placement> placements);

}  // namespace mercury::render
