// SPDX-License-Identifier: Apache-2.0
// Prints in the ground (Print of render/scene.h) as a map that the ground's shaders read.
//
//   heights   each print is drawn into a map from above: how deep it is, and the rim of sand around it. The deepest
//             counts, so the order of prints does not.
//   relief    from heights: the slope of the ground, how much it is pressed, and where the walls hide the key light
//
// The map covers the prints near what the camera looks at. Its texels have one of a few sizes per octave and
// lie on a grid that is fixed in the world, so prints do not shimmer while the camera moves.
#pragma once

#include <span>
#include <string>

#include "render/camera.h"
#include "render/context/gl_objects.h"
#include "render/passes/quality.h"
#include "render/scene.h"
#include "render/style.h"

namespace mercury::render {

// What the map covers.
struct PrintMap {
  float texel = 1;       // side [m]
  Vector2 corner{0, 0};  // [m]
  float depth = 0;       // of a fresh print [m]
};

// The map of that many texels per side for prints, of which there is at least one.
PrintMap print_map(std::span<const Print> prints, const Camera& camera, int side);

class PrintPass {
 public:
  explicit PrintPass(const QualitySettings& settings);

  // Draws the map of a scene on land, and binds it.
  void draw(const Scene& scene, const Camera& camera, const Style& style);
  // For shaders that include floor.glsl: "" if there is no map.
  const std::string& variant() const { return variant_; }

 private:
  void make();

  int side_;
  Texture heights_, relief_;  // made when they are first needed
  Framebuffer heights_framebuffer_;
  VertexArray empty_;
  Program print_, shade_;
  StreamBuffer records_, place_;
  std::string variant_;
};

}  // namespace mercury::render
