// SPDX-License-Identifier: Apache-2.0
#include "render/occlusion_pass.h"

#include "render/bindings.h"

namespace mercury::render {

OcclusionPass::OcclusionPass(const QualitySettings& settings)
    : occlusion_(make_program({"occlusion.comp"}, settings.defines())), blur_(make_program({"occlusion_blur.comp"})) {}

void OcclusionPass::resize(int width, int height) {
  width_ = (width + 1) / 2;
  height_ = (height + 1) / 2;
  rough_ = make_texture(GL_RG16F, width_, height_);
  smooth_ = make_texture(GL_RG16F, width_, height_);
}

void OcclusionPass::draw(GLuint depths, float radius) const {
  glBindTextureUnit(binding::source, depths);
  glProgramUniform1f(occlusion_.get(), 0, radius);
  compute_texels(occlusion_.get(), rough_.get(), GL_RG16F, width_, height_);
  glBindTextureUnit(binding::source, rough_.get());
  compute_texels(blur_.get(), smooth_.get(), GL_RG16F, width_, height_);
  glBindTextureUnit(binding::occlusion, smooth_.get());
}

}  // namespace mercury::render
