// SPDX-License-Identifier: Apache-2.0
// The boxes around bodies, found where their positions lie.
#pragma once

#include <vector>

#include "render/bodies.h"
#include "render/camera.h"
#include "render/host_buffer.h"

namespace mercury::render {

class BoundsPass {
 public:
  BoundsPass();
  // From the positions bound for storage. A body without a finite mass has an empty box.
  void measure(const Bodies& bodies);
  // On the card, low and high corner as vec4 a body, for shaders that come after.
  const Buffer& boxes() const { return boxes_; }

  // Begins to bring the boxes to the processor; read() waits for them, but for nothing that was drawn since.
  void start_reading();
  std::vector<Bounds> read();

 private:
  Program program_;
  Buffer boxes_;
  HostBuffer copy_;
  std::size_t count_ = 0;
};

}  // namespace mercury::render
