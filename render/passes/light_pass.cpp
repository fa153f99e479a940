// SPDX-License-Identifier: Apache-2.0
#include "render/passes/light_pass.h"

#include <vector>

#include "render/passes/bindings.h"

namespace mercury::render {
namespace {

constexpr int sand_side = 512;

// 65,536 steps over the depth that the map covers are finer than its texels.
constexpr GLenum shadow_format = GL_DEPTH_COMPONENT16;

Texture make_tile(GLenum format, int side) {
  GLuint name = 0;
  glCreateTextures(GL_TEXTURE_2D, 1, &name);
  Texture tile(name);
  int levels = 1;
  while ((side >> levels) > 0) ++levels;
  glTextureStorage2D(name, levels, format, side, side);
  glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  return tile;
}

// Fills the coarser levels of a square texture. Mesa compiles the shader of glGenerateTextureMipmap() in each process
// from scratch, and finds this one in its cache.
void fill_levels(const Program& halve, GLuint texture, GLenum format, int side) {
  glBindTextureUnit(binding::source, texture);
  for (int level = 1; (side >> level) > 0; ++level) {
    glProgramUniform1i(halve.get(), 0, level - 1);
    compute_texels(halve.get(), texture, format, side >> level, side >> level, level);
  }
}

Texture make_sand(const Program& halve) {
  Texture sand = make_tile(GL_RGBA8, sand_side);
  const Framebuffer framebuffer = make_framebuffer({sand.get()});
  glDisable(GL_BLEND);
  const bool culls = glIsEnabled(GL_CULL_FACE);
  glDisable(GL_CULL_FACE);
  Fullscreen("sand.frag").draw_into(framebuffer.get(), sand_side, sand_side);
  if (culls) glEnable(GL_CULL_FACE);
  fill_levels(halve, sand.get(), GL_RGBA8, sand_side);
  return sand;
}

std::vector<GLuint> grid_indices(int cells) {
  std::vector<GLuint> indices;
  const GLuint row = GLuint(cells + 1);
  for (GLuint y = 0; y < GLuint(cells); ++y)
    for (GLuint x = 0; x < GLuint(cells); ++x) {
      const GLuint corner = y * row + x;
      indices.insert(indices.end(), {corner, corner + 1, corner + row, corner + row, corner + 1, corner + row + 1});
    }
  return indices;
}

// The same texels through a comparing sampler.
Texture comparing_view(GLuint depths) {
  GLuint name = 0;
  glGenTextures(1, &name);
  Texture view(name);
  glTextureView(name, GL_TEXTURE_2D, depths, shadow_format, 0, 1, 0, 1);
  glTextureParameteri(name, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  glTextureParameteri(name, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTextureParameteri(name, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTextureParameteri(name, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return view;
}

}  // namespace

LightPass::LightPass(const QualitySettings& settings)
    : settings_(settings), shadow_depths_(make_texture(shadow_format, settings.shadow_side, settings.shadow_side)),
      caustics_(make_tile(GL_R16F, settings.caustics_side)),
      ground_light_(make_texture(GL_R16F, settings.ground_side, settings.ground_side)),
      ground_rough_(make_texture(GL_R16F, settings.ground_side, settings.ground_side)),
      caustics_grid_(make_vertex_array()), caustics_program_(make_program({"caustics.vert", "caustics.frag"})),
      ground_program_(make_program({"ground_light.comp"}, settings.defines())),
      ground_blur_(make_program({"ground_blur.comp"})), halve_(make_program({"halve.comp"})) {
  glTextureParameteri(shadow_depths_.get(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTextureParameteri(shadow_depths_.get(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  shadow_ = comparing_view(shadow_depths_.get());
  shadow_framebuffer_ = make_framebuffer({}, shadow_depths_.get());
  caustics_indices_.write(grid_indices(settings.caustics_cells));
  glVertexArrayElementBuffer(caustics_grid_.get(), caustics_indices_.get());
  caustics_framebuffer_ = make_framebuffer({caustics_.get()});
}

// A grid of light rays, bent by the waves, is drawn where the rays arrive. Where the grid folds over itself, light adds
// up.
void LightPass::draw_caustics() const {
  const float dark = 0;
  glClearNamedFramebufferfv(caustics_framebuffer_.get(), GL_COLOR, 0, &dark);
  glBindFramebuffer(GL_FRAMEBUFFER, caustics_framebuffer_.get());
  glViewport(0, 0, settings_.caustics_side, settings_.caustics_side);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  glUseProgram(caustics_program_.get());
  glUniform1i(0, settings_.caustics_cells);
  glUniform1f(1, float(settings_.caustics_side));
  glBindVertexArray(caustics_grid_.get());
  const int cells = settings_.caustics_cells;
  glDrawElements(GL_TRIANGLES, 6 * cells * cells, GL_UNSIGNED_INT, nullptr);
  glDisable(GL_BLEND);
  // The finest level is ragged where few rays cross, so sampling starts at the next one.
  glTextureParameteri(caustics_.get(), GL_TEXTURE_BASE_LEVEL, 0);
  fill_levels(halve_, caustics_.get(), GL_R16F, settings_.caustics_side);
  glTextureParameteri(caustics_.get(), GL_TEXTURE_BASE_LEVEL, 1);
}

void LightPass::begin_shadow() {
  glBindFramebuffer(GL_FRAMEBUFFER, shadow_framebuffer_.get());
  glViewport(0, 0, settings_.shadow_side, settings_.shadow_side);
  const float farthest = 1;
  glClearNamedFramebufferfv(shadow_framebuffer_.get(), GL_DEPTH, 0, &farthest);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glEnable(GL_DEPTH_CLAMP);
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(1.5f, 2.0f);
}

void LightPass::end_shadow() {
  glDisable(GL_DEPTH_CLAMP);
  glDisable(GL_POLYGON_OFFSET_FILL);
  glBindTextureUnit(binding::shadow_map, shadow_.get());
  glBindTextureUnit(binding::shadow_depths, shadow_depths_.get());
}

void LightPass::draw_maps(bool under_water, bool with_floor) {
  if (under_water) draw_caustics();
  if (with_floor) {
    if (!sand_) sand_ = make_sand(halve_);
    const int side = settings_.ground_side;
    compute_texels(ground_program_.get(), ground_rough_.get(), GL_R16F, side, side);
    glBindTextureUnit(binding::source, ground_rough_.get());
    compute_texels(ground_blur_.get(), ground_light_.get(), GL_R16F, side, side);
  }
  glBindTextureUnit(binding::caustics, caustics_.get());
  glBindTextureUnit(binding::sand, sand_.get());
  glBindTextureUnit(binding::ground_light, ground_light_.get());
}

}  // namespace mercury::render
