// SPDX-License-Identifier: Apache-2.0
// The camera shows what its plan requests, as large as fits.
#include "app/scene/camera_controller.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "mercury/error.h"

namespace mercury::test {
namespace {

using render::Bounds;

constexpr int view_width = 1280, view_height = 720;
constexpr double tick = 1.0 / 30;

Bounds box(render::Vector3 middle, float half) {
  Bounds bounds;
  bounds.extend(middle - render::Vector3::all(half));
  bounds.extend(middle + render::Vector3::all(half));
  return bounds;
}

std::vector<Bounds> scattered(unsigned seed, float spread) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> place(-spread, spread), size(0.05f, 0.5f);
  std::vector<Bounds> boxes;
  for (int i = 0; i < 9; ++i) boxes.push_back(box({place(random), place(random), 0.3f * place(random)}, size(random)));
  return boxes;
}

// How much of the picture the boxes fill: 1 = a corner touches the border, above 1 = it is cut off.
float fill_of(const render::Camera& camera, const std::vector<Bounds>& boxes) {
  float fill = 0;
  for (const Bounds& b : boxes)
    for (int i = 0; i < 8 && !b.empty(); ++i) {
      const render::Vector3 corner(i & 1 ? b.high.x : b.low.x, i & 2 ? b.high.y : b.low.y, i & 4 ? b.high.z : b.low.z);
      const render::Vector3 pixel = camera.project(corner, view_width, view_height);
      EXPECT_GT(pixel.z, 0) << "behind the eye";
      fill = std::max({fill, std::abs(pixel.x / view_width * 2 - 1), std::abs(1 - pixel.y / view_height * 2)});
    }
  return fill;
}

class GroupInView : public testing::TestWithParam<CameraMode> {};

TEST_P(GroupInView, FirstFrameFillsThePicture) {
  for (unsigned seed = 0; seed < 30; ++seed) {
    const std::vector<Bounds> boxes = scattered(seed, 3);
    CameraController camera({.mode = GetParam()}, {}, {});
    const float fill = fill_of(camera.at(boxes, tick), boxes);
    EXPECT_LE(fill, 1.0f);
    EXPECT_GE(fill, 0.8f);
  }
}

TEST_P(GroupInView, MovingRobotsAreNeverCutOff) {
  std::vector<Bounds> boxes = scattered(1, 2);
  CameraController camera({.mode = GetParam()}, {}, {});
  for (int frame = 0; frame < 200; ++frame) {
    EXPECT_LE(fill_of(camera.at(boxes, tick), boxes), 1.0f) << frame;
    boxes[0] = boxes[0].moved({0.2f, 0, 0});  // 6 m/s
    boxes[1] = boxes[1].moved({0, 0.05f, 0.1f});
  }
}

INSTANTIATE_TEST_SUITE_P(CameraController, GroupInView, testing::Values(CameraMode::group, CameraMode::top),
                         [](const auto& tested) { return std::string(name_of(tested.param)); });

TEST(CameraController, MovesSmoothly) {
  std::vector<Bounds> boxes = scattered(2, 2);
  CameraController camera({}, {}, {});
  render::Vector3 before = camera.at(boxes, tick).eye;
  boxes[0] = boxes[0].moved({0.05f, 0, 0});  // less than the margin, so that the camera need not catch up at once
  for (int frame = 0; frame < 100; ++frame) {
    const render::Vector3 eye = camera.at(boxes, tick).eye;
    EXPECT_LT((eye - before).norm(), 0.02f);
    before = eye;
  }
  CameraController there({}, {}, {});
  EXPECT_LT((there.at(boxes, 0).eye - before).norm(), 0.02f);
}

TEST(CameraController, EmptyBoxesAreIgnored) {
  std::vector<Bounds> boxes = scattered(3, 2);
  CameraController without({}, {}, {}), with({}, {}, {});
  const render::Vector3 eye = without.at(boxes, 0).eye;
  boxes.push_back({});
  EXPECT_EQ(with.at(boxes, 0).eye, eye);
}

TEST(CameraController, TopLooksStraightDown) {
  CameraController camera({.mode = CameraMode::top}, {}, {});
  const render::Camera view = camera.at(scattered(4, 2), 0);
  EXPECT_NEAR((view.eye - view.target).normalized().z, 1, 1e-5);
}

TEST(CameraController, FollowKeepsItsDistanceToTheRobot) {
  const std::vector<std::string> names{"ray", "eel", "squid"};
  std::vector<Bounds> boxes{box({0, 0, 0}, 0.2f), box({2, 0, 0}, 0.3f), box({4, 1, 0}, 0.2f)};
  CameraController camera({.mode = CameraMode::follow, .robot = "eel"}, {}, names);
  const render::Camera first = camera.at(boxes, tick);
  EXPECT_LT((first.target - boxes[1].center()).norm(), 1e-5);
  for (int frame = 0; frame < 300; ++frame) {
    boxes[1] = boxes[1].moved({0, 0.01f, 0});
    camera.at(boxes, tick);
  }
  // At 0.3 m/s a lag of 0.8 s is 0.24 m.
  const render::Camera last = camera.at(boxes, tick);
  EXPECT_NEAR((last.target - boxes[1].center()).norm(), 0.24, 0.02);
  EXPECT_NEAR((last.eye - last.target).norm(), (first.eye - first.target).norm(), 1e-4);
}

TEST(CameraController, UnknownRobotToFollowThrows) {
  const std::vector<std::string> names{"ray", "eel"};
  EXPECT_NO_THROW(CameraController({.mode = CameraMode::follow, .robot = "1"}, {}, names));
  EXPECT_THROW(CameraController({.mode = CameraMode::follow, .robot = "2"}, {}, names), InputError);
  EXPECT_THROW(CameraController({.mode = CameraMode::follow, .robot = "cod"}, {}, names), InputError);
}

TEST(CameraController, TurntableTurnsOncePerPeriodWithAllRobotsInView) {
  const std::vector<Bounds> boxes = scattered(5, 1);
  CameraController camera({.mode = CameraMode::turntable, .period = 2}, {}, {});
  const render::Vector3 start = camera.at(boxes, 0.1).eye;
  float farthest = 0;
  for (int frame = 0; frame < 19; ++frame) {
    const render::Camera view = camera.at(boxes, 0.1);
    EXPECT_LE(fill_of(view, boxes), 1.0f);
    farthest = std::max(farthest, (view.eye - start).norm());
  }
  EXPECT_GT(farthest, 1);
  EXPECT_LT((camera.at(boxes, 0.1).eye - start).norm(), 0.01f);
}

TEST(CameraController, StillKeepsThePlansPosition) {
  CameraController camera(
      {.mode = CameraMode::still, .azimuth = 0, .elevation = 0, .target = render::Vector3(1, 2, 3), .distance = 5}, {},
      {});
  std::vector<Bounds> boxes = scattered(6, 1);
  for (int frame = 0; frame < 3; ++frame) {
    EXPECT_LT((camera.at(boxes, tick).eye - render::Vector3(6, 2, 3)).norm(), 1e-5);
    boxes[0] = boxes[0].moved({1, 0, 0});
  }
}

TEST(CameraController, ZoomBringsCloser) {
  const std::vector<Bounds> boxes = scattered(7, 1);
  CameraController far({}, {}, {}), near({.zoom = 2}, {}, {});
  const render::Camera a = far.at(boxes, tick), b = near.at(boxes, tick);
  EXPECT_NEAR((a.eye - a.target).norm() / (b.eye - b.target).norm(), 2, 0.1);
}

}  // namespace
}  // namespace mercury::test
