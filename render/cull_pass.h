// SPDX-License-Identifier: Apache-2.0
// Lists of the faces that turn towards the eye and of those that turn towards the key light, made on the GPU.
//
//   stage 0   one work group per 256 faces: counts the faces of each list
//   stage 1   one work group: counts -> offsets, and the commands for indirect drawing
//   stage 2   one work group per 256 faces: writes the faces into the lists, in their order
//
// The rate at which a GPU sets up triangles limits pictures of many bodies; half of the triangles of a closed skin turn
// away. The order of the lists is that of the faces, so pictures are the same from run to run.
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
  // From the positions, placements and frame block that are bound. `all_sides`: lists also faces that turn away.
  void find(const Bodies& bodies, bool all_sides);

  // Draws the triangles with the vertex array and program in use.
  void draw_seen(GLuint vertex_array) const;
  void draw_lit(GLuint vertex_array) const;
  // Binds the command of draw_seen() and the numbers of the faces that it draws.
  void bind_seen() const;

 private:
  void draw(GLuint vertex_array, const Buffer& corners, std::size_t command) const;

  std::array<Program, 3> stages_;
  Buffer counts_, commands_, seen_corners_, lit_corners_, seen_faces_;
  bool any_ = false;
};

}  // namespace mercury::render
