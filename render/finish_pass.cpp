// SPDX-License-Identifier: Apache-2.0
#include "render/finish_pass.h"

#include "render/bindings.h"

namespace mercury::render {

FinishPass::FinishPass(const QualitySettings& settings)
    : extract_("glow.frag"), blur_("blur.frag"), resolve_(make_program({"resolve.comp"}, settings.defines())) {}

void FinishPass::resize(int width, int height) {
  width_ = width;
  height_ = height;
  glow_width_ = (width + 3) / 4;
  glow_height_ = (height + 3) / 4;
  glow_ = make_texture(GL_RGBA16F, glow_width_, glow_height_);
  across_ = make_texture(GL_RGBA16F, glow_width_, glow_height_);
  glow_framebuffer_ = make_framebuffer({glow_.get()});
  across_framebuffer_ = make_framebuffer({across_.get()});
}

void FinishPass::draw(GLuint samples, GLuint picture, float vignette) const {
  glBindTextureUnit(binding::source, samples);
  extract_.draw_into(glow_framebuffer_.get(), glow_width_, glow_height_);
  // The glow spreads by a fiftieth of the picture's height, whatever its size.
  const float stride = float(height_) / 180.0f / 4.0f;
  glBindTextureUnit(binding::source, glow_.get());
  glProgramUniform2f(blur_.program(), 0, stride / float(glow_width_), 0);
  blur_.draw_into(across_framebuffer_.get(), glow_width_, glow_height_);
  glBindTextureUnit(binding::source, across_.get());
  glProgramUniform2f(blur_.program(), 0, 0, stride / float(glow_height_));
  blur_.draw_into(glow_framebuffer_.get(), glow_width_, glow_height_);

  glBindTextureUnit(binding::source, samples);
  glBindTextureUnit(binding::glow, glow_.get());
  glProgramUniform1f(resolve_.get(), 0, vignette);
  compute_texels(resolve_.get(), picture, GL_RGBA8, width_, height_);
  glMemoryBarrier(GL_FRAMEBUFFER_BARRIER_BIT);
}

}  // namespace mercury::render
