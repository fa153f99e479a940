// SPDX-License-Identifier: Apache-2.0
// What a scene says of each body, mass, face and material at one moment, on the card.
#pragma once

#include <span>
#include <vector>

#include "render/bodies.h"
#include "render/camera.h"
#include "render/gl_objects.h"
#include "render/scene.h"

namespace mercury::render {

class SceneBuffers {
 public:
  // Also the bodies' positions, if the scene has them. Throws std::invalid_argument for spans of the wrong length.
  void upload(const Scene& scene, const Bodies& bodies);
  // All that shaders/bodies.glsl declares, and the values to colour by.
  void bind(const Bodies& bodies) const;

 private:
  StreamBuffer placements_, materials_, face_values_, mass_values_;
};

// The boxes of bodies as they stand in the picture; empty for one that is not shown.
std::vector<Bounds> placed(std::vector<Bounds> bodies, std::span<const Placement> placements);

}  // namespace mercury::render
