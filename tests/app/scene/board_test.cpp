// SPDX-License-Identifier: Apache-2.0
// A table of cells with robots.
#include "app/scene/board.h"

#include <gtest/gtest.h>

#include "app/scene/camera_controller.h"

namespace mercury::test {
namespace {

using render::Bounds;

constexpr int board_width = 1600, board_height = 900;
constexpr float aspect = 16.0f / 9;

Bounds box(float x, float y, float z) {
  Bounds bounds;
  bounds.extend(render::Vector3(3, 4, 5));
  bounds.extend(render::Vector3(3 + x, 4 + y, 5 + z));
  return bounds;
}

// Four columns and three rows; robots in the upper left, the middle and the lower right cell.
struct PlacedBoard {
  Board board;
  std::vector<Bounds> robots{box(1, 0.3f, 0.2f), box(0.2f, 1, 0.4f), box(0.5f, 0.5f, 1)};
  GroupPlacement placement;
  render::Camera camera;

  PlacedBoard() {
    board.grid = {4, 3};
    board.cell_of = {0, 5, 11};
    board.values.resize(12);
    board.values[0] = 1;
    board.values[5] = 2;
    board.values[11] = 3;
    board.legend.scale = render::Scale{.low = 1, .high = 3};
    board.across = {.title = "across", .ticks = {"0", "1", "2", "3", "4"}};
    board.upward = {.title = "up", .ticks = {"0", "1", "2", "3"}};
    placement = place_on_board(board, robots, {}, aspect, render::Theme::dark);
    CameraController controller(placement.camera, {.aspect = aspect}, std::vector<std::string>(robots.size()));
    std::vector<Bounds> moved;
    for (std::size_t i = 0; i < robots.size(); ++i) moved.push_back(robots[i].moved(placement.offsets[i]));
    camera = controller.at(moved, 0);
  }
  render::Vector3 seen(const render::Vector3& point) const { return camera.project(point, board_width, board_height); }
  // The rectangle of a tile in the picture: left, upper, right and lower end.
  render::Vector4 rectangle(const render::Tile& tile) const {
    const render::Vector3 upper_left = seen(tile.center - tile.half_width + tile.half_height),
                          lower_right = seen(tile.center + tile.half_width - tile.half_height);
    return {upper_left.x, upper_left.y, lower_right.x, lower_right.y};
  }
};

TEST(Board, TilesAreRectanglesInRowsInsideThePicture) {
  const PlacedBoard placed;
  ASSERT_EQ(placed.placement.tiles.size(), 12u);
  for (std::size_t i = 0; i < 12; ++i) {
    const render::Vector4 r = placed.rectangle(placed.placement.tiles[i]);
    EXPECT_GT(r.x, 0);
    EXPECT_GT(r.y, 0);
    EXPECT_LT(r.z, board_width);
    EXPECT_LT(r.w, board_height);
    if (i % 4 != 3) {  // the next one is to the right, at the same height and of the same size
      const render::Vector4 next = placed.rectangle(placed.placement.tiles[i + 1]);
      EXPECT_GT(next.x, r.z);
      EXPECT_NEAR(next.y, r.y, 1);
      EXPECT_NEAR(next.z - next.x, r.z - r.x, 1);
    }
    if (i < 8) {
      EXPECT_GT(placed.rectangle(placed.placement.tiles[i + 4]).y, r.w);
    }
  }
}

TEST(Board, EachRobotIsInItsCellBeforeTheTile) {
  const PlacedBoard placed;
  for (std::size_t i = 0; i < placed.robots.size(); ++i) {
    const render::Tile& tile = placed.placement.tiles[placed.board.cell_of[i]];
    const render::Vector4 r = placed.rectangle(tile);
    const Bounds robot = placed.robots[i].moved(placed.placement.offsets[i]);
    for (int corner = 0; corner < 8; ++corner) {
      const render::Vector3 point =
          placed.seen({corner & 1 ? robot.high.x : robot.low.x, corner & 2 ? robot.high.y : robot.low.y,
                       corner & 4 ? robot.high.z : robot.low.z});
      EXPECT_GT(point.x, r.x);
      EXPECT_LT(point.x, r.z);
      EXPECT_GT(point.y, r.y);
      EXPECT_LT(point.y, r.w);
      EXPECT_LE(point.z, placed.seen(tile.center).z * 1.001f);
    }
  }
}

TEST(Board, FramesHaveTheColorsOfTheScale) {
  const PlacedBoard placed;
  EXPECT_EQ(placed.placement.tiles[0].frame, render::color_at(render::Colormap::viridis, 0));
  EXPECT_EQ(placed.placement.tiles[5].frame, render::color_at(render::Colormap::viridis, 0.5f));
  EXPECT_EQ(placed.placement.tiles[11].frame, render::color_at(render::Colormap::viridis, 1));
  EXPECT_EQ(placed.placement.tiles[1].frame, placed.placement.tiles[2].frame);  // both are empty
}

TEST(Board, TicksAreAtTheBordersOfCells) {
  const PlacedBoard placed;
  const auto place_of = [&](const std::string& text, bool across) {
    for (const render::Text& t : placed.placement.texts)
      if (t.text == text && (t.align_y == 0) == across) return placed.seen(t.at);
    ADD_FAILURE() << text;
    return render::Vector3(0, 0, 0);
  };
  const auto& tiles = placed.placement.tiles;
  const float border = 0.5f * (placed.rectangle(tiles[8]).z + placed.rectangle(tiles[9]).x);
  EXPECT_NEAR(place_of("1", true).x, border, 1);
  EXPECT_GT(place_of("1", true).y, placed.rectangle(tiles[8]).w);
  // The lowest row is the first of the axis that goes up.
  const float level = 0.5f * (placed.rectangle(tiles[8]).y + placed.rectangle(tiles[4]).w);
  EXPECT_NEAR(place_of("1", false).y, level, 1);
  EXPECT_LT(place_of("1", false).x, placed.rectangle(tiles[8]).x);
}

}  // namespace
}  // namespace mercury::test
