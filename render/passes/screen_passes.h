// SPDX-License-Identifier: Apache-2.0
// Passes that cover a whole picture: the nearest surface in each pixel before anything is shaded, ambient occlusion,
// and the finish.
#pragma once

#include <optional>
#include <string>

#include "render/context/gl_objects.h"
#include "render/context/programs.h"
#include "render/passes/quality.h"

namespace mercury::render {

// fullscreen.vert with a given fragment shader.
class Fullscreen {
 public:
  Fullscreen(std::string_view fragment_shader, const std::string& defines = "");
  GLuint program(const std::string& variant = "") const { return program_.get(variant); }
  // Draws into the bound framebuffer.
  void draw(const std::string& variant = "") const;
  // Draws into all of that framebuffer, without depth test.
  void draw_into(GLuint framebuffer, int width, int height) const;

 private:
  VertexArray empty_;
  ProgramVariants program_;
};

// The nearest surface in each pixel, one sample per pixel. At low quality: its depth at half the picture's size, for
// ambient occlusion. Else: its depth and face at the picture's size, and how much of the key light reaches it.
class FrontPass {
 public:
  explicit FrontPass(const QualitySettings& settings);
  void resize(int width, int height);  // of the picture

  // `surfaces`: draws everything except the floor: depth, and the number of the face.
  template <typename Surfaces>
  void draw(Surfaces surfaces) {
    begin();
    surfaces();
  }
  GLuint depths() const { return depths_.get(); }

  // Computes how much light reaches each surface and binds the result for the skins. Uses the normals and the maps of
  // shadows, caustics and occlusion that are bound. `variant`: defines of AROUND and OCTAVES.
  void find_light(const std::string& variant) const;

 private:
  void begin();

  bool with_light_;
  int width_ = 0, height_ = 0;
  Texture depths_, faces_, light_;
  Framebuffer framebuffer_;
  Fullscreen floor_depth_;
  std::optional<ProgramVariants> light_program_;
};

// Ambient occlusion: how much of the sky's light reaches each point of the picture, at half the picture's size.
class OcclusionPass {
 public:
  explicit OcclusionPass(const QualitySettings& settings);
  void resize(int width, int height);  // of the picture

  // `depths`: of FrontPass. `radius`: surfaces farther apart do not darken each other [m]. Binds its result.
  void draw(GLuint depths, float radius) const;

 private:
  int width_ = 0, height_ = 0;
  Texture rough_, smooth_;
  Program occlusion_, blur_;
};

// The mean of several pictures: of the same scene through a lens.
class MeanPass {
 public:
  explicit MeanPass(const QualitySettings& settings);
  void resize(int width, int height);
  // `samples`: multisampled light. `first`: it starts a mean.
  void add(GLuint samples, bool first);
  // Draws the mean of the pictures into all samples of that framebuffer.
  void draw(GLuint framebuffer, int pictures) const;

 private:
  int width_ = 0, height_ = 0;
  Texture sum_;  // made when it is first needed
  Program add_;
  Fullscreen average_;
};

// From samples of light to the finished picture: spreads the glow, applies the tone curve, averages the samples.
class FinishPass {
 public:
  explicit FinishPass(const QualitySettings& settings);
  void resize(int width, int height);
  // `samples`: multisampled light; its alpha is the share that glows. Writes gamma-encoded bytes to `picture` (RGBA8).
  void draw(GLuint samples, GLuint picture, float vignette) const;

 private:
  int width_ = 0, height_ = 0, glow_width_ = 0, glow_height_ = 0;
  Texture glow_, across_;
  Framebuffer glow_framebuffer_, across_framebuffer_;
  Fullscreen extract_, blur_;
  Program resolve_;
};

}  // namespace mercury::render
