// SPDX-License-Identifier: Apache-2.0
// Draws springs as bars and masses as balls.
#pragma once

#include "render/context/gl_objects.h"
#include "render/passes/scene_buffers.h"
#include "render/scene.h"

namespace mercury::render {

class LatticePass {
 public:
  explicit LatticePass(const std::string& defines);
  // Draws what Scene::show requests, into the picture or the shadow map. Uses the buffers bound for the skins.
  void draw(const Bodies& bodies, const Scene& scene);
  void draw_shadow(const Bodies& bodies, const Scene& scene);
  // How far what is drawn reaches beyond the masses [m].
  static float reach(const Bodies& bodies, const Scene& scene);
  // Draws the depth of some springs or masses, in the picture's view.
  void draw_spring_depth(const Bodies& bodies, const Scene& scene, std::size_t first, std::size_t count);
  void draw_mass_depth(const Bodies& bodies, const Scene& scene, std::size_t first, std::size_t count);

 private:
  void draw_springs(const Bodies& bodies, const Scene& scene, GLuint program);
  void draw_masses(const Bodies& bodies, const Scene& scene, GLuint program) const;

  VertexArray empty_;
  Program spring_, spring_shadow_, mass_, mass_shadow_;
  Program spring_depth_, mass_depth_;  // made when first needed
  StreamBuffer values_;
};

inline constexpr std::size_t most_quads_per_call = std::size_t(1)
                                                   << 27;  // 6 vertices each: their count fits into 32 bits

inline constexpr int colormap_entries = 256;

// Sets a uniform of the current program that maps values to texture coordinates of the color maps; shaders/values.glsl
// reads it. A scale with low == high shows the middle of the map, as color_on() does.
void set_scale(GLint location, const Scale& scale);

}  // namespace mercury::render
