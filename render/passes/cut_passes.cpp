// SPDX-License-Identifier: Apache-2.0
#include "render/passes/cut_passes.h"

#include <algorithm>
#include <array>

#include "render/passes/bindings.h"
#include "render/passes/lattice_pass.h"

namespace mercury::render {
namespace {

constexpr float reach_of_springs = 1.6f;  // [typical spring lengths]; farther from any spring, the inside is plain gray

}  // namespace

CutPass::CutPass() : program_(make_program({"cut_planes.comp"})) {}

void CutPass::find(Bodies& bodies, const Cut& cut) const {
  if (bodies.body_count() == 0) return;
  bodies.write_rest();
  bodies.rest_positions.bind_storage(binding::first_free);
  bodies.first_masses.bind_storage(binding::first_free + 1);
  glUseProgram(program_.get());
  glUniform1i(0, cut.axis);
  glUniform1i(1, cut.below ? 1 : 0);
  glUniform1f(2, cut.percent / 100);
  glUniform1f(3, cut.shift);
  glDispatchCompute(GLuint(bodies.body_count()), 1, 1);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

SectionPass::SectionPass() : empty_(make_vertex_array()), program_(make_program({"section.vert", "section.frag"})) {}

void SectionPass::resize(int width, int height) {
  width_ = width;
  height_ = height;
  colors_ = Texture();
}

// Prepares the map of nearest surfaces.
void SectionPass::begin() {
  if (!colors_) {
    colors_ = make_texture(GL_RGBA16F, width_, height_);
    bodies_ = make_texture(GL_R32UI, width_, height_);
    glTextureParameteri(bodies_.get(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTextureParameteri(bodies_.get(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    nearness_ = make_texture(GL_DEPTH_COMPONENT32F, width_, height_);
    framebuffer_ = make_framebuffer({colors_.get()}, nearness_.get());
    bodies_framebuffer_ = make_framebuffer({bodies_.get()}, nearness_.get());
  }
  const std::array<GLuint, 4> none{};
  const float nothing = 0;
  glClearNamedFramebufferuiv(bodies_framebuffer_.get(), GL_COLOR, 0, none.data());
  glClearNamedFramebufferfv(bodies_framebuffer_.get(), GL_DEPTH, 0, &nothing);
  glBindFramebuffer(GL_FRAMEBUFFER, bodies_framebuffer_.get());
  glViewport(0, 0, width_, height_);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GREATER);
}

void SectionPass::bind() const { glBindTextureUnit(binding::faces_seen, bodies_.get()); }

void SectionPass::draw(const Bodies& bodies, const Scene& scene) {
  const std::array<float, 4> plain{0.35f, 0.35f, 0.35f, 0};
  const float nothing = 0;
  glClearNamedFramebufferfv(framebuffer_.get(), GL_COLOR, 0, plain.data());
  glClearNamedFramebufferfv(framebuffer_.get(), GL_DEPTH, 0, &nothing);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.get());
  glViewport(0, 0, width_, height_);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GREATER);
  glDisable(GL_CULL_FACE);
  bind();
  bodies.springs.bind_storage(binding::first_free);
  bodies.spring_materials.bind_storage(binding::first_free + 1);
  glUseProgram(program_.get());
  glBindVertexArray(empty_.get());
  glUniform1f(0, reach_of_springs * bodies.typical_spring());
  glUniform1i(1, !scene.mass_values.empty() ? 1 : !scene.face_values.empty() ? 2 : 0);
  set_scale(2, scene.scale);
  for (std::size_t first = 0; first < bodies.spring_count(); first += most_quads_per_call) {
    glUniform1ui(3, GLuint(first));
    glDrawArrays(GL_TRIANGLES, 0, GLsizei(3 * std::min(most_quads_per_call, bodies.spring_count() - first)));
  }
  glBindTextureUnit(binding::section, colors_.get());
}

}  // namespace mercury::render
