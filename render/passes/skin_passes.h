// SPDX-License-Identifier: Apache-2.0
// Draws the skins of all bodies: one call for the picture, one for the shadow map, one for depth alone. And ghosts, and
// the ground under bodies that move over it.
#pragma once

#include <span>
#include <string>

#include "render/context/gl_objects.h"
#include "render/context/programs.h"
#include "render/passes/scene_buffers.h"
#include "render/passes/visibility_passes.h"
#include "render/scene.h"
#include "render/subdivision.h"

namespace mercury::render {

class SkinPass {
 public:
  explicit SkinPass(const std::string& defines);
  // Call when the bodies have been replaced.
  void attach(const Bodies& bodies);
  // Computes from the positions and the frame block: normals of faces, and at masses if `smooth`; the lists of faces to
  // draw, and a SeenFace for each that is seen. `cut`: a plane cuts the bodies of this frame.
  void deform(const Bodies& bodies, bool smooth, bool cut);

  // Values of faces are those of the skin that this one was made from, subdivided so often.
  void set_subdivided(int times) { times_subdivided_ = times; }

  enum class ColorBy { materials, face_values, mass_values };
  // `variant`: lines of #define; shaders/skin.frag explains them.
  void draw(ColorBy color_by, const Scale& scale, const std::string& variant) const;
  // Draws depth and, into a color attachment if there is one, the number of the face, counted from 1. `variant`: "",
  // or cut_variant for the plane in place of backs that show a cut, or backs_variant for these backs themselves; with
  // both, the number is that of the body (shaders/cut.glsl).
  void draw_depth(const std::string& variant) const;
  void draw_shadow() const;

 private:
  void find_mass_normals(const Bodies& bodies) const;
  void gather_seen_faces(const Bodies& bodies) const;
  void draw_seen() const;

  VertexArray corners_;
  Program face_normals_program_, mass_normals_program_, seen_faces_program_, shadow_;
  ProgramVariants depth_, skin_;
  CullPass cull_;
  bool cut_ = false;
  int times_subdivided_ = 0;
  Buffer seen_faces_, face_normals_, face_areas_, mass_normals_;
};

// A finer skin, whose points follow the masses of all bodies.
class FineSkinPass {
 public:
  // `times`: how often it was subdivided. `defines`: as of SkinPass.
  FineSkinPass(const FineSkin& skin, int times, const std::string& defines);
  // Moves its points to where the bodies are.
  void follow(const Bodies& bodies) const;
  // Binds the values of its points, means of those of masses, which are bound.
  void bind_values() const;
  const Bodies& bodies() const { return points_; }
  SkinPass& skin() { return skin_; }
  int times() const { return times_; }

 private:
  void take_means(const Program& program, const Buffer& of_points) const;

  int times_;
  Bodies points_;
  Buffer ends_, masses_, weights_, values_;
  SkinPass skin_;
  Program positions_program_, values_program_;
};

inline constexpr const char* cut_variant = "#define CUT\n";
inline constexpr const char* backs_variant = "#define CUT\n#define BACKS\n";

// Ghosts: translucent bodies in one color, over everything else.
class GhostPass {
 public:
  GhostPass();
  // Call it last of all that has a depth, with the depth test on. A ghost is hidden by what is nearer, and where it
  // coincides with a body. Its own depth is written first, so that each pixel shows its nearest face only.
  void draw(std::span<const Ghost> ghosts);

 private:
  VertexArray empty_;
  Program program_;
  StreamBuffer corners_;
};

// Round patches of ground that move under a body (Patch of render/scene.h).
class PatchPass {
 public:
  PatchPass();
  // Draws over the ground, behind bodies. `variant`: that of the backdrop.
  void draw(std::span<const Patch> patches, const std::string& variant);

 private:
  VertexArray empty_;
  ProgramVariants program_;
  StreamBuffer patches_;
};

}  // namespace mercury::render
