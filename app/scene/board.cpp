// SPDX-License-Identifier: Apache-2.0
#include "app/scene/board.h"

#include <algorithm>
#include <cmath>

#include "app/scene/camera_controller.h"
#include "render/vector.h"

namespace mercury {
namespace {

using render::Vector3;

constexpr float spacing = 1.25f;          // side of a cell / that of the largest robot
constexpr float most_stretch = 1.5f;      // of cells, to fill the picture
constexpr float field_of_view = 0.05f;    // so small that all cells look alike [rad]
constexpr float text_height = 1 / 42.0f;  // of a line, as a share of the picture's height (render/text/overlay.cpp)

// Room for ticks, titles, legend and caption at the edges of the picture.
render::Insets edges_for(float aspect) {
  return {.left = 0.12f / aspect, .right = 0.24f / aspect, .top = 0.15f, .bottom = 0.11f};
}

// The board's plane, with its middle at the origin.
struct BoardPlane {
  PictureAxes axes;
  float cell_width = 0, cell_height = 0;  // [m]
  float width = 0, height = 0;
  Vector3 at(float x, float y) const { return x * axes.right + y * axes.up; }
  Vector3 toward_eye() const { return axes.right.cross(axes.up); }
};

BoardPlane plane_for(const Grid& grid, std::span<const render::Bounds> robots, const render::Orbit& view,
                     float aspect) {
  BoardPlane plane{.axes = picture_axes(view), .cell_width = 1e-3f, .cell_height = 1e-3f};
  for (const render::Bounds& robot : robots) {
    plane.cell_width = std::max(plane.cell_width, spacing * extent_along(robot, plane.axes.right));
    plane.cell_height = std::max(plane.cell_height, spacing * extent_along(robot, plane.axes.up));
  }
  const auto columns = static_cast<float>(grid.columns), rows = static_cast<float>(grid.rows);
  const float wider = aspect * rows * plane.cell_height / (columns * plane.cell_width);
  plane.cell_width *= std::clamp(wider, 1.0f, most_stretch);
  plane.cell_height *= std::clamp(1 / wider, 1.0f, most_stretch);
  plane.width = columns * plane.cell_width;
  plane.height = rows * plane.cell_height;
  return plane;
}

render::Tile tile_at(const BoardPlane& plane, const Vector3& center, std::optional<render::Color> color,
                     render::Theme theme) {
  constexpr float gap = 0.03f;  // between tiles, of the shorter side
  const bool dark = theme == render::Theme::dark;
  const render::Color ground = dark ? render::rgb(0x20262c) : render::rgb(0xf4f6f8);
  const render::Color empty = dark ? render::rgb(0x2c3238) : render::rgb(0xd6dade);
  const float inset = gap * std::min(plane.cell_width, plane.cell_height);
  return {.center = center,
          .half_width = (0.5f * plane.cell_width - inset) * plane.axes.right,
          .half_height = (0.5f * plane.cell_height - inset) * plane.axes.up,
          .fill = color ? render::mix(*color, ground, 0.6f) : empty,
          .frame = color.value_or(empty)};
}

// Ticks and titles. `line`: height of a line of text in the plane [m].
void write_axes(const Board& board, const BoardPlane& plane, float line, std::vector<render::Text>& texts) {
  const float left = -0.5f * plane.width, low = -0.5f * plane.height;
  const auto add = [&](float x, float y, const std::string& text, float align_x, float align_y, float size) {
    if (!text.empty())
      texts.push_back({.at = plane.at(x, y), .text = text, .align_x = align_x, .align_y = align_y, .size = size});
  };
  for (std::size_t i = 0; i < board.across.ticks.size(); ++i)
    add(left + static_cast<float>(i) * plane.cell_width, low - 0.3f * line, board.across.ticks[i], 0.5f, 0, 0.9f);
  for (std::size_t i = 0; i < board.upward.ticks.size(); ++i)
    add(left - 0.5f * line, low + static_cast<float>(i) * plane.cell_height, board.upward.ticks[i], 1, 0.5f, 0.9f);
  add(0, low - 1.5f * line, board.across.title, 0.5f, 0, 1);
  add(left, -low + 0.35f * line, board.upward.title, 0, 1, 1);
}

}  // namespace

GroupPlacement place_on_board(const Board& board, std::span<const render::Bounds> robots, const CameraPlan& camera,
                              float aspect, render::Theme theme) {
  const render::Insets edges = edges_for(aspect);
  const float free_width = 1 - edges.left - edges.right, free_height = 1 - edges.top - edges.bottom;
  const render::Orbit view = direction_of(camera, true);
  const BoardPlane plane = plane_for(board.grid, robots, view, aspect * free_width / free_height);
  GroupPlacement placement{.camera = camera};

  // The camera: the board fills what the edges leave free.
  const float half = std::tan(0.5f * field_of_view);
  const float distance =
      std::max(plane.width / (2 * half * aspect * free_width), plane.height / (2 * half * free_height)) / camera.zoom;
  const float seen = half * distance;  // half the height of what is seen [m]
  placement.camera.mode = CameraMode::still;
  placement.camera.azimuth = view.azimuth;
  placement.camera.elevation = view.elevation;
  placement.camera.field_of_view = field_of_view;
  placement.camera.distance = distance;
  placement.camera.target = plane.at(aspect * seen * (edges.right - edges.left), seen * (edges.top - edges.bottom));

  const auto columns = static_cast<std::size_t>(board.grid.columns);
  const auto center_of = [&](std::size_t cell) {
    return plane.at((static_cast<float>(cell % columns) + 0.5f) * plane.cell_width - 0.5f * plane.width,
                    0.5f * plane.height - (static_cast<float>(cell / columns) + 0.5f) * plane.cell_height);
  };
  for (std::size_t cell = 0; cell < board.values.size(); ++cell) {
    std::optional<render::Color> color;
    if (board.values[cell] && board.legend.scale)
      color = render::color_at(board.legend.scale->map, *board.values[cell], board.legend.scale->low,
                               board.legend.scale->high);
    placement.tiles.push_back(tile_at(plane, center_of(cell), color, theme));
  }
  for (std::size_t i = 0; i < robots.size(); ++i) {
    const Vector3 middle = robots[i].empty() ? Vector3::all(0) : robots[i].center();
    const Vector3 forward = 0.5f * extent_along(robots[i], plane.toward_eye()) * plane.toward_eye();
    placement.offsets.push_back(center_of(board.cell_of.at(i)) + forward - middle);
  }
  write_axes(board, plane, 2 * seen * text_height, placement.texts);
  return placement;
}

}  // namespace mercury
