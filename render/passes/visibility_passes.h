// SPDX-License-Identifier: Apache-2.0
// What the picture and its light have to show, found on the GPU: the boxes of bodies, what the shadow map covers, and
// the lists of the faces that turn toward the eye and of those that turn toward the key light.
//
//   stage 0   one work group per 256 faces: counts the faces of each list
//   stage 1   one work group: counts -> offsets, and the commands for indirect drawing
//   stage 2   one work group per 256 faces: writes the faces into the lists, in their order
//
// The rate at which a GPU sets up triangles limits pictures of many bodies; half of the triangles of a closed skin turn
// away. The order of the lists is that of the faces, so pictures are the same from run to run.
#pragma once

#include <array>
#include <vector>

#include "render/camera.h"
#include "render/context/buffers.h"
#include "render/context/gl_objects.h"
#include "render/passes/scene_buffers.h"

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

// The box around each body, computed on the GPU, where the positions are.
class BoundsPass {
 public:
  BoundsPass();
  // From the positions bound as storage. A body without a finite mass has an empty box.
  void measure(const Bodies& bodies);
  // On the GPU, for later shaders: low and high corner of each body, as vec4.
  const Buffer& boxes() const { return boxes_; }

  // Starts a copy of the boxes to the CPU. read() waits for the copy, but not for what was drawn after it.
  void start_reading();
  std::vector<Bounds> read();

 private:
  Program program_;
  Buffer boxes_;
  HostBuffer copy_;
  std::size_t count_ = 0;
};

// What the shadow map and the floor's light map cover, computed from the bodies' boxes on the GPU.
class FitPass {
 public:
  FitPass();
  // Fills in `shadow`, `shadow_size`, `ground` and the height of the highest body in the FrameBlock in `frame`, from
  // the boxes of BoundsPass and the placements bound as storage. Sides in texels.
  void fit(const Buffer& frame, const Buffer& boxes, std::size_t bodies, int shadow_side, int ground_side) const;

 private:
  Program program_;
};

}  // namespace mercury::render
