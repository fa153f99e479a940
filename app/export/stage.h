// SPDX-License-Identifier: Apache-2.0
// What a scene can hold besides robots: a floor below them, and a camera that sees where they go. Formats with scenes
// write both from here.
#pragma once

#include <array>
#include <optional>

#include "app/export/exported_robot.h"
#include "render/camera.h"

namespace mercury {

// What of them is asked for.
struct StageChoices {
  bool floor = false, camera = false;
};

// A square, counter-clockwise seen from above, in the coordinates of the robots.
struct StageFloor {
  std::array<Vec3, 4> corners;
  std::array<float, 3> color;  // linear light
};

// Looks along its third axis, backward, as cameras of glTF and USD do.
struct StageCamera {
  std::array<render::Vector3, 3> axes;  // to the right, up, and back to the viewer, of length 1
  render::Vector3 eye;                  // [m]
  float field_of_view;                  // of the picture's height [rad]
  float aspect;                         // width / height of the picture
  float near, far;                      // [m]

  std::array<float, 4> quaternion() const;  // x, y, z, w: turns the axes of the scene into these
};

struct Stage {
  std::optional<StageFloor> floor;
  std::optional<StageCamera> camera;
};

// `reach`: the box around all robots at all times; empty = there is nothing to see.
Stage stage_of(const render::Bounds& reach, const Environment& environment, const StageChoices& choices);

}  // namespace mercury
