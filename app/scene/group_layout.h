// SPDX-License-Identifier: Apache-2.0
// Where the robots of a group stand in the picture.
#pragma once

#include <Eigen/Core>

#include <optional>
#include <span>
#include <vector>

#include "mercury/robot.h"
#include "render/camera.h"

namespace mercury {

// The box around a robot at rest.
render::Bounds rest_bounds(const Robot& robot);

struct Grid {
  int columns = 1, rows = 1;
};

// The number of columns and rows for `count` cells of that width over height that fills a picture best.
Grid grid_for(std::size_t count, float picture_aspect, float cell_aspect);

enum class Layout {
  grid,
  race,  // one lane a robot, side by side across the picture
};

struct LayoutOptions {
  Layout layout = Layout::grid;
  std::optional<Grid> grid;  // absent = grid_for
  float spacing = 1.45f;     // size of a cell over that of the largest robot of its row and column
  float aspect = 16.0f / 9;  // of the picture
  render::Orbit view;        // its angles are those that the group is seen from
  bool on_ground = false;    // a grid on the ground rather than one that faces the eye; heights stay as they are
};

// What to add to each robot's coordinates so that, seen from the view's direction, they stand in a grid, the first
// one at the upper left, and none hides another while it stays in its cell. The grid's middle is at the origin.
// Throws InputError("--grid: ...") if the robots do not fit into the grid.
std::vector<Eigen::Vector3f> grid_layout(std::span<const render::Bounds> robots, const LayoutOptions& options);

}  // namespace mercury
