// SPDX-License-Identifier: Apache-2.0
#include "render/front_pass.h"

#include "render/bindings.h"

namespace mercury::render {

FrontPass::FrontPass(const QualitySettings& settings)
    : with_light_(settings.front_light), floor_depth_("floor_depth.frag") {
  if (with_light_)
    light_program_.emplace(std::initializer_list<std::string_view>{"front_light.comp"}, settings.skin_defines());
}

void FrontPass::resize(int width, int height) {
  width_ = with_light_ ? width : (width + 1) / 2;
  height_ = with_light_ ? height : (height + 1) / 2;
  depths_ = make_texture(GL_DEPTH_COMPONENT32F, width_, height_);
  if (!with_light_) {
    framebuffer_ = make_framebuffer({}, depths_.get());
    return;
  }
  faces_ = make_texture(GL_R32UI, width_, height_);
  glTextureParameteri(faces_.get(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTextureParameteri(faces_.get(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  light_ = make_texture(GL_RG32UI, width_, height_);
  glTextureParameteri(light_.get(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTextureParameteri(light_.get(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  framebuffer_ = make_framebuffer({faces_.get()}, depths_.get());
}

void FrontPass::begin() {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.get());
  glViewport(0, 0, width_, height_);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_ALWAYS);
  floor_depth_.draw();
  glDepthFunc(GL_GREATER);
}

void FrontPass::find_light(const std::string& variant) const {
  if (!with_light_) return;
  glBindTextureUnit(binding::source, depths_.get());
  glBindTextureUnit(binding::faces_seen, faces_.get());
  compute_texels(light_program_->get(variant), light_.get(), GL_RG32UI, width_, height_);
  glBindTextureUnit(binding::front_light, light_.get());
}

}  // namespace mercury::render
