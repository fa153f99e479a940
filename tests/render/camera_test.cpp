// SPDX-License-Identifier: Apache-2.0
#include "render/camera.h"
#include "render/vector.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace mercury::render {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

// An independent pinhole camera: similar triangles along and across the line of sight.
Vector3 pinhole_with_depth(const Camera& camera, const Vector3& point, int width, int height) {
  const Vector3 forward = (camera.target - camera.eye).normalized();
  const Vector3 right = forward.cross(camera.up).normalized();
  const Vector3 up = right.cross(forward);
  const Vector3 p = point - camera.eye;
  const float depth = p.dot(forward);
  const float pixels = float(height) / 2 / std::tan(camera.field_of_view / 2);
  return {float(width) / 2 + pixels * p.dot(right) / depth, float(height) / 2 - pixels * p.dot(up) / depth, depth};
}

TEST(Camera, ProjectsAsAPinhole) {
  const Camera camera{.eye = {3, -4, 2}, .target = {0.5f, 0.2f, 0.1f}, .field_of_view = 0.8f};
  for (const Vector3& point : {Vector3(0, 0, 0), Vector3(0.5f, 0.2f, 0.1f), Vector3(-1, 0.3f, 0.7f)})
    EXPECT_LT((camera.project(point, 640, 360) - pinhole_with_depth(camera, point, 640, 360)).norm(), 2e-3f);
}

TEST(Camera, TargetIsInTheMiddleOfThePicture) {
  const Camera camera{.eye = {3, -4, 2}, .target = {0.5f, 0.2f, 0.1f}};
  const Vector3 seen = camera.project(camera.target, 640, 360);
  EXPECT_NEAR(seen.x, 320, 1e-3);
  EXPECT_NEAR(seen.y, 180, 1e-3);
}

// From every point of the lens, points in the plane of focus are in the same place within a pixel; one twice as far
// moves over a disc. Similar triangles: its diameter in the plane of focus is that of the lens times 1 - 1/2.
TEST(Camera, TheLensBlursWhatIsOutOfFocus) {
  constexpr int samples = 64, width = 640, height = 360;
  const Camera camera{.eye = {3, -4, 2},
                      .target = {0.5f, 0.2f, 0.1f},
                      .field_of_view = 0.8f,
                      .lens = {.radius = 0.2f, .focus = 3, .samples = samples}};
  const Vector3 forward = (camera.target - camera.eye).normalized(), right = forward.cross(camera.up).normalized();
  const Vector3 sharp = camera.eye + 3 * forward + 0.7f * right, blurred = camera.eye + 6 * forward;
  const float pixel = 2 * std::tan(0.4f) / float(height);
  Bounds spread;
  for (int i = 0; i < samples; ++i) {
    const Camera seen = camera.seen_through_lens(i, height);
    const Vector3 off = seen.project(sharp, width, height) - camera.project(sharp, width, height);
    EXPECT_LE(std::max(std::abs(off.x), std::abs(off.y)), 0.501f);
    spread.extend(seen.project(blurred, width, height));
  }
  const float expected = 2 * 0.2f * 0.5f / 3 / pixel;
  EXPECT_NEAR(spread.high.x - spread.low.x, expected, 0.08f * expected);
  EXPECT_NEAR(spread.high.y - spread.low.y, expected, 0.08f * expected);
}

TEST(Camera, DepthIsOneAtTheNearestAndZeroAtTheFarthest) {
  const Camera camera{.eye = {0, 0, 5}, .target = {0, 0, 0}, .up = {0, 1, 0}, .near = 0.5f, .far = 50};
  const auto depth = [&](float z) {
    const Vector4 clip = camera.projection(1) * camera.view() * Vector4(0, 0, z, 1);
    return clip.z / clip.w;
  };
  EXPECT_NEAR(depth(4.5f), 1, 1e-6);
  EXPECT_NEAR(depth(-45), 0, 1e-6);
  EXPECT_GT(depth(1), depth(0));
}

