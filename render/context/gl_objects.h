// SPDX-License-Identifier: Apache-2.0
// RAII owners of OpenGL objects, made with the direct state access of OpenGL 4.5.
#pragma once

#include <epoxy/gl.h>

#include <array>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace mercury::render {

// Throws ContextError, with one line, if the current context has run out of memory or has lost its GPU since the
// last call: what was drawn since then is wrong. Other errors are for Context::take_messages().
void throw_if_gl_failed();

// The name of an object; the destructor releases it. `Release` is a stateless function object.
template <typename Release>
class GlName {
 public:
  GlName() = default;
  explicit GlName(GLuint name) : name_(name) {}
  GlName(GlName&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  GlName& operator=(GlName&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  ~GlName() {
    if (name_) Release{}(name_);
  }
  GLuint get() const { return name_; }
  explicit operator bool() const { return name_ != 0; }
  GLuint release() { return std::exchange(name_, 0); }  // the caller owns the object

 private:
  GLuint name_ = 0;
};

struct ReleaseTexture {
  void operator()(GLuint name) const { glDeleteTextures(1, &name); }
};
struct ReleaseFramebuffer {
  void operator()(GLuint name) const { glDeleteFramebuffers(1, &name); }
};
struct ReleaseBuffer {
  void operator()(GLuint name) const { glDeleteBuffers(1, &name); }
};
struct ReleaseVertexArray {
  void operator()(GLuint name) const { glDeleteVertexArrays(1, &name); }
};
struct ReleaseProgram {
  void operator()(GLuint name) const { glDeleteProgram(name); }
};

using Texture = GlName<ReleaseTexture>;
using Framebuffer = GlName<ReleaseFramebuffer>;
using VertexArray = GlName<ReleaseVertexArray>;
using Program = GlName<ReleaseProgram>;

// A buffer that grows when more is written to it than it holds.
class Buffer {
 public:
  Buffer();
  GLuint get() const { return name_.get(); }
  std::size_t size() const { return size_; }  // bytes written or reserved last

  // Reserves at least that many bytes with undefined contents. A buffer is never empty, so it can always be bound.
  void reserve(std::size_t bytes);
  // Replaces the contents.
  void write(const void* data, std::size_t bytes);
  template <typename T>
  void write(std::span<const T> values) {
    write(values.data(), values.size_bytes());
  }
  template <typename T>
  void write(const std::vector<T>& values) {
    write(values.data(), values.size() * sizeof(T));
  }
  // Binds it as storage or uniform block. The length() of its array in a shader is that of the last write.
  void bind_storage(GLuint binding) const { bind(GL_SHADER_STORAGE_BUFFER, binding); }
  void bind_uniform(GLuint binding) const { bind(GL_UNIFORM_BUFFER, binding); }

 private:
  void bind(GLenum target, GLuint binding) const;

  GlName<ReleaseBuffer> name_;
  std::size_t size_ = 0, capacity_ = 0;
};

// A buffer whose contents are replaced at most twice per frame. It is a ring of four, because pictures that the GPU
// has not finished must keep their contents: NVIDIA's driver has been observed to write into a storage buffer that an
// earlier frame had not read yet. Before drawing, make sure that the picture before the last is finished (Pace).
class StreamBuffer {
 public:
  template <typename Values>
  void write(const Values& values) {
    next().write(values);
  }
  void write(const void* data, std::size_t bytes) { next().write(data, bytes); }
  // The buffer of the last write.
  const Buffer& last() const { return ring_[current_]; }
  void bind_storage(GLuint binding) const { last().bind_storage(binding); }
  void bind_uniform(GLuint binding) const { last().bind_uniform(binding); }

 private:
  Buffer& next() { return ring_[current_ = (current_ + 1) % ring_.size()]; }

  std::array<Buffer, 4> ring_;
  std::size_t current_ = 0;
};

// A texture; samples > 0 = multisampled. Others are clamped to the edge and bilinear.
Texture make_texture(GLenum format, int width, int height, int samples = 0, int levels = 1);

// A framebuffer with these color textures and an optional depth texture.
Framebuffer make_framebuffer(std::initializer_list<GLuint> colors, GLuint depth = 0);

VertexArray make_vertex_array();

// Compiles and links shaders/<name> for each name; the extension (.vert, .frag, .comp) is the stage. `defines` are
// lines below #version, such as "#define SAMPLES 4\n". Throws ContextError with the shader's name and the driver's
// message.
Program make_program(std::span<const std::string_view> names, const std::string& defines = "");
inline Program make_program(std::initializer_list<std::string_view> names, const std::string& defines = "") {
  return make_program(std::span(names.begin(), names.size()), defines);
}

// Runs a compute program with groups of 8 x 8 invocations, one invocation per texel of a level of a texture, which is
// its image 0. Leaves no framebuffer bound. Work that is expensive per pixel is done this way, because GPUs for data
// centers compute with all of their multiprocessors but draw with few.
void compute_texels(GLuint program, GLuint texture, GLenum format, int width, int height, int level = 0);

// Runs the current compute program, with a local size of 64, for at least `count` invocations.
void dispatch(std::size_t count);

}  // namespace mercury::render
