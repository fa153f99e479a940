// The camera sees all robots, and as large as fits.
#include "app/group_camera.h"

#include <gtest/gtest.h>

#include <random>

namespace mercury::test {
namespace {

using render::Bounds;

constexpr int width = 1280, height = 720;
constexpr float aspect = static_cast<float>(width) / height;
constexpr float margin = 1.1f;

Bounds box(Eigen::Vector3f middle, float half) {
  Bounds bounds;
  bounds.extend(middle - Eigen::Vector3f::Constant(half));
  bounds.extend(middle + Eigen::Vector3f::Constant(half));
  return bounds;
}

std::vector<Bounds> scattered(unsigned seed, float spread) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> place(-spread, spread), size(0.05f, 0.5f);
  std::vector<Bounds> boxes;
  for (int i = 0; i < 9; ++i) boxes.push_back(box({place(random), place(random), 0.3f * place(random)}, size(random)));
  return boxes;
}

// The largest distance of any corner from the picture's middle, over the distance of the border: 1 touches it.
struct Fill {
  float x = 0, y = 0, left = 0, bottom = 0;
};

Fill fill_of(const render::Camera& camera, const std::vector<Bounds>& boxes) {
  Fill fill;
  for (const Bounds& b : boxes)
    for (int i = 0; i < 8; ++i) {
      const Eigen::Vector3f corner(i & 1 ? b.high.x() : b.low.x(), i & 2 ? b.high.y() : b.low.y(), i & 4 ? b.high.z() : b.low.z());
      const Eigen::Vector3f pixel = camera.project(corner, width, height);
      EXPECT_GT(pixel.z(), 0) << "behind the eye";
      const float x = pixel.x() / width * 2 - 1, y = 1 - pixel.y() / height * 2;
      fill.x = std::max(fill.x, x);
      fill.left = std::max(fill.left, -x);
      fill.y = std::max(fill.y, y);
      fill.bottom = std::max(fill.bottom, -y);
    }
  return fill;
}

TEST(GroupCamera, FirstFrameFitsTheGroupTightlyAndInTheMiddle) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    const std::vector<Bounds> boxes = scattered(seed, 3);
    GroupCamera camera({.azimuth = 0.3f * static_cast<float>(seed), .elevation = 0.4f}, aspect, margin);
    const Fill fill = fill_of(camera.follow(boxes, 1.0 / 30), boxes);
    EXPECT_NEAR(std::max({fill.x, fill.left, fill.y, fill.bottom}), 1 / margin, 1e-3);
    EXPECT_NEAR(fill.x, fill.left, 1e-3);
    EXPECT_NEAR(fill.y, fill.bottom, 1e-3);
  }
}

TEST(GroupCamera, RobotsThatRunAreNeverCutOff) {
  std::vector<Bounds> boxes = scattered(1, 2);
  GroupCamera camera({.elevation = 0.4f}, aspect, margin);
  for (int frame = 0; frame < 200; ++frame) {
    const Fill fill = fill_of(camera.follow(boxes, 1.0 / 30), boxes);
    EXPECT_LE(std::max({fill.x, fill.left, fill.y, fill.bottom}), 1.0f) << frame;
    boxes[0] = boxes[0].moved({0.2f, 0, 0});  // 6 m/s
    boxes[1] = boxes[1].moved({0, 0.05f, 0.1f});
  }
}

TEST(GroupCamera, MovesWithoutJerks) {
  std::vector<Bounds> boxes = scattered(2, 2);
  GroupCamera camera({.elevation = 0.4f}, aspect, margin);
  Eigen::Vector3f before = camera.follow(boxes, 1.0 / 30).eye;
  boxes[0] = boxes[0].moved({0.05f, 0, 0});  // less than the margin, so that nothing must be caught up with at once
  for (int frame = 0; frame < 100; ++frame) {
    const Eigen::Vector3f eye = camera.follow(boxes, 1.0 / 30).eye;
    EXPECT_LT((eye - before).norm(), 0.02f);
    before = eye;
  }
  GroupCamera there({.elevation = 0.4f}, aspect, margin);
  EXPECT_LT((there.follow(boxes, 0).eye - before).norm(), 0.02f);
}

TEST(GroupCamera, EmptyBoxesAreLeftOut) {
  std::vector<Bounds> boxes = scattered(3, 2);
  GroupCamera without({}, aspect), with({}, aspect);
  const Eigen::Vector3f eye = without.follow(boxes, 0).eye;
  boxes.push_back({});
  EXPECT_EQ(with.follow(boxes, 0).eye, eye);
  const Eigen::Vector3f stays = with.follow(std::vector<Bounds>(3), 1).eye;
  EXPECT_EQ(stays, eye);
}

}  // namespace
}  // namespace mercury::test
