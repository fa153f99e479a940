#include "render/occlusion_pass.h"

#include "render/bindings.h"

namespace mercury::render {

OcclusionPass::OcclusionPass(const QualitySettings& settings)
    : floor_depth_("floor_depth.frag"),
      occlusion_("occlusion.frag", settings.defines()),
      blur_("occlusion_blur.frag") {}

void OcclusionPass::resize(int width, int height) {
  width_ = (width + 1) / 2;
  height_ = (height + 1) / 2;
  depths_ = make_texture(GL_DEPTH_COMPONENT32F, width_, height_);
  rough_ = make_texture(GL_RG16F, width_, height_);
  smooth_ = make_texture(GL_RG16F, width_, height_);
  depth_framebuffer_ = make_framebuffer({}, depths_.get());
  rough_framebuffer_ = make_framebuffer({rough_.get()});
  smooth_framebuffer_ = make_framebuffer({smooth_.get()});
}

void OcclusionPass::begin_depth() {
  glBindFramebuffer(GL_FRAMEBUFFER, depth_framebuffer_.get());
  glViewport(0, 0, width_, height_);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_ALWAYS);
  floor_depth_.draw();
  glDepthFunc(GL_GREATER);
}

void OcclusionPass::draw_maps(float radius) {
  glBindTextureUnit(binding::source, depths_.get());
  glProgramUniform1f(occlusion_.program(), 0, radius);
  occlusion_.draw_into(rough_framebuffer_.get(), width_, height_);
  glBindTextureUnit(binding::source, rough_.get());
  blur_.draw_into(smooth_framebuffer_.get(), width_, height_);
  glBindTextureUnit(binding::occlusion, smooth_.get());
}

}  // namespace mercury::render
