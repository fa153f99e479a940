// SPDX-License-Identifier: Apache-2.0
// Plants and stones on the floor (GroundCover of render/scene.h).
//
//   stage 0   per cell of a grid around what the camera looks at: whether something is there, and how high it may be
//             beside the bodies' boxes
//   stage 1   one work group: cells -> a list of plants and one of stones, and the commands for indirect drawing
//
// The grid is fixed in the world. Its cells become larger by powers of two as the camera moves away; each coarser cell
// keeps one plant or stone of its four finer ones, and the others shrink before. So nothing moves, and the number of
// things is limited. The lists are in the order of the cells, so pictures are the same from run to run.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "render/camera.h"
#include "render/context/gl_objects.h"
#include "render/context/programs.h"
#include "render/passes/visibility_passes.h"
#include "render/scene.h"
#include "render/style.h"

namespace mercury::render {

class GroundCoverPass {
 public:
  GroundCoverPass();

  // Places them, beside the boxes of bodies. The frame block and the placements are bound.
  void place(const Scene& scene, const Camera& camera, const BoundsPass& bounds, std::size_t bodies);
  // Draws them as solid things. `variant`: that of the backdrop.
  void draw(const Scene& scene, const Style& style, const std::string& variant) const;
  // Darkens the floor below them, which has been drawn.
  void draw_shades(const Scene& scene) const;

  // What stands in the picture, for tests. Waits for the GPU.
  struct Item {
    Vector3 foot;      // [m]
    float height = 0;  // [m]
    float turn = 0;    // about the vertical [rad]
    float phase = 0;   // a number in [0, 1) of its own
    float kind = 0;    // 0 = a plant, 1 = a stone
    float unused = 0;  // as the shaders have it
  };
  std::vector<Item> items() const;

 private:
  void bind() const;

  VertexArray empty_, indexed_;
  ProgramVariants place_, plant_, stone_;
  Program shade_;
  Buffer items_, lists_, commands_, indices_;
  StreamBuffer patches_;
  int placed_ = 0;  // cells
};

}  // namespace mercury::render
