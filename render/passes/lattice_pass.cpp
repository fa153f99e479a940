// SPDX-License-Identifier: Apache-2.0
#include "render/passes/lattice_pass.h"

#include <algorithm>

#include "render/passes/bindings.h"

namespace mercury::render {
namespace {

float spring_radius(const Bodies& bodies, const Scene& scene) {
  return scene.spring_radius > 0 ? scene.spring_radius : 0.055f * bodies.typical_spring();
}

float mass_radius(const Bodies& bodies, const Scene& scene) {
  return scene.mass_radius > 0 ? scene.mass_radius : 0.11f * bodies.typical_spring();
}

}  // namespace

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
  glUniform1f(0, spring_radius(bodies, scene));
  glUniform1i(1, !scene.spring_values.empty() ? 2 : !scene.mass_values.empty() ? 1 : 0);
  set_scale(2, scene.scale);
  for (std::size_t first = 0; first < bodies.spring_count(); first += most_quads_per_call) {
    glUniform1ui(3, GLuint(first));
    glDrawArrays(GL_TRIANGLES, 0, GLsizei(6 * std::min(most_quads_per_call, bodies.spring_count() - first)));
  }
}

float LatticePass::reach(const Bodies& bodies, const Scene& scene) {
  // A muscle swells as it shortens, see spring.vert.
  return std::max(scene.show.springs ? 1.25f * spring_radius(bodies, scene) : 0,
                  scene.show.masses ? mass_radius(bodies, scene) : 0);
}

void LatticePass::draw_spring_depth(const Bodies& bodies, const Scene& scene, std::size_t first, std::size_t count) {
  if (!spring_depth_) spring_depth_ = make_program({"spring.vert", "depth.frag"});
  glBindVertexArray(empty_.get());
  bodies.springs.bind_storage(binding::first_free);
  bodies.spring_materials.bind_storage(binding::first_free + 1);
  glUseProgram(spring_depth_.get());
  glUniform1f(0, spring_radius(bodies, scene));
  glUniform1i(1, 0);
  if (scene.cut) glEnable(GL_CLIP_DISTANCE0);
  for (const std::size_t end = first + count; first < end; first += most_quads_per_call) {
    glUniform1ui(3, GLuint(first));
    glDrawArrays(GL_TRIANGLES, 0, GLsizei(6 * std::min(most_quads_per_call, end - first)));
  }
  glDisable(GL_CLIP_DISTANCE0);
}

void LatticePass::draw_mass_depth(const Bodies& bodies, const Scene& scene, std::size_t first, std::size_t count) {
  if (!mass_depth_) mass_depth_ = make_program({"mass.vert", "mass_shadow.frag"});
  glBindVertexArray(empty_.get());
  glUseProgram(mass_depth_.get());
  glUniform1f(0, mass_radius(bodies, scene));
  glUniform1i(1, 0);
  if (scene.cut) glEnable(GL_CLIP_DISTANCE0);
  const std::size_t most = std::min(first + count, most_quads_per_call);
  if (first < most) glDrawArrays(GL_TRIANGLES, GLint(6 * first), GLsizei(6 * (most - first)));
  glDisable(GL_CLIP_DISTANCE0);
}

void LatticePass::draw_masses(const Bodies& bodies, const Scene& scene, GLuint program) const {
  glUseProgram(program);
  glUniform1f(0, mass_radius(bodies, scene));
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
