// SPDX-License-Identifier: Apache-2.0
// The plane that cuts each body, computed from the positions on the GPU.
#pragma once

#include "render/bodies.h"
#include "render/gl_objects.h"
#include "render/scene.h"

namespace mercury::render {

class CutPass {
 public:
  CutPass();
  // Writes the planes into the placements that are bound (Placement of shaders/bodies.glsl).
  void find(Bodies& bodies, const Cut& cut) const;

 private:
  Program program_;
};

}  // namespace mercury::render
