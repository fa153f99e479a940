// SPDX-License-Identifier: Apache-2.0
#include "render/overlay_pass.h"

#include <png.h>

#include <stdexcept>
#include <vector>

#include "render/bindings.h"
#include "render/font.h"

namespace mercury::render {
namespace {

Texture make_atlas() {
  const auto file = font_data().png;
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  std::vector<std::uint8_t> texels;
  if (png_image_begin_read_from_memory(&png, file.data(), file.size())) {
    png.format = PNG_FORMAT_GRAY;
    texels.resize(PNG_IMAGE_SIZE(png));
    if (!png_image_finish_read(&png, nullptr, texels.data(), 0, nullptr)) texels.clear();
  }
  if (texels.empty()) throw std::logic_error("the built-in font cannot be read");
  Texture atlas = make_texture(GL_R8, int(png.width), int(png.height));
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(atlas.get(), 0, 0, 0, GLsizei(png.width), GLsizei(png.height), GL_RED, GL_UNSIGNED_BYTE,
                      texels.data());
  return atlas;
}

}  // namespace

OverlayPass::OverlayPass()
    : empty_(make_vertex_array()), program_(make_program({"overlay.vert", "overlay.frag"})), atlas_(make_atlas()) {}

void OverlayPass::draw(const Overlay& overlay, GLuint framebuffer, int width, int height, GLuint colormaps) {
  if (overlay.quads().empty()) return;
  quads_.write(overlay.quads());
  quads_.bind_storage(binding::first_free);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glViewport(0, 0, width, height);
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_FRAMEBUFFER_SRGB);
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
  glUseProgram(program_.get());
  glUniform2f(0, float(width), float(height));
  glBindTextureUnit(0, atlas_.get());
  glBindTextureUnit(1, colormaps);
  glBindVertexArray(empty_.get());
  glDrawArrays(GL_TRIANGLES, 0, GLsizei(6 * overlay.quads().size()));
  glDisable(GL_BLEND);
  glDisable(GL_FRAMEBUFFER_SRGB);
}

}  // namespace mercury::render
