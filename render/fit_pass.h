// SPDX-License-Identifier: Apache-2.0
// What the shadow map and the floor's map of light cover, told from where the bodies are without asking the processor.
#pragma once

#include "render/gl_objects.h"

namespace mercury::render {

class FitPass {
 public:
  FitPass();
  // Fills in `shadow`, `shadow_size`, `ground` and the height of the highest body of the FrameBlock in `frame`, from
  // boxes as BoundsPass leaves them and the placements bound for storage. Sides in texels.
  void fit(const Buffer& frame, const Buffer& boxes, std::size_t bodies, int shadow_side, int ground_side) const;

 private:
  Program program_;
};

}  // namespace mercury::render
