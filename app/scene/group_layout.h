// SPDX-License-Identifier: Apache-2.0
// Where the robots of a group are in the picture.
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "mercury/robot.h"
#include "render/camera.h"
#include "render/vector.h"

namespace mercury {

// The box around a robot at rest.
render::Bounds rest_bounds(const Robot& robot);

// The upright cylinder that a robot does not leave while it bends, and turns about the vertical through its center of
// mass.
struct Room {
  render::Vector3 center{0, 0, 0};    // of mass, at rest [m]
  float radius = 0, half_height = 0;  // [m]
};
Room room_of(const Robot& robot);

// The directions to the right and up in the picture.
struct PictureAxes {
  render::Vector3 right, up;
};
PictureAxes picture_axes(const render::Orbit& view);

// The extent of a box along a direction; 0 if it is empty.
float extent_along(const render::Bounds& box, const render::Vector3& direction);

struct Grid {
  int columns = 1, rows = 1;

  friend bool operator==(const Grid&, const Grid&) = default;
};

// The number of columns and rows with which `count` cells fill a picture best. Aspects are width / height.
Grid grid_for(std::size_t count, float picture_aspect, float cell_aspect);

enum class Layout {
  grid,
  race,   // one lane per robot, side by side from left to right; lanes run away from the eye
  cells,  // each robot stays in its cell, its drift subtracted; rows of cells of different widths fill the picture
};

// "grid", "race", "cells".
std::string_view name_of(Layout layout);

struct LayoutOptions {
  Layout layout = Layout::grid;
  std::optional<Grid> grid;     // absent = grid_for
  float spacing = 1.45f;        // size of a cell / size of the largest robot in its row or column, without rooms
  float aspect = 16.0f / 9;     // of the picture
  render::Orbit view;           // its angles are the direction of view
  std::span<const Room> rooms;  // one per robot, for cells and lanes; empty = the boxes decide
  bool on_ground = false;       // the grid lies on the ground and does not face the eye; heights do not change
};

// The offset of each robot. Seen from the view's direction, the robots then form a grid, or rows of cells, the first
// one at the upper left, and none hides another while it stays in its cell. With rooms, no two of them overlap. The
// middle is at the origin. Throws ParameterError("grid", ...) if the robots do not fit into the grid.
std::vector<render::Vector3> grid_layout(std::span<const render::Bounds> robots, const LayoutOptions& options);

}  // namespace mercury
