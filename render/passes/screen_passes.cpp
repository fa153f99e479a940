// SPDX-License-Identifier: Apache-2.0
#include "render/passes/screen_passes.h"

#include "render/passes/bindings.h"

namespace mercury::render {

Fullscreen::Fullscreen(std::string_view fragment_shader, const std::string& defines)
    : empty_(make_vertex_array()), program_({"fullscreen.vert", fragment_shader}, defines) {}

void Fullscreen::draw(const std::string& variant) const {
  glUseProgram(program_.get(variant));
  glBindVertexArray(empty_.get());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

void Fullscreen::draw_into(GLuint framebuffer, int width, int height) const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glViewport(0, 0, width, height);
  glDisable(GL_DEPTH_TEST);
  draw();
}

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

MeanPass::MeanPass(const QualitySettings& settings)
    : add_(make_program({"accumulate.comp"}, settings.defines())), average_("average.frag") {}

void MeanPass::resize(int width, int height) {
  width_ = width;
  height_ = height;
  sum_ = {};
}

void MeanPass::add(GLuint samples, bool first) {
  if (!sum_) sum_ = make_texture(GL_RGBA32F, width_, height_);
  glBindTextureUnit(binding::source, samples);
  glProgramUniform1i(add_.get(), 0, first ? 1 : 0);
  compute_texels(add_.get(), sum_.get(), GL_RGBA32F, width_, height_);
}

void MeanPass::draw(GLuint framebuffer, int pictures) const {
  glBindTextureUnit(binding::source, sum_.get());
  glProgramUniform1f(average_.program(), 0, 1 / float(pictures));
  average_.draw_into(framebuffer, width_, height_);
}

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
