// SPDX-License-Identifier: Apache-2.0
#include "render/passes/ground_cover_pass.h"

#include <cmath>
#include <map>
#include <utility>

#include "render/passes/scene_buffers.h"
#include "tests/render/offscreen.h"
#include "tests/render/triangle.h"
#include "tests/render/wobbling_bodies.h"

namespace mercury::render {
namespace {

class GroundCoverTest : public Offscreen {
 protected:
  using Items = std::vector<GroundCoverPass::Item>;
  // What stands in a scene of these bodies, which are at rest.
  Items items(Scene& scene, const WobblingGroup& group, const Camera& camera) {
    std::vector<std::shared_ptr<const PreparedBody>> prepared;
    for (const Body& body : group.views()) prepared.push_back(prepare_body(body));
    Bodies bodies;
    bodies.set(assemble(prepared));
    scene.placements = group.placements;
    SceneBuffers buffers;
    buffers.upload(scene, bodies);
    buffers.bind(bodies);
    BoundsPass bounds;
    bounds.measure(bodies);
    const FrameBlock block = frame_block(scene, camera, style_of(scene.surroundings, scene.theme), 160, 90);
    StreamBuffer frame;
    frame.write(&block, sizeof block);
    frame.bind_uniform(0);
    GroundCoverPass pass;
    pass.place(scene, camera, bounds, bodies.body_count());
    return pass.items();
  }
};

std::map<std::pair<float, float>, GroundCoverPass::Item> by_foot(const std::vector<GroundCoverPass::Item>& items) {
  std::map<std::pair<float, float>, GroundCoverPass::Item> map;
  for (const auto& item : items) map[{item.foot.x, item.foot.y}] = item;
  return map;
}

TEST_F(GroundCoverTest, NothingIsHigherThanTheRoomBelowABodyOrThanItsDistanceFromOne) {
  const WobblingGroup group = make_wobbling_group(9, 6, 4, 0.9f);
  for (const Surroundings around : {Surroundings::water, Surroundings::land})
    for (const float floor : {-0.31f, -0.9f}) {
      Scene scene;
      scene.surroundings = around;
      scene.floor = floor;
      scene.ground_cover = GroundCover{.height = 0.4f};
      const Items all = items(scene, group, Orbit{.elevation = 0.7f, .distance = 5}.camera());
      ASSERT_GT(all.size(), 40u);
      int below = 0;
      for (const auto& item : all) {
        EXPECT_EQ(item.foot.z, floor);
        for (std::size_t i = 0; i < group.bodies.size(); ++i) {
          const Bounds box = bounds_of(group.bodies[i].rest).moved(group.placements[i].offset);
          const float dx = std::max({box.low.x - item.foot.x, item.foot.x - box.high.x, 0.0f});
          const float dy = std::max({box.low.y - item.foot.y, item.foot.y - box.high.y, 0.0f});
          const float beside = std::hypot(dx, dy);
          if (beside == 0) {
            EXPECT_LT(item.height, box.low.z - floor);
            ++below;
          }
          EXPECT_LT(item.height, std::max(0.0f, box.low.z - floor) + beside);
        }
      }
      if (floor < -0.8f) {
        EXPECT_GT(below, 0) << "where there is room, plants grow below bodies";
      }
    }
}

TEST_F(GroundCoverTest, StonesAreBrightWhereTheLightFalls) {
  constexpr int width = 640, height = 480;
  const WobblingGroup group = make_wobbling_group(1, 2, 4, 1);
  Scene scene;
  scene.surroundings = Surroundings::land;
  scene.floor = -1;
  scene.ground_cover = GroundCover{.height = 0.35f};
  // The eye is on the side of the light.
  const Vector3 to_key = style_of(scene.surroundings, scene.theme).to_key.normalized();
  Renderer renderer = make_renderer(width, height);
  renderer.set_bodies(group.views());
  int stones = 0, dark = 0;
  for (int place = 0; place < 8; ++place) {
    const Camera camera = Orbit{.target = {9.0f * float(place), 0, -1},
                                .azimuth = std::atan2(to_key.y, to_key.x),
                                .elevation = 0.8f,
                                .distance = 5}
                              .camera();
    const Items all = items(scene, group, camera);
    scene.placements = group.placements;
    const Image image = drawn(renderer, scene, camera);
    for (const auto& item : all) {
      if (item.kind != 1) continue;
      const Vector3 flank = item.foot + item.height * Vector3(1.1f * to_key.x, 1.1f * to_key.y, 0.25f);
      const Vector3 at = camera.project(flank, width, height);
      if (at.x < 0 || at.y < 0 || at.x >= float(width) || at.y >= float(height)) continue;
      ++stones;
      dark += pixel(image, int(at.x), int(at.y)).sum() < 220;  // what the sky alone lights
    }
  }
  EXPECT_GT(stones, 10);
  EXPECT_LE(dark, stones / 10) << "some are behind grass";
}

TEST_F(GroundCoverTest, NothingHidesABodyFromTheEye) {
  const WobblingGroup group = make_wobbling_group(4, 6, 4, 1.4f);
  for (const float elevation : {0.03f, 0.12f, 0.6f}) {
    Scene scene;
    scene.surroundings = Surroundings::land;
    scene.floor = -0.3f;
    scene.ground_cover = GroundCover{.height = 0.25f};
    const Camera camera = Orbit{.azimuth = -1.2f, .elevation = elevation, .distance = 5}.camera();
    const Items all = items(scene, group, camera);
    ASSERT_GT(all.size(), 20u);
    int below = 0;
    for (const auto& item : all)
      for (std::size_t i = 0; i < group.bodies.size(); ++i) {
        const Bounds box = bounds_of(group.bodies[i].rest).moved(group.placements[i].offset);
        // Lines of sight to the nearer half of the lower side of its box that pass above the foot.
        for (float u = 0; u <= 1; u += 0.05f)
          for (float v = 0; v <= 1; v += 0.05f) {
            const Vector3 seen(std::lerp(box.low.x, box.high.x, u), std::lerp(box.low.y, box.high.y, v), box.low.z);
            const Vector3 sight = seen - camera.eye;
            const Vector2 level = sight.xy(), foot = item.foot.xy() - camera.eye.xy();
            if (level.norm() > (box.center() - camera.eye).xy().norm()) continue;
            const float share = foot.dot(level) / level.dot(level);
            if (share <= 0 || share >= 1 || (foot - share * level).norm() > 0.01f) continue;
            ++below;
            EXPECT_LE(item.foot.z + item.height, camera.eye.z + share * sight.z + 0.02f);
          }
      }
    EXPECT_GT(below, elevation > 0.5f ? 10 : 0);
  }
}

TEST_F(GroundCoverTest, NothingStandsOnAPatchOrInTheBareRectangle) {
  Scene scene;
  scene.surroundings = Surroundings::land;
  const Patch patch{.center = {-1, 0.5f}, .radius = 0.7f};
  scene.patches = {&patch, 1};
  scene.ground_cover = GroundCover{.height = 0.2f, .bare_low = {0.5f, -2}, .bare_high = {2, 1}};
  const Items all = items(scene, {}, Orbit{.elevation = 0.9f, .distance = 4}.camera());
  ASSERT_GT(all.size(), 100u);
  for (const auto& item : all) {
    EXPECT_GT((item.foot.xy() - patch.center).norm(), patch.radius);
    EXPECT_FALSE(item.foot.x > 0.5f && item.foot.x < 2 && item.foot.y > -2 && item.foot.y < 1);
  }
}

TEST_F(GroundCoverTest, ThingsStayWhereTheyAreWhileTheCameraMoves) {
  Scene scene;
  scene.floor = -1;
  scene.ground_cover = GroundCover{.height = 0.3f};
  const auto first = by_foot(items(scene, {}, Orbit{.elevation = 0.5f, .distance = 5}.camera()));
  const auto moved =
      by_foot(items(scene, {}, Orbit{.target = {0.7f, -0.4f, 0}, .elevation = 0.6f, .distance = 5.2f}.camera()));
  std::size_t both = 0;
  for (const auto& [foot, item] : first) {
    const auto found = moved.find(foot);
    if (found == moved.end()) continue;
    ++both;
    EXPECT_EQ(item.kind, found->second.kind);
    EXPECT_EQ(item.phase, found->second.phase);
  }
  EXPECT_GT(both, first.size() / 2);
}

TEST_F(GroundCoverTest, FromFartherAwayAreFewerOfTheSameThings) {
  Scene scene;
  scene.surroundings = Surroundings::land;
  scene.ground_cover = GroundCover{.height = 0.1f};
  const auto near = by_foot(items(scene, {}, Orbit{.elevation = 1.5f, .distance = 20}.camera()));
  const auto far = by_foot(items(scene, {}, Orbit{.elevation = 1.5f, .distance = 40}.camera()));
  constexpr float radius = 20;  // inside of both
  std::size_t kept = 0, all = 0;
  for (const auto& [foot, item] : near) all += std::hypot(foot.first, foot.second) < radius;
  for (const auto& [foot, item] : far) {
    if (std::hypot(foot.first, foot.second) >= radius) continue;
    ++kept;
    EXPECT_TRUE(near.contains(foot));
  }
  EXPECT_GT(kept, 50u);
  // Each level keeps one of four cells; twice the distance is one level.
  EXPECT_NEAR(double(kept) / double(all), 0.25, 0.08);
}

TEST_F(GroundCoverTest, APictureDependsOnItsTimeAlone) {
  Renderer renderer = make_renderer();
  Scene scene;
  scene.floor = -0.5f;
  const Camera camera = Orbit{.target = {0, 0, -0.5f}, .elevation = 0.5f, .distance = 3}.camera();
  const Image bare = drawn(renderer, scene, camera);
  scene.ground_cover = GroundCover{.height = 0.5f};
  const Image first = drawn(renderer, scene, camera);
  EXPECT_GT(count_differing(bare, first, 8), 200);
  scene.time = 2.5;
  drawn(renderer, scene, camera);
  scene.time = 0;
  EXPECT_EQ(count_differing(first, drawn(renderer, scene, camera), 0), 0);
  // Plain surroundings have no floor.
  scene.surroundings = Surroundings::none;
  const Image plain = drawn(renderer, scene, camera);
  scene.ground_cover.reset();
  EXPECT_EQ(count_differing(plain, drawn(renderer, scene, camera), 0), 0);
}

}  // namespace
}  // namespace mercury::render
