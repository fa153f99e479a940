// SPDX-License-Identifier: Apache-2.0
#include "render/context/gl_objects.h"

#include <algorithm>

#include "render/context/context.h"
#include "render/context/programs.h"

namespace mercury::render {
namespace {

GLenum stage_of(std::string_view name) {
  if (name.ends_with(".vert")) return GL_VERTEX_SHADER;
  if (name.ends_with(".frag")) return GL_FRAGMENT_SHADER;
  return GL_COMPUTE_SHADER;
}

std::string log_of(GLuint name, bool program) {
  GLint length = 0;
  program ? glGetProgramiv(name, GL_INFO_LOG_LENGTH, &length) : glGetShaderiv(name, GL_INFO_LOG_LENGTH, &length);
  std::string log(std::size_t(std::max(length, 1)), '\0');
  program ? glGetProgramInfoLog(name, length, nullptr, log.data())
          : glGetShaderInfoLog(name, length, nullptr, log.data());
  return log.substr(0, log.find('\0'));
}

GLuint compiled(std::string_view name, const std::string& defines) {
  const std::string text = shader_text(name, defines);
  const char* data = text.c_str();
  const GLuint shader = glCreateShader(stage_of(name));
  glShaderSource(shader, 1, &data, nullptr);
  glCompileShader(shader);
  GLint good = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
  if (good) return shader;
  const std::string log = log_of(shader, false);
  glDeleteShader(shader);
  throw ContextError("the driver refuses the shader " + std::string(name) + ": " + log);
}

}  // namespace

void throw_if_gl_failed() {
  constexpr int most_flags = 16;  // a lost context reports its loss without end
  bool out_of_memory = false;
  for (int i = 0; i < most_flags; ++i) {
    const GLenum error = glGetError();
    if (error == GL_CONTEXT_LOST) throw ContextError("the GPU was reset while it drew");
    if (error == GL_OUT_OF_MEMORY) out_of_memory = true;
    if (error == GL_NO_ERROR) break;
  }
  if (out_of_memory)
    throw ContextError("the GPU has no memory left to draw with: make the picture smaller or free some memory");
}

Buffer::Buffer() {
  GLuint name = 0;
  glCreateBuffers(1, &name);
  name_ = GlName<ReleaseBuffer>(name);
  reserve(0);
}

void Buffer::reserve(std::size_t bytes) {
  size_ = bytes;
  if (bytes <= capacity_ && capacity_) return;
  capacity_ = std::max<std::size_t>(bytes, 64);
  glNamedBufferData(name_.get(), GLsizeiptr(capacity_), nullptr, GL_DYNAMIC_DRAW);
}

void Buffer::write(const void* data, std::size_t bytes) {
  reserve(bytes);
  if (bytes) glNamedBufferSubData(name_.get(), 0, GLsizeiptr(bytes), data);
}

void Buffer::bind(GLenum target, GLuint binding) const {
  if (size_ > 0)
    glBindBufferRange(target, binding, name_.get(), 0, GLsizeiptr(size_));
  else
    glBindBufferBase(target, binding, name_.get());
}

Texture make_texture(GLenum format, int width, int height, int samples, int levels) {
  GLuint name = 0;
  glCreateTextures(samples ? GL_TEXTURE_2D_MULTISAMPLE : GL_TEXTURE_2D, 1, &name);
  Texture texture(name);
  if (samples) {
    glTextureStorage2DMultisample(name, samples, format, width, height, GL_TRUE);
    return texture;
  }
  glTextureStorage2D(name, levels, format, width, height);
  glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTextureParameteri(name, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTextureParameteri(name, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return texture;
}

Framebuffer make_framebuffer(std::initializer_list<GLuint> colors, GLuint depth) {
  GLuint name = 0;
  glCreateFramebuffers(1, &name);
  Framebuffer framebuffer(name);
  std::vector<GLenum> targets;
  for (const GLuint color : colors) {
    targets.push_back(GLenum(GL_COLOR_ATTACHMENT0 + targets.size()));
    glNamedFramebufferTexture(name, targets.back(), color, 0);
  }
  if (depth) glNamedFramebufferTexture(name, GL_DEPTH_ATTACHMENT, depth, 0);
  glNamedFramebufferDrawBuffers(name, GLsizei(targets.size()), targets.data());
  if (targets.empty()) glNamedFramebufferReadBuffer(name, GL_NONE);
  if (glCheckNamedFramebufferStatus(name, GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw_if_gl_failed();
    throw ContextError("the driver cannot draw into a framebuffer of this kind");
  }
  return framebuffer;
}

VertexArray make_vertex_array() {
  GLuint name = 0;
  glCreateVertexArrays(1, &name);
  return VertexArray(name);
}

Program make_program(std::span<const std::string_view> names, const std::string& defines) {
  Program program(glCreateProgram());
  std::vector<GLuint> shaders;
  for (const std::string_view name : names) {
    shaders.push_back(compiled(name, defines));
    glAttachShader(program.get(), shaders.back());
  }
  glLinkProgram(program.get());
  for (const GLuint shader : shaders) {
    glDetachShader(program.get(), shader);
    glDeleteShader(shader);
  }
  GLint good = 0;
  glGetProgramiv(program.get(), GL_LINK_STATUS, &good);
  if (good) return program;
  throw ContextError("the driver cannot link the shader " + std::string(names.front()) + ": " +
                     log_of(program.get(), true));
}

void compute_texels(GLuint program, GLuint texture, GLenum format, int width, int height, int level) {
  // While a framebuffer is bound, NVIDIA's driver does not make what was drawn into it visible to compute programs.
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glTextureBarrier();
  glUseProgram(program);
  glBindImageTexture(0, texture, level, GL_FALSE, 0, GL_WRITE_ONLY, format);
  glDispatchCompute(GLuint((width + 7) / 8), GLuint((height + 7) / 8), 1);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
}

void dispatch(std::size_t count) {
  if (count == 0) return;
  const GLuint groups = GLuint((count + 63) / 64);
  const GLuint across = std::min(groups, 32768u);
  glDispatchCompute(across, (groups + across - 1) / across, 1);
}

}  // namespace mercury::render
