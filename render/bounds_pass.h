// SPDX-License-Identifier: Apache-2.0
// The box around each body, computed on the GPU, where the positions are.
#pragma once

#include <vector>

#include "render/bodies.h"
#include "render/camera.h"
#include "render/host_buffer.h"

namespace mercury::render {

class BoundsPass {
 public:
  BoundsPass();
  // From the positions bound as storage. A body without a finite mass has an empty box.
  void measure(const Bodies& bodies);
  // On the GPU, for later shaders: low and high corner of each body, as vec4.
  const Buffer& boxes() const { return boxes_; }

  // Starts a copy of the boxes to the CPU. read() waits for the copy, but not for what was drawn after it.
  void start_reading();
  std::vector<Bounds> read();

 private:
  Program program_;
  Buffer boxes_;
  HostBuffer copy_;
  std::size_t count_ = 0;
};

}  // namespace mercury::render
