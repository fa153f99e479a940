// The boxes around bodies, found where their positions lie.
#pragma once

#include <vector>

#include "render/bodies.h"
#include "render/camera.h"

namespace mercury::render {

class BoundsPass {
 public:
  BoundsPass();
  // Reads the positions bound for storage; waits for the card. A body without a finite mass has an empty box.
  std::vector<Bounds> measure(const Bodies& bodies);

 private:
  Program program_;
  Buffer boxes_;
};

}  // namespace mercury::render
