// SPDX-License-Identifier: Apache-2.0
// Lists of the faces that turn towards the eye and towards the key light.
#pragma once

#include <array>

#include "render/bodies.h"
#include "render/gl_objects.h"

namespace mercury::render {

class CullPass {
 public:
  CullPass();
  // Call when the bodies have been replaced.
  void attach(const Bodies& bodies);
  // From the positions, placements and frame's block bound. `all_sides`: what turns away counts, too.
  void find(const Bodies& bodies, bool all_sides);

  // Draws the triangles with the vertex array and program in use.
  void draw_seen(GLuint vertex_array) const;
  void draw_lit(GLuint vertex_array) const;
  // The face of each triangle that draw_seen() draws.
  const Buffer& seen_faces() const { return seen_faces_; }

 private:
  void draw(GLuint vertex_array, const Buffer& corners, std::size_t command) const;

  std::array<Program, 3> stages_;
  Buffer counts_, commands_, seen_corners_, lit_corners_, seen_faces_;
  bool any_ = false;
};

}  // namespace mercury::render
