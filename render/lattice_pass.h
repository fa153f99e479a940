// SPDX-License-Identifier: Apache-2.0
// Springs as bars and masses as balls.
#pragma once

#include "render/bodies.h"
#include "render/gl_objects.h"
#include "render/scene.h"

namespace mercury::render {

class LatticePass {
 public:
  explicit LatticePass(const std::string& defines);
  // What Scene::show asks for, into the picture or the shadow map. Uses the buffers bound for the skins.
  void draw(const Bodies& bodies, const Scene& scene);
  void draw_shadow(const Bodies& bodies, const Scene& scene);

 private:
  void draw_springs(const Bodies& bodies, const Scene& scene, GLuint program);
  void draw_masses(const Bodies& bodies, const Scene& scene, GLuint program) const;

  VertexArray empty_;
  Program spring_, spring_shadow_, mass_, mass_shadow_;
  StreamBuffer values_;
};

inline constexpr std::size_t most_quads_a_call = std::size_t(1) << 27;  // 6 vertices each still count within 32 bits

inline constexpr int colormap_entries = 256;

// Tells the program in use how values become places in the texture of colour maps: x = value * [0] + [1], y = [2].
// An empty scale shows its middle, as color_at() does.
void set_scale(GLint location, const Scale& scale);

}  // namespace mercury::render
