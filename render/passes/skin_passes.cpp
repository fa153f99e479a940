// SPDX-License-Identifier: Apache-2.0
#include "render/passes/skin_passes.h"

#include <algorithm>
#include <vector>

#include "render/passes/bindings.h"
#include "render/passes/lattice_pass.h"

namespace mercury::render {
namespace {

constexpr std::size_t seen_face_bytes = 64;  // SeenFace of shaders/seen_face.glsl

void append_corners(const Ghost& ghost, std::vector<Vector4>& corners) {
  for (const std::uint32_t mass : ghost.faces) {
    const float* p = ghost.positions.data() + 3 * std::size_t{mass};
    corners.push_back({p[0] + ghost.offset.x, p[1] + ghost.offset.y, p[2] + ghost.offset.z, 1});
  }
}

// The layout of shaders/patch.vert.
struct PatchRecord {
  Vector4 disc;   // center x, y; radius; unused
  Vector4 slide;  // x, y; unused
};

}  // namespace

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
  mass_normals_.reserve(32 * bodies.mass_count());
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
  glUniform1ui(0, GLuint(2 * times_subdivided_));
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

FineSkinPass::FineSkinPass(const FineSkin& skin, int times, const std::string& defines)
    : times_(times), skin_(defines), positions_program_(make_program({"subdivide.comp"}, define("NUMBERS", 3))),
      values_program_(make_program({"subdivide.comp"}, define("NUMBERS", 1))) {
  points_.set(std::make_shared<const BodyData>(skin.bodies));
  ends_.write(skin.means.ends);
  masses_.write(skin.means.masses);
  weights_.write(skin.means.weights);
  values_.reserve(4 * points_.mass_count());
  skin_.attach(points_);
  skin_.set_subdivided(times);
}

void FineSkinPass::follow(const Bodies& bodies) const {
  bodies.positions.bind_storage(binding::positions);
  take_means(positions_program_, points_.positions);
}

void FineSkinPass::bind_values() const {
  take_means(values_program_, values_);
  values_.bind_storage(binding::mass_values);
}

void FineSkinPass::take_means(const Program& program, const Buffer& of_points) const {
  ends_.bind_storage(binding::first_free);
  masses_.bind_storage(binding::first_free + 1);
  weights_.bind_storage(binding::first_free + 2);
  of_points.bind_storage(binding::first_free + 3);
  glUseProgram(program.get());
  glUniform1ui(0, GLuint(points_.mass_count()));
  dispatch(points_.mass_count());
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT);
}

GhostPass::GhostPass() : empty_(make_vertex_array()), program_(make_program({"ghost.vert", "ghost.frag"})) {}

void GhostPass::draw(std::span<const Ghost> ghosts) {
  std::vector<Vector4> corners;
  for (const Ghost& ghost : ghosts) append_corners(ghost, corners);
  if (corners.empty()) return;
  corners_.write(corners);
  corners_.bind_storage(binding::first_free);
  glUseProgram(program_.get());
  glBindVertexArray(empty_.get());
  glEnable(GL_CULL_FACE);
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(-2, -8);  // farther: depths are reversed
  const auto draw_all = [&] {
    GLint first = 0;
    for (const Ghost& ghost : ghosts) {
      const auto light = linear_of(ghost.color);
      glUniform4f(0, light[0], light[1], light[2], ghost.opacity);
      glDrawArrays(GL_TRIANGLES, first, GLsizei(ghost.faces.size()));
      first += GLint(ghost.faces.size());
    }
  };
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  draw_all();
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthMask(GL_FALSE);
  glDepthFunc(GL_EQUAL);
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
  draw_all();
  glDisable(GL_BLEND);
  glDepthFunc(GL_GREATER);
  glDepthMask(GL_TRUE);
  glDisable(GL_POLYGON_OFFSET_FILL);
  glDisable(GL_CULL_FACE);
}

PatchPass::PatchPass() : empty_(make_vertex_array()), program_({"patch.vert", "patch.frag"}, "") {}

void PatchPass::draw(std::span<const Patch> patches, const std::string& variant) {
  if (patches.empty()) return;
  std::vector<PatchRecord> records;
  records.reserve(patches.size());
  for (const Patch& patch : patches)
    records.push_back({{patch.center.x, patch.center.y, patch.radius, 0}, {patch.slide.x, patch.slide.y, 0, 0}});
  patches_.write(records);
  patches_.bind_storage(binding::first_free);
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
  glDepthMask(GL_FALSE);
  glDisable(GL_CULL_FACE);
  glUseProgram(program_.get(variant));
  glBindVertexArray(empty_.get());
  glDrawArrays(GL_TRIANGLES, 0, GLsizei(6 * patches.size()));
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
}

}  // namespace mercury::render
