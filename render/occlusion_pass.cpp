#include "render/occlusion_pass.h"

#include "render/bindings.h"

namespace mercury::render {

OcclusionPass::OcclusionPass(const QualitySettings& settings)
    : occlusion_("occlusion.frag", settings.defines()), blur_("occlusion_blur.frag") {}

void OcclusionPass::resize(int width, int height) {
  width_ = (width + 1) / 2;
  height_ = (height + 1) / 2;
  rough_ = make_texture(GL_RG16F, width_, height_);
  smooth_ = make_texture(GL_RG16F, width_, height_);
  rough_framebuffer_ = make_framebuffer({rough_.get()});
  smooth_framebuffer_ = make_framebuffer({smooth_.get()});
}

void OcclusionPass::draw(GLuint depths, float radius) const {
  glBindTextureUnit(binding::source, depths);
  glProgramUniform1f(occlusion_.program(), 0, radius);
  occlusion_.draw_into(rough_framebuffer_.get(), width_, height_);
  glBindTextureUnit(binding::source, rough_.get());
  blur_.draw_into(smooth_framebuffer_.get(), width_, height_);
  glBindTextureUnit(binding::occlusion, smooth_.get());
}

}  // namespace mercury::render
