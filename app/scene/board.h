// SPDX-License-Identifier: Apache-2.0
// A table of cells that faces the eye, with a robot in some of them, such as a map of elites.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/scene/camera_plan.h"
#include "app/scene/group_layout.h"
#include "render/scene.h"

namespace mercury {

struct BoardAxis {
  std::string title;
  std::vector<std::string> ticks;  // at each border of a cell: one more than cells; empty ones are left out
};

struct Board {
  Grid grid;
  std::vector<std::size_t> cell_of;          // one per robot, counted row by row from the upper left
  std::vector<std::optional<float>> values;  // one per cell; they color it through the legend's scale
  render::Legend legend;
  BoardAxis across, upward;  // from the left, and from the lowest row
};

// Where a group is in the picture, and what is drawn behind it.
struct GroupPlacement {
  std::vector<render::Vector3> offsets;  // one per robot, added to its coordinates
  CameraPlan camera;
  std::vector<render::Tile> tiles;
  std::vector<render::Text> texts;
};

// Puts each robot into its cell. All cells are alike and hold the largest robot; the camera shows all of them.
// `robots`: their boxes at rest; `camera`: the direction of view and zoom; `aspect` of the picture.
GroupPlacement place_on_board(const Board& board, std::span<const render::Bounds> robots, const CameraPlan& camera,
                              float aspect, render::Theme theme);

}  // namespace mercury
