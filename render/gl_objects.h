// SPDX-License-Identifier: Apache-2.0
// Owners of OpenGL objects: made with the direct-state-access calls of OpenGL 4.5, deleted with the owner.
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

// A name that is released once. `Release` is a stateless function object.
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

  // At least that many bytes, contents undefined; never empty, so that it can always be bound.
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
  // As storage or uniform block at that binding; an array's length() in a shader is that of what was written last.
  void bind_storage(GLuint binding) const { bind(GL_SHADER_STORAGE_BUFFER, binding); }
  void bind_uniform(GLuint binding) const { bind(GL_UNIFORM_BUFFER, binding); }

 private:
  void bind(GLenum target, GLuint binding) const;

  GlName<ReleaseBuffer> name_;
  std::size_t size_ = 0, capacity_ = 0;
};

// A buffer whose contents are replaced in every picture, at most twice. Pictures that the card has not finished keep
// theirs: NVIDIA's driver has been seen to write into a storage buffer that an earlier picture was yet to read. Whoever
// draws must see to it that the picture before the last is finished.
class StreamBuffer {
 public:
  template <typename Values>
  void write(const Values& values) {
    next().write(values);
  }
  void write(const void* data, std::size_t bytes) { next().write(data, bytes); }
  // As it was written last.
  const Buffer& last() const { return ring_[current_]; }
  void bind_storage(GLuint binding) const { last().bind_storage(binding); }
  void bind_uniform(GLuint binding) const { last().bind_uniform(binding); }

 private:
  Buffer& next() { return ring_[current_ = (current_ + 1) % ring_.size()]; }

  std::array<Buffer, 4> ring_;
  std::size_t current_ = 0;
};

// A texture of one level; samples = 0 for an ordinary one. Clamped to its edge, bilinear unless it is multisampled.
Texture make_texture(GLenum format, int width, int height, int samples = 0);

// A framebuffer of those colour textures and an optional depth texture.
Framebuffer make_framebuffer(std::initializer_list<GLuint> colors, GLuint depth = 0);

VertexArray make_vertex_array();

// Compiles and links shaders/<name> for each name; the ending (.vert, .frag, .comp) tells the stage.
// `defines` are lines put below #version, as "#define SAMPLES 4\n".
// Throws ContextError with the shader's name and the driver's words.
Program make_program(std::span<const std::string_view> names, const std::string& defines = "");
inline Program make_program(std::initializer_list<std::string_view> names, const std::string& defines = "") {
  return make_program(std::span(names.begin(), names.size()), defines);
}

// Runs a compute program of 8 x 8 invocations a group once for each texel of a texture, which is its image 0.
// Leaves no framebuffer bound. Data-centre cards compute with all of their processors, but draw with few: what costs
// much a pixel goes this way.
void compute_texels(GLuint program, GLuint texture, GLenum format, int width, int height);

}  // namespace mercury::render