TEST(Camera, RayRunsThroughThePointThatProjectsThere) {
  const Camera camera{.eye = {3, -4, 2}, .target = {0.5f, 0.2f, 0.1f}};
  const Vector3 point(-0.3f, 0.9f, 0.4f);
  const Vector3 seen = camera.project(point, 640, 360);
  const Ray ray = camera.ray(seen.x, seen.y, 640, 360);
  EXPECT_LT((point - ray.origin).cross(ray.direction).norm(), 1e-4f);
  EXPECT_NEAR(ray.direction.norm(), 1, 1e-5);
}

TEST(Orbit, EyeLiesInTheDirectionOfTheAngles) {
  const Orbit orbit{.target = {1, 2, 3}, .azimuth = 0, .elevation = pi / 6, .distance = 4};
  EXPECT_LT((orbit.camera().eye - Vector3(1 + 4 * std::cos(pi / 6), 2, 3 + 2)).norm(), 1e-5f);
}

TEST(Orbit, FrameContainsAllCornersAndTouchesAnEdge) {
  const Bounds box{Vector3(-1, -2, 0), Vector3(3, 1, 0.5f)};
  for (const float elevation : {0.0f, 0.5f, pi / 2}) {
    Orbit orbit{.azimuth = 0.7f, .elevation = elevation};
    orbit.frame(box, 16.0f / 9, 1.0f);
    float margin = 1e9f;
    for (int corner = 0; corner < 8; ++corner) {
      const Vector3 point(corner & 1 ? 3 : -1, corner & 2 ? 1 : -2, corner & 4 ? 0.5f : 0);
      const Vector3 seen = orbit.camera().project(point, 1600, 900);
      margin = std::min({margin, seen.x, 1600 - seen.x, seen.y, 900 - seen.y});
    }
    EXPECT_NEAR(margin, 0, 0.1) << elevation;
  }
}

TEST(Orbit, FrameLeavesRoomForALegend) {
  const Bounds box{Vector3(-1, -1, -1), Vector3(1, 1, 1)};
  Orbit orbit;
  orbit.frame(box, 16.0f / 9, 1.0f, {.right = 0.6f});
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3 point(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
    EXPECT_LT(orbit.camera().project(point, 1600, 900).x, 1600 * 0.4f + 2);
  }
}

TEST(Orbit, TopViewHasXToTheRightAndYUp) {
  const Orbit orbit = top_view(Bounds{Vector3(-1, -1, 0), Vector3(1, 1, 0)}, 1);
  const Vector3 middle = orbit.camera().project({0, 0, 0}, 100, 100);
  const Vector3 x = orbit.camera().project({0.5f, 0, 0}, 100, 100), y = orbit.camera().project({0, 0.5f, 0}, 100, 100);
  EXPECT_GT(x.x, middle.x + 10);
  EXPECT_NEAR(x.y, middle.y, 0.01);
  EXPECT_LT(y.y, middle.y - 10);
}

TEST(Orbit, PanMovesThePictureByThatPartOfItsHeight) {
  Orbit orbit;
  const Vector3 point = orbit.target;
  orbit.pan(0.25f, 0);
  EXPECT_NEAR(orbit.camera().project(point, 800, 400).x, 400 - 100, 0.5);
}

TEST(Orbit, TurntableReturnsAfterAPeriod) {
  const Orbit start{.azimuth = 0.3f};
  EXPECT_NEAR(turntable(start, 20, 20).azimuth, 0.3f, 1e-5);
  EXPECT_NEAR(turntable(start, 5, 20).azimuth, 0.3f + pi / 2, 1e-5);
}

TEST(Orbit, FollowApproachesItsTargetExponentially) {
  Orbit orbit;
  follow(orbit, {1, 0, 0}, 0.5, 0.5);
  EXPECT_NEAR(orbit.target.x, 1 - std::exp(-1.0), 1e-5);
}

TEST(Bounds, IgnoresPointsThatAreNotFinite) {
  const float nan = std::nanf("");
  const Bounds bounds = bounds_of(std::vector<float>{0, 0, 0, nan, 5, 5, 1, 2, 3});
  EXPECT_EQ(bounds.high, Vector3(1, 2, 3));
  EXPECT_TRUE(bounds_of(std::span<const float>()).empty());
}

}  // namespace
}  // namespace mercury::render
