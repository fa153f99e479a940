// SPDX-License-Identifier: Apache-2.0
// The nearest surface of each pixel, one sample a pixel, found before anything is shaded.
#pragma once

#include <optional>
#include <string>

#include "render/fullscreen.h"
#include "render/quality.h"

namespace mercury::render {

// At low quality only its distance, at half the picture's size, for ambient occlusion. Else at the picture's size, and
// how much of the key light reaches it.
class FrontPass {
 public:
  explicit FrontPass(const QualitySettings& settings);
  void resize(int width, int height);  // of the picture

  // `surfaces`: draws what there is besides the floor: depth, and the number of the face.
  template <typename Surfaces>
  void draw(Surfaces surfaces) {
    begin();
    surfaces();
  }
  GLuint depths() const { return depths_.get(); }

  // Finds what of the key light arrives, and binds that for the skins. Uses the shadow map and the normals bound.
  void find_light() const;

 private:
  void begin();

  bool with_light_;
  int width_ = 0, height_ = 0;
  Texture depths_, faces_, light_;
  Framebuffer framebuffer_;
  Fullscreen floor_depth_;
  std::optional<Program> light_program_;
};

}  // namespace mercury::render
