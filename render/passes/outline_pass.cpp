// SPDX-License-Identifier: Apache-2.0
#include "render/passes/outline_pass.h"

#include <algorithm>

#include "render/passes/bindings.h"

namespace mercury::render {
namespace {

std::vector<std::uint32_t> selected_in(const Scene& scene) {
  std::vector<std::uint32_t> selected;
  for (std::size_t i = 0; i < scene.placements.size(); ++i)
    if (scene.placements[i].selected && !scene.placements[i].hidden) selected.push_back(std::uint32_t(i));
  return selected;
}

// The parts of a list that belong to these bodies; neighboring parts are joined.
struct Part {
  std::uint32_t first, end;
};
std::vector<Part> parts_of(std::span<const std::uint32_t> offsets, std::span<const std::uint32_t> bodies) {
  std::vector<Part> parts;
  for (const std::uint32_t body : bodies) {
    const Part part{offsets[body], offsets[body + 1]};
    if (part.first == part.end) continue;
    if (!parts.empty() && parts.back().end == part.first)
      parts.back().end = part.end;
    else
      parts.push_back(part);
  }
  return parts;
}

}  // namespace

OutlinePass::OutlinePass()
    : corners_(make_vertex_array()), empty_(make_vertex_array()),
      skin_(make_program({"outline_depth.vert", "depth.frag"})), line_(make_program({"outline.vert", "outline.frag"})) {
}

void OutlinePass::resize(int width, int height) {
  width_ = width;
  height_ = height;
  depth_ = Texture();
}

void OutlinePass::attach(const Bodies& bodies) {
  attach_corners(corners_.get(), bodies);
  glVertexArrayElementBuffer(corners_.get(), bodies.faces.get());
}

void OutlinePass::draw_depth(const Bodies& bodies, const Scene& scene, LatticePass& lattice,
                             std::span<const std::uint32_t> selected) const {
  const float nothing = 0;
  glClearNamedFramebufferfv(depth_framebuffer_.get(), GL_DEPTH, 0, &nothing);
  glBindFramebuffer(GL_FRAMEBUFFER, depth_framebuffer_.get());
  glViewport(0, 0, width_, height_);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GREATER);
  glDisable(GL_CULL_FACE);
  if (scene.show.skin) {
    std::vector<GLsizei> counts;
    std::vector<const void*> begins;
    for (const Part& part : parts_of(bodies.face_offsets(), selected)) {
      counts.push_back(GLsizei(3 * (part.end - part.first)));
      begins.push_back(reinterpret_cast<const void*>(std::size_t(12) * part.first));
    }
    if (scene.cut) glEnable(GL_CLIP_DISTANCE0);
    glUseProgram(skin_.get());
    glBindVertexArray(corners_.get());
    glMultiDrawElements(GL_TRIANGLES, counts.data(), GL_UNSIGNED_INT, begins.data(), GLsizei(counts.size()));
    glDisable(GL_CLIP_DISTANCE0);
  }
  if (scene.show.springs)
    for (const Part& part : parts_of(bodies.spring_offsets(), selected))
      lattice.draw_spring_depth(bodies, scene, part.first, part.end - part.first);
  if (scene.show.masses)
    for (const Part& part : parts_of(bodies.mass_offsets(), selected))
      lattice.draw_mass_depth(bodies, scene, part.first, part.end - part.first);
}

void OutlinePass::draw_lines(const Buffer& boxes, const Targets& targets, std::size_t count, float reach) {
  const float nothing = 0;
  glClearNamedFramebufferfv(line_framebuffer_.get(), GL_DEPTH, 0, &nothing);
  glBindFramebuffer(GL_FRAMEBUFFER, line_framebuffer_.get());
  glBindTextureUnit(0, depth_.get());
  glBindTextureUnit(1, targets.depth.get());
  boxes.bind_storage(binding::first_free);
  selected_.bind_storage(binding::first_free + 1);
  glEnable(GL_FRAMEBUFFER_SRGB);
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
  glUseProgram(line_.get());
  const float width = std::max(2.0f, float(height_) / 300);
  glUniform2f(0, width, std::max(1.0f, 0.5f * width));
  glUniform1f(1, reach);
  glBindVertexArray(empty_.get());
  // The depth test lets every pixel be drawn once, although rectangles overlap.
  glDrawArrays(GL_TRIANGLES, 0, GLsizei(6 * count));
  glDisable(GL_BLEND);
  glDisable(GL_FRAMEBUFFER_SRGB);
}

void OutlinePass::draw(const Bodies& bodies, const Scene& scene, LatticePass& lattice, const Buffer& boxes,
                       const Targets& targets) {
  const std::vector<std::uint32_t> selected = selected_in(scene);
  if (selected.empty()) return;
  if (!depth_ || picture_ != targets.picture.get()) {
    depth_ = make_texture(GL_DEPTH_COMPONENT32F, width_, height_);
    drawn_ = make_texture(GL_DEPTH_COMPONENT16, width_, height_);
    depth_framebuffer_ = make_framebuffer({}, depth_.get());
    line_framebuffer_ = make_framebuffer({targets.picture.get()}, drawn_.get());
    picture_ = targets.picture.get();
  }
  selected_.write(selected);
  attach(bodies);
  draw_depth(bodies, scene, lattice, selected);
  draw_lines(boxes, targets, selected.size(), LatticePass::reach(bodies, scene));
}

}  // namespace mercury::render
