// SPDX-License-Identifier: Apache-2.0
// The scene's data per body, mass, face and material, on the GPU.
#pragma once

#include <span>
#include <vector>

#include "render/bodies.h"
#include "render/camera.h"
#include "render/gl_objects.h"
#include "render/scene.h"
#include "render/upload_ring.h"

namespace mercury::render {

class SceneBuffers {
 public:
  // Includes the bodies' positions, if the scene has them. Throws std::invalid_argument for spans of the wrong length.
  void upload(const Scene& scene, const Bodies& bodies);
  // Binds all that shaders/bodies.glsl declares, and the values to color by.
  void bind(const Bodies& bodies) const;

 private:
  UploadRing positions_;
  StreamBuffer placements_, materials_, face_values_, mass_values_;
};

// Moves the boxes of bodies by their placements; empty for hidden bodies.
std::vector<Bounds> placed(std::vector<Bounds> bodies, std::span<const Placement> placements);

}  // namespace mercury::render
