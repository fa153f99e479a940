// SPDX-License-Identifier: Apache-2.0
// Where the key light falls: the shadow map, the light on the floor, and under water the pattern of caustics.
#pragma once

#include "render/passes/quality.h"
#include "render/passes/scene_buffers.h"
#include "render/passes/screen_passes.h"
#include "render/passes/skin_passes.h"

namespace mercury::render {

class LightPass {
 public:
  explicit LightPass(const QualitySettings& settings);
  int shadow_side() const { return settings_.shadow_side; }

  // `casting`: draws what casts shadows into the bound framebuffer. Binds the shadow map.
  template <typename Casting>
  void draw_shadows(Casting casting) {
    begin_shadow();
    casting();
    end_shadow();
  }
  // Draws the floor's light map and the caustics, and binds both.
  void draw_maps(bool under_water, bool with_floor);

 private:
  void begin_shadow();
  void end_shadow();
  void draw_caustics() const;

  QualitySettings settings_;
  Texture shadow_, shadow_depths_, caustics_, sand_, ground_light_, ground_rough_;  // sand: made once it is seen
  Framebuffer shadow_framebuffer_, caustics_framebuffer_;
  VertexArray caustics_grid_;
  Buffer caustics_indices_;
  Program caustics_program_, ground_program_, ground_blur_, halve_;
};

}  // namespace mercury::render
