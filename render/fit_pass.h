// SPDX-License-Identifier: Apache-2.0
// What the shadow map and the floor's light map cover, computed from the bodies' boxes on the GPU.
#pragma once

#include "render/gl_objects.h"

namespace mercury::render {

class FitPass {
 public:
  FitPass();
  // Fills in `shadow`, `shadow_size`, `ground` and the height of the highest body in the FrameBlock in `frame`, from
  // the boxes of BoundsPass and the placements bound as storage. Sides in texels.
  void fit(const Buffer& frame, const Buffer& boxes, std::size_t bodies, int shadow_side, int ground_side) const;

 private:
  Program program_;
};

}  // namespace mercury::render
