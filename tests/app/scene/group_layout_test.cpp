// SPDX-License-Identifier: Apache-2.0
// Robots in a grid: none hides another.
#include "app/scene/group_layout.h"

#include <gtest/gtest.h>

#include "mercury/error.h"

namespace mercury::test {
namespace {

using render::Bounds;

Bounds box(render::Vector3 low, render::Vector3 high) {
  Bounds bounds;
  bounds.extend(low);
  bounds.extend(high);
  return bounds;
}

// Robots of different sizes, not at the origin.
std::vector<Bounds> robots(int count) {
  std::vector<Bounds> boxes;
  for (int i = 0; i < count; ++i) {
    const float size = 0.5f + 0.1f * static_cast<float>(i % 5);
    const render::Vector3 low(0.3f * static_cast<float>(i), -1, 0);
    boxes.push_back(box(low, low + render::Vector3(size, 0.6f, 0.4f * size)));
  }
  return boxes;
}

struct Rectangle {
  float left, right, bottom, top;
};

// The rectangle that a box covers in an orthographic view along the view's direction.
Rectangle seen(const Bounds& b, const render::Orbit& view) {
  const render::Camera camera = view.camera();
  const render::Matrix4 eye = camera.view();
  Rectangle r{1e9f, -1e9f, 1e9f, -1e9f};
  for (int i = 0; i < 8; ++i) {
    const render::Vector4 corner(i & 1 ? b.high.x : b.low.x, i & 2 ? b.high.y : b.low.y, i & 4 ? b.high.z : b.low.z, 1);
    const render::Vector4 p = eye * corner;
    r = {std::min(r.left, p.x), std::max(r.right, p.x), std::min(r.bottom, p.y), std::max(r.top, p.y)};
  }
  return r;
}

class GridOnTheGround : public testing::TestWithParam<bool> {};

TEST_P(GridOnTheGround, NoRobotHidesAnother) {
  const render::Orbit view{.azimuth = -1.3f, .elevation = 0.5f};
  for (const int count : {1, 2, 7, 12, 30}) {
    const std::vector<Bounds> boxes = robots(count);
    const auto offsets = grid_layout(boxes, {.view = view, .on_ground = GetParam()});
    ASSERT_EQ(offsets.size(), boxes.size());
    for (std::size_t a = 0; a < boxes.size(); ++a)
      for (std::size_t b = 0; b < a; ++b) {
        const Rectangle p = seen(boxes[a].moved(offsets[a]), view), q = seen(boxes[b].moved(offsets[b]), view);
        const bool apart = p.right < q.left || q.right < p.left || p.top < q.bottom || q.top < p.bottom;
        EXPECT_TRUE(apart) << a << " and " << b << " of " << count;
      }
  }
}

TEST_P(GridOnTheGround, FirstIsUpperLeftAndRowsFillFirst) {
  const render::Orbit view{.azimuth = -1.3f, .elevation = 0.5f};
  const std::vector<Bounds> boxes = robots(6);
  const auto offsets = grid_layout(boxes, {.grid = Grid{3, 2}, .view = view, .on_ground = GetParam()});
  const auto rectangle = [&](std::size_t i) { return seen(boxes[i].moved(offsets[i]), view); };
  EXPECT_LT(rectangle(0).right, rectangle(1).left);
  EXPECT_LT(rectangle(1).right, rectangle(2).left);
  EXPECT_GT(rectangle(0).bottom, rectangle(3).top);
}

INSTANTIATE_TEST_SUITE_P(Grid, GridOnTheGround, testing::Values(false, true),
                         [](const auto& tested) { return tested.param ? "OnTheGround" : "InWater"; });

TEST(GridLayout, OnTheGroundHeightsDoNotChange) {
  for (const auto& offset : grid_layout(robots(8), {.view = {.elevation = 0.5f}, .on_ground = true}))
    EXPECT_EQ(offset.z, 0);
}

TEST(GridLayout, GridThatIsTooSmallThrows) {
  EXPECT_THROW(grid_layout(robots(7), {.grid = Grid{3, 2}}), InputError);
  EXPECT_NO_THROW(grid_layout(robots(6), {.grid = Grid{3, 2}}));
}

// Upright cylinders, long and flat ones among them.
std::vector<Room> rooms(int count) {
  std::vector<Room> all;
  for (int i = 0; i < count; ++i)
    all.push_back({{0.3f * static_cast<float>(i), 0, 1}, 0.2f + 0.3f * static_cast<float>(i * 5 % 7), 0.2f});
  return all;
}

TEST(CellLayout, CellsInRowsAreApartInOrderAndFillThePicture) {
  const render::Orbit view{.azimuth = -1.3f, .elevation = 0.5f};
  for (const float aspect : {0.6f, 1.0f, 1.8f})
    for (const int count : {1, 2, 7, 12, 30}) {
      const std::vector<Room> all = rooms(count);
      std::vector<Bounds> boxes;
      std::vector<Rectangle> cells;
      float covered = 0;
      for (const Room& room : all) {
        const render::Vector3 half(room.radius, room.radius, room.half_height);
        boxes.push_back(box(room.center - half, room.center + half));
      }
      const auto offsets =
          grid_layout(boxes, {.layout = mercury::Layout::cells, .aspect = aspect, .view = view, .rooms = all});
      Rectangle whole{1e9f, -1e9f, 1e9f, -1e9f};
      for (std::size_t i = 0; i < boxes.size(); ++i) {
        const render::Camera camera = view.camera();
        const render::Vector3 middle = offsets[i] + all[i].center;
        const render::Vector4 seen_middle = camera.view() * render::Vector4(middle.x, middle.y, middle.z, 1);
        const float right = all[i].radius, up = all[i].radius * std::sin(0.5f) + all[i].half_height * std::cos(0.5f);
        cells.push_back({seen_middle.x - right, seen_middle.x + right, seen_middle.y - up, seen_middle.y + up});
        whole = {std::min(whole.left, cells[i].left), std::max(whole.right, cells[i].right),
                 std::min(whole.bottom, cells[i].bottom), std::max(whole.top, cells[i].top)};
        covered += 4 * right * up;
        for (std::size_t j = 0; j < i; ++j) {
          const Rectangle &p = cells[i], &q = cells[j];
          EXPECT_TRUE(p.right < q.left || q.right < p.left || p.top < q.bottom || q.top < p.bottom);
          EXPECT_TRUE(q.top > p.bottom) << j << " is below " << i;
          EXPECT_TRUE(q.right < p.left || q.bottom > p.top) << j << " is neither left of " << i << " nor above";
        }
      }
      // Of the smallest picture of this aspect that holds them all.
      const float width = std::max(whole.right - whole.left, aspect * (whole.top - whole.bottom));
      if (count < 12) continue;
      EXPECT_GT(covered / (width * width / aspect), 0.45f) << count << " at " << aspect;
    }
}

TEST(RaceLayout, HasOneLanePerRobotFromOneStartLine) {
  const auto boxes = robots(5);
  const auto offsets = grid_layout(
      boxes, {.layout = mercury::Layout::race, .view = {.azimuth = -1.5707963f, .elevation = 0.8f}, .on_ground = true});
  for (std::size_t i = 1; i < boxes.size(); ++i) {
    // Seen along +y: from left to right.
    EXPECT_NEAR(boxes[i].moved(offsets[i]).center().y, boxes[0].moved(offsets[0]).center().y, 1e-4);
    EXPECT_GT(boxes[i].moved(offsets[i]).low.x, boxes[i - 1].moved(offsets[i - 1]).high.x);
  }
}

TEST(GridFor, FillsThePicture) {
  // Square cells in a square picture, and in one twice as wide as high.
  EXPECT_EQ(grid_for(16, 1, 1).columns, 4);
  EXPECT_EQ(grid_for(8, 2, 1).columns, 4);
  EXPECT_EQ(grid_for(1, 2, 1).columns, 1);
  for (std::size_t count = 1; count < 200; ++count) {
    const Grid grid = grid_for(count, 16.0f / 9, 1.3f);
    EXPECT_GE(static_cast<std::size_t>(grid.columns * grid.rows), count);
    EXPECT_LT(static_cast<std::size_t>(grid.columns * (grid.rows - 1)), count) << "an empty row";
  }
}

}  // namespace
}  // namespace mercury::test
