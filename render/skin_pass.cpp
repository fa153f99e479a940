// SPDX-License-Identifier: Apache-2.0
#include "render/skin_pass.h"

#include <algorithm>

#include "render/bindings.h"
#include "render/lattice_pass.h"

namespace mercury::render {
namespace {

constexpr std::size_t seen_face_bytes = 64;  // SeenFace of shaders/seen_face.glsl

}  // namespace

void dispatch(std::size_t count) {
  if (count == 0) return;
  const GLuint groups = GLuint((count + 63) / 64);
  const GLuint across = std::min(groups, 32768u);
  glDispatchCompute(across, (groups + across - 1) / across, 1);
}

SkinPass::SkinPass(const std::string& defines)
    : corners_(make_vertex_array()), face_normals_program_(make_program({"face_normals.comp"})),
      mass_normals_program_(make_program({"mass_normals.comp"})),
      seen_faces_program_(make_program({"seen_faces.comp"})), shadow_(make_program({"shadow.vert", "depth.frag"})),
      depth_({"skin.vert", "surface.frag"}, define("COLOR_BY", 0)), skin_({"skin.vert", "skin.frag"}, defines) {}

void SkinPass::attach(const Bodies& bodies) {
  attach_corners(corners_.get(), bodies);
  cull_.attach(bodies);
  seen_faces_.reserve(seen_face_bytes * bodies.face_count());
  face_normals_.reserve(4 * bodies.face_count());
  face_areas_.reserve(4 * bodies.face_count());
  mass_normals_.reserve(16 * bodies.mass_count());
}

void SkinPass::deform(const Bodies& bodies, bool smooth, bool cut) {
  cut_ = cut;
  face_normals_.bind_storage(binding::face_normals);
  face_areas_.bind_storage(binding::face_areas);
  mass_normals_.bind_storage(binding::mass_normals);
  bodies.faces.bind_storage(binding::faces);
  glUseProgram(face_normals_program_.get());
  glUniform1ui(0, GLuint(bodies.face_count()));
  dispatch(bodies.face_count());
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  if (smooth) find_mass_normals(bodies);
  cull_.find(bodies, cut);
  gather_seen_faces(bodies);
}

void SkinPass::gather_seen_faces(const Bodies& bodies) const {
  seen_faces_.bind_storage(binding::seen_face_records);
  face_normals_.bind_storage(binding::face_normals);
  cull_.bind_seen();
  glUseProgram(seen_faces_program_.get());
  dispatch(bodies.face_count());
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

void SkinPass::find_mass_normals(const Bodies& bodies) const {
  bodies.mass_face_ends.bind_storage(binding::first_free);
  bodies.mass_faces.bind_storage(binding::first_free + 1);
  glUseProgram(mass_normals_program_.get());
  glUniform1ui(0, GLuint(bodies.mass_count()));
  dispatch(bodies.mass_count());
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

void SkinPass::draw_seen() const {
  seen_faces_.bind_storage(binding::seen_face_records);
  cull_.bind_seen();
  face_normals_.bind_storage(binding::face_normals);
  if (cut_) glEnable(GL_CLIP_DISTANCE0);
  cull_.draw_seen(corners_.get());
  glDisable(GL_CLIP_DISTANCE0);
}

void SkinPass::draw(ColorBy color_by, const Scale& scale, const std::string& variant) const {
  glUseProgram(skin_.get(define("COLOR_BY", int(color_by)) + variant));
  if (color_by != ColorBy::materials) set_scale(1, scale);
  draw_seen();
}

void SkinPass::draw_depth(const std::string& variant) const {
  glUseProgram(depth_.get(variant));
  draw_seen();
}

void SkinPass::draw_shadow() const {
  glUseProgram(shadow_.get());
  if (cut_) glEnable(GL_CLIP_DISTANCE0);
  cull_.draw_lit(corners_.get());
  glDisable(GL_CLIP_DISTANCE0);
}

}  // namespace mercury::render
