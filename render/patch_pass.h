// SPDX-License-Identifier: Apache-2.0
// Round patches of ground that move under a body (Patch of render/scene.h).
#pragma once

#include <span>
#include <string>

#include "render/gl_objects.h"
#include "render/program_variants.h"
#include "render/scene.h"

namespace mercury::render {

class PatchPass {
 public:
  PatchPass();
  // Draws over the ground, behind bodies. `variant`: that of the backdrop.
  void draw(std::span<const Patch> patches, const std::string& variant);

 private:
  VertexArray empty_;
  ProgramVariants program_;
  StreamBuffer patches_;
};

}  // namespace mercury::render
