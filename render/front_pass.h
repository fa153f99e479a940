// SPDX-License-Identifier: Apache-2.0
// The nearest surface in each pixel, one sample per pixel, before anything is shaded.
#pragma once

#include <optional>
#include <string>

#include "render/fullscreen.h"
#include "render/program_variants.h"
#include "render/quality.h"

namespace mercury::render {

// At low quality: its depth at half the picture's size, for ambient occlusion. Else: its depth and face at the
// picture's size, and how much of the key light reaches it.
class FrontPass {
 public:
  explicit FrontPass(const QualitySettings& settings);
  void resize(int width, int height);  // of the picture

  // `surfaces`: draws everything except the floor: depth, and the number of the face.
  template <typename Surfaces>
  void draw(Surfaces surfaces) {
    begin();
    surfaces();
  }
  GLuint depths() const { return depths_.get(); }

  // Computes how much light reaches each surface and binds the result for the skins. Uses the normals and the maps of
  // shadows, caustics and occlusion that are bound. `variant`: defines of AROUND and OCTAVES.
  void find_light(const std::string& variant) const;

 private:
  void begin();

  bool with_light_;
  int width_ = 0, height_ = 0;
  Texture depths_, faces_, light_;
  Framebuffer framebuffer_;
  Fullscreen floor_depth_;
  std::optional<ProgramVariants> light_program_;
};

}  // namespace mercury::render
