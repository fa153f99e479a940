// SPDX-License-Identifier: Apache-2.0
#include "render/lattice_pass.h"

#include <algorithm>

#include "render/bindings.h"

namespace mercury::render {

void set_scale(GLint location, const Scale& scale) {
  const ScaleFactors f = factors_of(scale);
  const float inner = float(colormap_entries - 1) / float(colormap_entries);
  glUniform4f(location, inner * f.factor, inner * f.offset + 0.5f / float(colormap_entries),
              (float(scale.map) + 0.5f) / float(colormap_count), f.spacing);
}

LatticePass::LatticePass(const std::string& defines)
    : empty_(make_vertex_array()), spring_(make_program({"spring.vert", "spring.frag"}, defines)),
      spring_shadow_(make_program({"spring.vert", "depth.frag"}, "#define SHADOW\n")),
      mass_(make_program({"mass.vert", "mass.frag"}, defines)),
      mass_shadow_(make_program({"mass.vert", "mass_shadow.frag"}, "#define SHADOW\n")) {}

void LatticePass::draw_springs(const Bodies& bodies, const Scene& scene, GLuint program) {
  bodies.springs.bind_storage(binding::first_free);
  bodies.spring_materials.bind_storage(binding::first_free + 1);
  values_.write(scene.spring_values);
  values_.bind_storage(binding::first_free + 2);
  glUseProgram(program);
  glUniform1f(0, scene.spring_radius > 0 ? scene.spring_radius : 0.055f * bodies.typical_spring());
  glUniform1i(1, !scene.spring_values.empty() ? 2 : !scene.mass_values.empty() ? 1 : 0);
  set_scale(2, scene.scale);
  for (std::size_t first = 0; first < bodies.spring_count(); first += most_quads_per_call) {
    glUniform1ui(3, GLuint(first));
    glDrawArrays(GL_TRIANGLES, 0, GLsizei(6 * std::min(most_quads_per_call, bodies.spring_count() - first)));
  }
}

void LatticePass::draw_masses(const Bodies& bodies, const Scene& scene, GLuint program) const {
  glUseProgram(program);
  glUniform1f(0, scene.mass_radius > 0 ? scene.mass_radius : 0.11f * bodies.typical_spring());
  glUniform1i(1, scene.mass_values.empty() ? 0 : 1);
  set_scale(2, scene.scale);
  glDrawArrays(GL_TRIANGLES, 0, GLsizei(6 * std::min(most_quads_per_call, bodies.mass_count())));
}

void LatticePass::draw(const Bodies& bodies, const Scene& scene) {
  glBindVertexArray(empty_.get());
  if (scene.cut) glEnable(GL_CLIP_DISTANCE0);
  if (scene.show.springs) draw_springs(bodies, scene, spring_.get());
  if (scene.show.masses) draw_masses(bodies, scene, mass_.get());
  glDisable(GL_CLIP_DISTANCE0);
}

void LatticePass::draw_shadow(const Bodies& bodies, const Scene& scene) {
  glBindVertexArray(empty_.get());
  if (scene.cut) glEnable(GL_CLIP_DISTANCE0);
  glDisable(GL_CULL_FACE);
  if (scene.show.springs) draw_springs(bodies, scene, spring_shadow_.get());
  if (scene.show.masses) draw_masses(bodies, scene, mass_shadow_.get());
  glDisable(GL_CLIP_DISTANCE0);
}

}  // namespace mercury::render
