// SPDX-License-Identifier: Apache-2.0
// Skins of all bodies: one call for the picture, one for the shadow map, one for depth alone.
#pragma once

#include "render/bodies.h"
#include "render/cull_pass.h"
#include "render/gl_objects.h"
#include "render/program_variants.h"
#include "render/scene.h"

namespace mercury::render {

class SkinPass {
 public:
  explicit SkinPass(const std::string& defines);
  // Call when the bodies have been replaced.
  void attach(const Bodies& bodies);
  // Computes what follows from the positions and the frame's block: frames of faces, if wanted normals at masses, and
  // which faces are to be drawn. `cut`: a part of what is drawn next is cut away.
  void deform(const Bodies& bodies, bool smooth, bool cut);

  enum class ColorBy { materials, face_values, mass_values };
  // `variant`: lines of #define that tell of the scene, as shaders/skin.frag lists them.
  void draw(ColorBy color_by, const Scale& scale, const std::string& variant) const;
  // And, where there is a colour, the number of the face, counted from 1. `variant`: "" or, with a cut whose inside is
  // drawn, cut_variant; its number is the largest.
  void draw_depth(const std::string& variant) const;
  void draw_shadow() const;

 private:
  void find_mass_normals(const Bodies& bodies) const;
  void draw_seen() const;

  VertexArray corners_;
  Program face_frames_program_, mass_normals_program_, shadow_;
  ProgramVariants depth_, skin_;
  CullPass cull_;
  bool cut_ = false;
  Buffer face_frames_, face_normals_, face_areas_, mass_normals_;
};

inline constexpr const char* cut_variant = "#define CUT\n";

// Runs the current compute program, whose local size is 64, for at least `count` invocations.
void dispatch(std::size_t count);

}  // namespace mercury::render
