// SPDX-License-Identifier: Apache-2.0
#include "app/scene/group_layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "app/scene/eigen_vec3.h"
#include "mercury/error.h"

namespace mercury {

render::Bounds rest_bounds(const Robot& robot) {
  render::Bounds bounds;
  for (const Vec3 mass : robot.masses) bounds.extend(eigen(mass));
  return bounds;
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

PictureAxes picture_axes(const render::Orbit& view) {
  const float sin_a = std::sin(view.azimuth), cos_a = std::cos(view.azimuth);
  const float sin_e = std::sin(view.elevation), cos_e = std::cos(view.elevation);
  return {{-sin_a, cos_a, 0}, {-cos_a * sin_e, -sin_a * sin_e, cos_e}};
}

float extent_along(const render::Bounds& box, const Eigen::Vector3f& direction) {
  return box.empty() ? 0 : (box.high - box.low).dot(direction.cwiseAbs());
}

namespace {

// The middles of strips with these widths, side by side and centred at 0.
std::vector<float> middles_of(const std::vector<float>& widths) {
  std::vector<float> middles;
  float edge = -0.5f * std::accumulate(widths.begin(), widths.end(), 0.0f);
  for (const float width : widths) {
    middles.push_back(edge + 0.5f * width);
    edge += width;
  }
  return middles;
}

}  // namespace

std::vector<Eigen::Vector3f> grid_layout(std::span<const render::Bounds> robots, const LayoutOptions& options) {
  const PictureAxes axes = picture_axes(options.view);
  float width = 1e-3f, height = 1e-3f;
  for (const render::Bounds& robot : robots) {
    width = std::max(width, options.spacing * extent_along(robot, axes.right));
    height = std::max(height, options.spacing * extent_along(robot, axes.up));
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
    widths[i % columns] = std::max(widths[i % columns], options.spacing * extent_along(robots[i], axes.right));
    heights[i / columns] = std::max(heights[i / columns], options.spacing * extent_along(robots[i], axes.up));
  }
  const std::vector<float> across = middles_of(widths), down = middles_of(heights);
  Eigen::Vector3f up = axes.up;
  if (options.on_ground) {
    // On the ground, a row lies behind the previous one, at the distance at which it appears one row higher.
    const Eigen::Vector3f away(-std::cos(options.view.azimuth), -std::sin(options.view.azimuth), 0);
    up = away / std::max(0.1f, std::sin(options.view.elevation));
  }
  std::vector<Eigen::Vector3f> offsets;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    Eigen::Vector3f middle = robots[i].empty() ? Eigen::Vector3f::Zero() : robots[i].center();
    if (options.on_ground) middle.z() = 0;
    offsets.push_back(across[i % columns] * axes.right - down[i / columns] * up - middle);
  }
  return offsets;
}

}  // namespace mercury
