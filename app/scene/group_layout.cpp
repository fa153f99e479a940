// SPDX-License-Identifier: Apache-2.0
#include "app/scene/group_layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "mercury/error.h"

namespace mercury {

render::Bounds rest_bounds(const Robot& robot) {
  render::Bounds bounds;
  for (const Vec3 mass : robot.masses) bounds.extend(render::Vector3(mass));
  return bounds;
}

Room room_of(const Robot& robot) {
  // Muscles change lengths by up to 14 %, and bodies bend.
  constexpr float room_to_deform = 1.15f;
  Room room;
  double x = 0, y = 0, z = 0;
  for (const Vec3 mass : robot.masses) {
    x += mass.x;
    y += mass.y;
    z += mass.z;
  }
  const double count = static_cast<double>(std::max<std::size_t>(1, robot.masses.size()));
  room.center = {static_cast<float>(x / count), static_cast<float>(y / count), static_cast<float>(z / count)};
  for (const Vec3 mass : robot.masses)
    room.radius = std::max(room.radius, (render::Vector3(mass) - room.center).norm());
  room.radius *= room_to_deform;
  return room;
}

Grid grid_for(std::size_t count, float picture_aspect, float cell_aspect) {
  const int cells = static_cast<int>(std::max<std::size_t>(1, count));
  Grid best{.columns = cells, .rows = 1};
  float best_scale = 0;
  for (int columns = 1; columns <= cells; ++columns) {
    const int rows = (cells + columns - 1) / columns;
    const float fill = static_cast<float>(cells) / static_cast<float>(columns * rows);
    const float scale =
        std::min(picture_aspect / (static_cast<float>(columns) * cell_aspect), 1 / static_cast<float>(rows));
    // Empty cells look unfinished, so a layout without them wins if it costs little size.
    if (scale * (0.6f + 0.4f * fill) <= best_scale) continue;
    best_scale = scale * (0.6f + 0.4f * fill);
    best = {columns, rows};
  }
  return best;
}

std::string_view name_of(Layout layout) {
  constexpr std::string_view names[] = {"grid", "race", "cells"};
  return names[static_cast<std::size_t>(layout)];
}

PictureAxes picture_axes(const render::Orbit& view) {
  const float sin_a = std::sin(view.azimuth), cos_a = std::cos(view.azimuth);
  const float sin_e = std::sin(view.elevation), cos_e = std::cos(view.elevation);
  return {{-sin_a, cos_a, 0}, {-cos_a * sin_e, -sin_a * sin_e, cos_e}};
}

float extent_along(const render::Bounds& box, const render::Vector3& direction) {
  return box.empty() ? 0 : (box.high - box.low).dot(direction.absolute());
}

namespace {

// The middles of strips with these widths, side by side and centered at 0.
std::vector<float> middles_of(const std::vector<float>& widths) {
  std::vector<float> middles;
  float edge = -0.5f * std::accumulate(widths.begin(), widths.end(), 0.0f);
  for (const float width : widths) {
    middles.push_back(edge + 0.5f * width);
    edge += width;
  }
  return middles;
}

// The size of a robot's cell along a direction.
float cell_along(std::span<const render::Bounds> robots, std::size_t robot, const LayoutOptions& options,
                 const render::Vector3& direction) {
  constexpr float spacing = 1.08f;  // of rooms
  if (!options.rooms.empty()) return 2 * spacing * options.rooms[robot].radius;
  return options.spacing * extent_along(robots[robot], direction);
}

// What the layout puts into the middle of a cell.
render::Vector3 middle_of(std::span<const render::Bounds> robots, std::size_t robot, const LayoutOptions& options) {
  if (!options.rooms.empty()) return options.rooms[robot].center;
  return robots[robot].empty() ? render::Vector3::all(0) : robots[robot].center();
}

}  // namespace

std::vector<render::Vector3> grid_layout(std::span<const render::Bounds> robots, const LayoutOptions& options) {
  const PictureAxes axes = picture_axes(options.view);
  float width = 1e-3f, height = 1e-3f;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    width = std::max(width, cell_along(robots, i, options, axes.right));
    height = std::max(height, cell_along(robots, i, options, axes.up));
  }
  Grid grid = options.grid.value_or(grid_for(robots.size(), options.aspect, width / height));
  if (options.layout == Layout::race) grid = {1, static_cast<int>(robots.size())};
  const auto columns = static_cast<std::size_t>(grid.columns), rows = static_cast<std::size_t>(grid.rows);
  if (robots.size() > columns * rows)
    throw ParameterError("grid", fmt::format("{} robots do not fit into {}x{}; give more columns or rows",
                                             robots.size(), grid.columns, grid.rows));
  // The largest robot of each column and row decides its size.
  std::vector<float> widths(columns, 0.4f * width), heights(rows, 0.4f * height);
  for (std::size_t i = 0; i < robots.size(); ++i) {
    widths[i % columns] = std::max(widths[i % columns], cell_along(robots, i, options, axes.right));
    heights[i / columns] = std::max(heights[i / columns], cell_along(robots, i, options, axes.up));
  }
  const std::vector<float> across = middles_of(widths), down = middles_of(heights);
  render::Vector3 up = axes.up;
  if (options.on_ground) {
    // On the ground, a row lies behind the previous one, at the distance at which it appears one row higher.
    const render::Vector3 away(-std::cos(options.view.azimuth), -std::sin(options.view.azimuth), 0);
    up = away / std::max(0.1f, std::sin(options.view.elevation));
  }
  std::vector<render::Vector3> offsets;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    render::Vector3 middle = middle_of(robots, i, options);
    if (options.on_ground) middle.z = 0;
    offsets.push_back(across[i % columns] * axes.right - down[i / columns] * up - middle);
  }
  return offsets;
}

}  // namespace mercury
