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
  for (const Vec3 mass : robot.masses) {
    const render::Vector3 arm = render::Vector3(mass) - room.center;
    room.radius = std::max(room.radius, arm.xy().norm());
    room.half_height = std::max(room.half_height, std::abs(arm.z));
  }
  room.radius *= room_to_deform;
  room.half_height = std::max(room_to_deform * room.half_height, 0.3f * room.radius);  // thin bodies bend out of plane
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
  if (!options.rooms.empty()) {
    const Room& room = options.rooms[robot];
    return 2 * spacing * (room.radius * direction.xy().norm() + room.half_height * std::abs(direction.z));
  }
  return options.spacing * extent_along(robots[robot], direction);
}

// What the layout puts into the middle of a cell.
render::Vector3 middle_of(std::span<const render::Bounds> robots, std::size_t robot, const LayoutOptions& options) {
  if (!options.rooms.empty()) return options.rooms[robot].center;
  return robots[robot].empty() ? render::Vector3::all(0) : robots[robot].center();
}

// A cell in the plane of the picture, seen from its middle: to the right and up.
struct Place {
  float right, up;
};

// Rows of cells of these sizes, in their order: those whose widths together are at most `width`.
struct Rows {
  std::vector<std::size_t> ends;  // the cell after the last one of each row
  float height = 0;
};
Rows rows_within(std::span<const render::Vector2> sizes, float width) {
  Rows rows;
  float used = 0, highest = 0;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    if (i > 0 && used + sizes[i].x > width) {
      rows.ends.push_back(i);
      rows.height += highest;
      used = highest = 0;
    }
    used += sizes[i].x;
    highest = std::max(highest, sizes[i].y);
  }
  rows.ends.push_back(sizes.size());
  rows.height += highest;
  return rows;
}

// The places of cells in rows that fill a picture of this aspect (width / height) as much as possible.
std::vector<Place> places_in_rows(std::span<const render::Vector2> sizes, float aspect) {
  constexpr int halvings = 40;
  float low = 0, high = 0;
  for (const render::Vector2& size : sizes) {
    low = std::max(low, size.x);
    high += size.x;
  }
  const float widest = high;
  // A wider picture needs fewer rows: the best width is where rows become as high as the picture.
  for (int i = 0; i < halvings; ++i) {
    const float width = (low + high) / 2;
    (rows_within(sizes, width).height * aspect > width ? low : high) = width;
  }
  const Rows high_rows = rows_within(sizes, low), wide_rows = rows_within(sizes, high);
  const Rows best = high_rows.height * aspect < high ? high_rows : wide_rows;
  // The least width with as many rows, so that the last one is not short.
  for (low = 0, high = widest; high - low > 1e-4f * widest;) {
    const float width = (low + high) / 2;
    (rows_within(sizes, width).ends.size() > best.ends.size() ? low : high) = width;
  }
  const Rows rows = rows_within(sizes, high);
  // A row that is shorter spreads its cells.
  const float whole = std::max(high, rows.height * aspect);
  std::vector<Place> places;
  float top = rows.height / 2;
  for (std::size_t begin = 0; const std::size_t end : rows.ends) {
    float used = 0, highest = 0;
    for (std::size_t i = begin; i < end; ++i) {
      used += sizes[i].x;
      highest = std::max(highest, sizes[i].y);
    }
    const float gap = (whole - used) / static_cast<float>(end - begin);
    float left = -whole / 2;
    for (std::size_t i = begin; i < end; ++i) {
      places.push_back({left + (gap + sizes[i].x) / 2, top - highest / 2});
      left += gap + sizes[i].x;
    }
    top -= highest;
    begin = end;
  }
  return places;
}

// The places of cells in a grid, in which the largest cell of each column and row decides its size.
std::vector<Place> places_in_grid(std::span<const render::Vector2> sizes, const LayoutOptions& options) {
  float width = 1e-3f, height = 1e-3f;
  for (const render::Vector2& size : sizes) {
    width = std::max(width, size.x);
    height = std::max(height, size.y);
  }
  Grid grid = options.grid.value_or(grid_for(sizes.size(), options.aspect, width / height));
  if (options.layout == Layout::race) grid = {static_cast<int>(sizes.size()), 1};
  const auto columns = static_cast<std::size_t>(grid.columns), rows = static_cast<std::size_t>(grid.rows);
  if (sizes.size() > columns * rows)
    throw ParameterError("grid", fmt::format("{} robots do not fit into {}x{}; give more columns or rows", sizes.size(),
                                             grid.columns, grid.rows));
  std::vector<float> widths(columns, 0.4f * width), heights(rows, 0.4f * height);
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    widths[i % columns] = std::max(widths[i % columns], sizes[i].x);
    heights[i / columns] = std::max(heights[i / columns], sizes[i].y);
  }
  const std::vector<float> across = middles_of(widths), down = middles_of(heights);
  std::vector<Place> places;
  for (std::size_t i = 0; i < sizes.size(); ++i) places.push_back({across[i % columns], -down[i / columns]});
  return places;
}

}  // namespace

std::vector<render::Vector3> grid_layout(std::span<const render::Bounds> robots, const LayoutOptions& options) {
  if (robots.empty()) return {};
  const PictureAxes axes = picture_axes(options.view);
  std::vector<render::Vector2> sizes;
  for (std::size_t i = 0; i < robots.size(); ++i)
    sizes.push_back({std::max(1e-3f, cell_along(robots, i, options, axes.right)),
                     std::max(1e-3f, cell_along(robots, i, options, axes.up))});
  const bool in_rows = options.layout == Layout::cells && !options.grid;
  const std::vector<Place> places = in_rows ? places_in_rows(sizes, options.aspect) : places_in_grid(sizes, options);
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
    offsets.push_back(places[i].right * axes.right + places[i].up * up - middle);
  }
  return offsets;
}

}  // namespace mercury
